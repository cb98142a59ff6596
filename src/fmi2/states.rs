//! The states of an instance, and for each function the states it may be called in.
//! The table is that of the standard for co-simulation (section 4.2.4), without the columns that do not occur here: a
//! step is never in progress or cancelled, and a failed step is an error. Three rows are wider: inputs and parameters
//! can also be read in the state instantiated, where they have their start values (outputs have none there: reading one is
//! an error of that call alone); the status functions also work in the state error, so that the last successful time can be read after a
//! failed step; the directional derivatives, which the description declares unsupported, report this in every state.

/// State in the life cycle of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum State {
    /// Instantiated or reset; the experiment can be set up.
    Instantiated,
    /// Between `fmi2EnterInitializationMode` and `fmi2ExitInitializationMode`.
    InitializationMode,
    /// At a communication point.
    StepComplete,
    /// The simulation has ended.
    Terminated,
    /// A call failed.
    Error,
}

use State::{Error, InitializationMode, Instantiated, StepComplete, Terminated};
use serde::{Deserialize, Serialize};

impl State {
    /// Every state.
    pub const ALL: &[Self] = &[Instantiated, InitializationMode, StepComplete, Terminated, Error];

    /// The name of the state in messages.
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

/// A function of an instance, with the states it may be called in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Function {
    /// Name in C.
    pub name: &'static str,
    /// The states in which the call is allowed.
    pub allowed: &'static [State],
}

const ANY: &[State] = State::ALL;
const SETTABLE: &[State] = &[Instantiated, InitializationMode, StepComplete];
const STATUS: &[State] = &[StepComplete, Terminated, Error];

/// Makes of each function a constant, and a table of all.
macro_rules! functions {
    ($($constant:ident = $name:literal, $allowed:expr;)*) => {
        $(pub(super) const $constant: Function = Function { name: $name, allowed: $allowed };)*

        /// Every function of an instance except `fmi2FreeInstance`, which is always allowed and has no status.
        pub const TABLE: &[Function] = &[$($constant),*];
    };
}

functions! {
    SET_DEBUG_LOGGING = "fmi2SetDebugLogging", ANY;
    SETUP_EXPERIMENT = "fmi2SetupExperiment", &[Instantiated];
    ENTER_INITIALIZATION_MODE = "fmi2EnterInitializationMode", &[Instantiated];
    EXIT_INITIALIZATION_MODE = "fmi2ExitInitializationMode", &[InitializationMode];
    TERMINATE = "fmi2Terminate", &[StepComplete];
    RESET = "fmi2Reset", ANY;
    GET_REAL = "fmi2GetReal", ANY;
    GET_INTEGER = "fmi2GetInteger", ANY;
    GET_BOOLEAN = "fmi2GetBoolean", ANY;
    GET_STRING = "fmi2GetString", ANY;
    SET_REAL = "fmi2SetReal", SETTABLE;
    SET_INTEGER = "fmi2SetInteger", SETTABLE;
    SET_BOOLEAN = "fmi2SetBoolean", SETTABLE;
    SET_STRING = "fmi2SetString", SETTABLE;
    GET_FMU_STATE = "fmi2GetFMUstate", ANY;
    SET_FMU_STATE = "fmi2SetFMUstate", ANY;
    FREE_FMU_STATE = "fmi2FreeFMUstate", ANY;
    SERIALIZED_FMU_STATE_SIZE = "fmi2SerializedFMUstateSize", ANY;
    SERIALIZE_FMU_STATE = "fmi2SerializeFMUstate", ANY;
    DE_SERIALIZE_FMU_STATE = "fmi2DeSerializeFMUstate", ANY;
    GET_DIRECTIONAL_DERIVATIVE = "fmi2GetDirectionalDerivative", ANY;
    SET_REAL_INPUT_DERIVATIVES = "fmi2SetRealInputDerivatives", SETTABLE;
    GET_REAL_OUTPUT_DERIVATIVES = "fmi2GetRealOutputDerivatives", STATUS;
    DO_STEP = "fmi2DoStep", &[StepComplete];
    CANCEL_STEP = "fmi2CancelStep", &[];
    GET_STATUS = "fmi2GetStatus", STATUS;
    GET_REAL_STATUS = "fmi2GetRealStatus", STATUS;
    GET_INTEGER_STATUS = "fmi2GetIntegerStatus", STATUS;
    GET_BOOLEAN_STATUS = "fmi2GetBooleanStatus", STATUS;
    GET_STRING_STATUS = "fmi2GetStringStatus", STATUS;
}
