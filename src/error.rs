//! What can go wrong, by layer: setting up a scene, and integrating it. Every error names the thing, its value
//! and what is allowed, so that it can be shown to a user as it is.

use crate::variables::Variable;

/// A scene that cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A value outside its range, or not a number.
    #[error("{name} = {value}{unit}: not allowed, {allowed}", unit = spaced(unit))]
    OutOfRange {
        /// Name of the variable or key.
        name: &'static str,
        /// The value refused.
        value: f64,
        /// Unit of value and range.
        unit: &'static str,
        /// The range allowed.
        allowed: String,
    },
    /// A choice that the variable does not have.
    #[error("{name} = {value}: no such choice, allowed are {allowed}")]
    UnknownChoice {
        /// Name of the variable.
        name: &'static str,
        /// The choice asked for.
        value: String,
        /// The choices there are.
        allowed: String,
    },
    /// A name that no variable of the wanted kind has.
    #[error("{name}: no such {what}; nearest: {nearest}")]
    UnknownName {
        /// The name asked for.
        name: String,
        /// What was looked for: parameter, input or output.
        what: &'static str,
        /// The names that come nearest.
        nearest: String,
    },
    /// A value of the wrong type.
    #[error("{name} = {value}: wrong type, allowed is {allowed}")]
    WrongType {
        /// Name of the variable or key.
        name: String,
        /// The value given.
        value: String,
        /// The type allowed.
        allowed: &'static str,
    },
    /// An axial force above the buckling load of the spring, which stands alone once the contact opens.
    #[error("{name} = {value} N: the spring buckles, allowed is less than {limit} N (pi^2 E I / (4 L^2))")]
    Buckled {
        /// The variable or result that holds the force.
        name: &'static str,
        /// The axial force, N.
        value: f64,
        /// The buckling load of the cantilever, N.
        limit: f64,
    },
    /// A random acceleration whose band of frequencies is empty.
    #[error(
        "excitation.endFrequency = {end_frequency} Hz with excitation.frequency = {frequency} Hz: no band for \
         effects.excitation = Random, allowed is excitation.endFrequency above excitation.frequency"
    )]
    NoBand {
        /// Lower end asked for, Hz.
        frequency: f64,
        /// Upper end asked for, Hz.
        end_frequency: f64,
    },
    /// Interruptions asked for without a resistance to tell them by.
    #[error("effects.chatter = true: not allowed with effects.resistance = None, allowed is false")]
    NoResistance,
    /// A linear contact law without a contact force to linearise about.
    #[error("effects.contactLaw: Linearised and Bonded need a contact that is closed at rest, preload.force is 0 N")]
    NoPreload,
    /// A scene for which a number of the model is not finite.
    #[error("{name} is {value} for this scene: the parameters are too extreme together")]
    NotFinite {
        /// The number that failed.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A scene file that lacks a key.
    #[error("{name}: missing, wanted is {allowed}")]
    MissingKey {
        /// Name of the key.
        name: &'static str,
        /// What it has to hold.
        allowed: &'static str,
    },
    /// A name that stands where another of its kind does.
    #[error("{name}: given twice, allowed is {allowed}")]
    GivenTwice {
        /// The name.
        name: String,
        /// What it may be given as.
        allowed: &'static str,
    },
    /// Any of these, with the line of the scene file or table it stands on.
    #[error("line {line}: {error}")]
    AtLine {
        /// Line, counted from 1.
        line: usize,
        /// What is wrong there.
        error: Box<SceneError>,
    },
    /// A scene file that is not TOML, or with a key or a type of value that scene files do not have.
    #[error("not a scene file: {}", .0.trim_end())]
    Syntax(String),
    /// A table of inputs that is not CSV, or has no rows.
    #[error("not a table of inputs: {0}")]
    InputTable(String),
    /// Any of these, with the file it is in.
    #[error("{file}: {error}")]
    InFile {
        /// Path of the file.
        file: String,
        /// What is wrong there.
        error: Box<SceneError>,
    },
    /// A file that cannot be read.
    #[error("{file}: cannot be read: {cause}")]
    Unreadable {
        /// Path of the file.
        file: String,
        /// What the system says.
        cause: String,
    },
}

impl SceneError {
    pub(crate) fn out_of_range(variable: &Variable, value: f64, allowed: String) -> Self {
        Self::OutOfRange {
            name: variable.name,
            value,
            unit: variable.unit,
            allowed,
        }
    }
}

fn spaced(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A communication step that could not be integrated. The state stays what it was before.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("integration stopped at t = {time:?} s: {cause}")]
pub struct StepError {
    /// The instant reached, s.
    pub time: f64,
    /// What stopped it.
    pub cause: StepErrorCause,
}

/// Why a communication step could not be integrated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepErrorCause {
    /// A length that is not a positive finite number.
    #[error("the communication step size must be positive and finite")]
    StepSize,
    /// More integration steps than a communication step may take.
    #[error("more than the work of {0} integration steps within one communication step")]
    Budget(u64),
    /// An instant so late that floating-point numbers there are too far apart for the motion.
    #[error("time is known to {spacing:e} s only, allowed is {allowed:e} s")]
    Resolution {
        /// Spacing of floating-point numbers at the end of the communication step, s.
        spacing: f64,
        /// What the motion needs, s.
        allowed: f64,
    },
    /// A fixed contact that is to move faster than light.
    #[error("support.displacement would move at {0:e} m/s, allowed is the speed of light")]
    Speed(f64),
    /// A number in the state stopped being finite.
    #[error("the motion is no longer a finite number")]
    NotFinite,
}
