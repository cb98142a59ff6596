//! The variables of the component, generated from `modelDescription.xml` by `build.rs`: an enum for each group,
//! so that a `match` over a group is refused by the compiler until every variable is served.

include!(concat!(env!("OUT_DIR"), "/variables.rs"));

/// What `modelDescription.xml` declares of a variable.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name as users write it, for example `contact.overtravel`.
    pub name: &'static str,
    /// FMI value reference.
    pub value_reference: u32,
    /// Which variable it is, in Rust.
    pub group: Group,
    /// SI unit; empty for numbers that have none to declare.
    pub unit: &'static str,
    /// Start value (of enumerations the value of the choice, of Booleans 1 or 0).
    pub start: f64,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
}

impl Variable {
    /// The variable with this FMI value reference.
    pub fn by_value_reference(value_reference: u32) -> Option<&'static Self> {
        let position = BY_VALUE_REFERENCE.get(usize::try_from(value_reference).ok()?)?;
        VARIABLES.get(usize::from(*position))
    }

    /// The variable with this name.
    pub fn by_name(name: &str) -> Option<&'static Self> {
        VARIABLES.iter().find(|variable| variable.name == name)
    }
}
