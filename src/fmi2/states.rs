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

const fn function(name: &'static str, allowed: &'static [State]) -> Function {
    Function { name, allowed }
}

const ANY: &[State] = State::ALL;
const READABLE: &[State] = ANY;
const SETTABLE: &[State] = &[Instantiated, InitializationMode, StepComplete];
const STATUS: &[State] = &[StepComplete, Terminated, Error];

pub(super) const SET_DEBUG_LOGGING: Function = function("fmi2SetDebugLogging", ANY);
pub(super) const SETUP_EXPERIMENT: Function = function("fmi2SetupExperiment", &[Instantiated]);
pub(super) const ENTER_INITIALIZATION_MODE: Function = function("fmi2EnterInitializationMode", &[Instantiated]);
pub(super) const EXIT_INITIALIZATION_MODE: Function = function("fmi2ExitInitializationMode", &[InitializationMode]);
pub(super) const TERMINATE: Function = function("fmi2Terminate", &[StepComplete]);
pub(super) const RESET: Function = function("fmi2Reset", ANY);
pub(super) const GET_REAL: Function = function("fmi2GetReal", READABLE);
pub(super) const GET_INTEGER: Function = function("fmi2GetInteger", READABLE);
pub(super) const GET_BOOLEAN: Function = function("fmi2GetBoolean", READABLE);
pub(super) const GET_STRING: Function = function("fmi2GetString", READABLE);
pub(super) const SET_REAL: Function = function("fmi2SetReal", SETTABLE);
pub(super) const SET_INTEGER: Function = function("fmi2SetInteger", SETTABLE);
pub(super) const SET_BOOLEAN: Function = function("fmi2SetBoolean", SETTABLE);
pub(super) const SET_STRING: Function = function("fmi2SetString", SETTABLE);
pub(super) const GET_FMU_STATE: Function = function("fmi2GetFMUstate", ANY);
pub(super) const SET_FMU_STATE: Function = function("fmi2SetFMUstate", ANY);
pub(super) const FREE_FMU_STATE: Function = function("fmi2FreeFMUstate", ANY);
pub(super) const SERIALIZED_FMU_STATE_SIZE: Function = function("fmi2SerializedFMUstateSize", ANY);
pub(super) const SERIALIZE_FMU_STATE: Function = function("fmi2SerializeFMUstate", ANY);
pub(super) const DE_SERIALIZE_FMU_STATE: Function = function("fmi2DeSerializeFMUstate", ANY);
pub(super) const GET_DIRECTIONAL_DERIVATIVE: Function = function("fmi2GetDirectionalDerivative", ANY);
pub(super) const SET_REAL_INPUT_DERIVATIVES: Function = function("fmi2SetRealInputDerivatives", SETTABLE);
pub(super) const GET_REAL_OUTPUT_DERIVATIVES: Function = function("fmi2GetRealOutputDerivatives", STATUS);
pub(super) const DO_STEP: Function = function("fmi2DoStep", &[StepComplete]);
pub(super) const CANCEL_STEP: Function = function("fmi2CancelStep", &[]);
pub(super) const GET_STATUS: Function = function("fmi2GetStatus", STATUS);
pub(super) const GET_REAL_STATUS: Function = function("fmi2GetRealStatus", STATUS);
pub(super) const GET_INTEGER_STATUS: Function = function("fmi2GetIntegerStatus", STATUS);
pub(super) const GET_BOOLEAN_STATUS: Function = function("fmi2GetBooleanStatus", STATUS);
pub(super) const GET_STRING_STATUS: Function = function("fmi2GetStringStatus", STATUS);

/// Every function of an instance except `fmi2FreeInstance`, which is always allowed and has no status.
pub const TABLE: [Function; 30] = [
    SET_DEBUG_LOGGING,
    SETUP_EXPERIMENT,
    ENTER_INITIALIZATION_MODE,
    EXIT_INITIALIZATION_MODE,
    TERMINATE,
    RESET,
    GET_REAL,
    GET_INTEGER,
    GET_BOOLEAN,
    GET_STRING,
    SET_REAL,
    SET_INTEGER,
    SET_BOOLEAN,
    SET_STRING,
    GET_FMU_STATE,
    SET_FMU_STATE,
    FREE_FMU_STATE,
    SERIALIZED_FMU_STATE_SIZE,
    SERIALIZE_FMU_STATE,
    DE_SERIALIZE_FMU_STATE,
    GET_DIRECTIONAL_DERIVATIVE,
    SET_REAL_INPUT_DERIVATIVES,
    GET_REAL_OUTPUT_DERIVATIVES,
    DO_STEP,
    CANCEL_STEP,
    GET_STATUS,
    GET_REAL_STATUS,
    GET_INTEGER_STATUS,
    GET_BOOLEAN_STATUS,
    GET_STRING_STATUS,
];
