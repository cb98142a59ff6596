//! The states of FMI 2.0 for co-simulation, and which function is allowed in which: the table of the standard, section
//! 4.2.4, independent of that in the component. It has no column for a step in progress, which does not occur, and
//! three rows are wider: inputs and parameters can also be read in the state instantiated (see [`crate::life_cycle`]),
//! the status functions work in the state error, and unsupported functions report this in every state.

use Phase::{Error, InitializationMode, Instantiated, StepComplete, Terminated};

/// State in the life cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    Instantiated,
    InitializationMode,
    StepComplete,
    Terminated,
    Error,
}

impl Phase {
    pub const ALL: [Self; 5] = [Instantiated, InitializationMode, StepComplete, Terminated, Error];

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Instantiated => "instantiated",
            InitializationMode => "Initialization Mode",
            StepComplete => "step complete",
            Terminated => "terminated",
            Error => "error",
        }
    }
}

/// The functions of an instance, and the states they are allowed in.
const TABLE: [(&[&str], &[Phase]); 8] = [
    (&["fmi2SetupExperiment", "fmi2EnterInitializationMode"], &[Instantiated]),
    (&["fmi2ExitInitializationMode"], &[InitializationMode]),
    (&["fmi2DoStep", "fmi2Terminate"], &[StepComplete]),
    (&["fmi2CancelStep"], &[]),
    (
        &["fmi2SetReal", "fmi2SetInteger", "fmi2SetBoolean", "fmi2SetString", "fmi2SetRealInputDerivatives"],
        &[Instantiated, InitializationMode, StepComplete],
    ),
    (
        &[
            "fmi2GetRealOutputDerivatives",
            "fmi2GetStatus",
            "fmi2GetRealStatus",
            "fmi2GetIntegerStatus",
            "fmi2GetBooleanStatus",
            "fmi2GetStringStatus",
        ],
        &[StepComplete, Terminated, Error],
    ),
    (&["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString"], &Phase::ALL),
    (
        &[
            "fmi2SetDebugLogging",
            "fmi2FreeInstance",
            "fmi2Reset",
            "fmi2GetFMUstate",
            "fmi2SetFMUstate",
            "fmi2FreeFMUstate",
            "fmi2SerializedFMUstateSize",
            "fmi2SerializeFMUstate",
            "fmi2DeSerializeFMUstate",
            "fmi2GetDirectionalDerivative",
        ],
        &Phase::ALL,
    ),
];

/// The names of all functions of an instance.
pub fn functions() -> impl Iterator<Item = &'static str> {
    TABLE.iter().flat_map(|(functions, _)| *functions).copied()
}

/// Whether the function is allowed in the state.
pub fn allowed(function: &str, phase: Phase) -> bool {
    let row = TABLE.iter().find(|(functions, _)| functions.contains(&function));
    row.unwrap_or_else(|| panic!("{function} is not a function of an instance")).1.contains(&phase)
}
