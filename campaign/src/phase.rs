//! The states of FMI 2.0 for co-simulation, and which function is allowed in which.

use crate::description::DESCRIPTION;

/// Where an instance is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the states of the standard
pub enum Phase {
    Instantiated,
    InitializationMode,
    StepComplete,
    Terminated,
    Error,
}

use Phase::{Error, InitializationMode, Instantiated, StepComplete, Terminated};

/// Whether the standard (or, where it is wider, the component) allows the function in the phase.
pub fn allowed(function: &str, phase: Phase) -> bool {
    match function {
        "fmi2SetupExperiment" | "fmi2EnterInitializationMode" => phase == Instantiated,
        "fmi2ExitInitializationMode" => phase == InitializationMode,
        "fmi2DoStep" | "fmi2Terminate" => phase == StepComplete,
        "fmi2CancelStep" => false,
        "fmi2SetReal" | "fmi2SetInteger" | "fmi2SetBoolean" | "fmi2SetString" => {
            matches!(phase, Instantiated | InitializationMode | StepComplete)
        }
        "fmi2GetStatus"
        | "fmi2GetRealStatus"
        | "fmi2GetIntegerStatus"
        | "fmi2GetBooleanStatus"
        | "fmi2GetStringStatus" => {
            matches!(phase, StepComplete | Terminated | Error)
        }
        "fmi2SetRealInputDerivatives" if DESCRIPTION.input_derivatives => {
            matches!(phase, Instantiated | InitializationMode | StepComplete)
        }
        "fmi2GetRealOutputDerivatives" if DESCRIPTION.output_derivatives => {
            matches!(phase, StepComplete | Terminated | Error)
        }
        _ => true,
    }
}
