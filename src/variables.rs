//! The variables of the component, generated from `modelDescription.xml` by `build.rs`: an enum for each group, so
//! that the compiler checks that a `match` over a group handles every variable.

use crate::fingerprint;

include!(concat!(env!("OUT_DIR"), "/variables.rs"));

/// The GUID of a component that carries a spring file: of the GUID of its variables, the file's name, and its contents.
pub fn guid_carrying(guid: &str, name: &str, contents: &str) -> String {
    fingerprint::guid(&[guid, name, contents].map(str::as_bytes))
}

/// The declaration of a variable in `modelDescription.xml`.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name, for example `contact.overtravel`.
    pub name: &'static str,
    /// FMI value reference.
    pub value_reference: u32,
    /// The variable as a Rust enum value.
    pub group: Group,
    /// SI unit; may be empty.
    pub unit: &'static str,
    /// Start value (for enumerations the value of the choice, for Booleans 1 or 0, for strings 0).
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
