//! The states of an instance, and for each function the states it may be called in.
//! The table is that of the standard for co-simulation (section 4.2.4), without the columns that do not occur here: a
//! step is never in progress or cancelled, and a failed step is an error. Three rows are wider: inputs and parameters
//! can also be read in the state instantiated, where they have their start values (outputs have none there: reading one is
//! an error of that call alone); the status functions also work in the state error, so that the last successful time can be read after a
//! failed step; the directional derivatives, which the description declares unsupported, report this in every state.

use serde::{Deserialize, Serialize};

use State::{Error, InitializationMode, Instantiated, StepComplete, Terminated};

/// State in the life cycle of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum State {
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

impl State {
    /// The name of the state in messages.
    pub(super) fn name(self) -> &'static str {
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
#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    /// Name in C.
    pub(super) name: &'static str,
    pub(super) allowed: &'static [State],
}

const fn function(name: &'static str, allowed: &'static [State]) -> Function {
    Function { name, allowed }
}

const ANY: &[State] = &[Instantiated, InitializationMode, StepComplete, Terminated, Error];
const SETTABLE: &[State] = &[Instantiated, InitializationMode, StepComplete];
const STATUS: &[State] = &[StepComplete, Terminated, Error];

pub(super) const SET_DEBUG_LOGGING: Function = function("fmi2SetDebugLogging", ANY);
pub(super) const SETUP_EXPERIMENT: Function = function("fmi2SetupExperiment", &[Instantiated]);
pub(super) const ENTER_INITIALIZATION_MODE: Function = function("fmi2EnterInitializationMode", &[Instantiated]);
pub(super) const EXIT_INITIALIZATION_MODE: Function = function("fmi2ExitInitializationMode", &[InitializationMode]);
pub(super) const TERMINATE: Function = function("fmi2Terminate", &[StepComplete]);
pub(super) const RESET: Function = function("fmi2Reset", ANY);
pub(super) const GET_REAL: Function = function("fmi2GetReal", ANY);
pub(super) const GET_INTEGER: Function = function("fmi2GetInteger", ANY);
pub(super) const GET_BOOLEAN: Function = function("fmi2GetBoolean", ANY);
pub(super) const GET_STRING: Function = function("fmi2GetString", ANY);
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
