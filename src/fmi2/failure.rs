//! Causes of failed calls, and their FMI status.

use super::states::{Function, State};
use super::types::{fmi2Discard, fmi2Error, fmi2Status, fmi2Warning};
use crate::error::{Remark, SceneError, StepError, number};

#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error("not allowed in the state {}; allowed in: {}", state.name(), listed(function.allowed))]
    CallOrder { function: Function, state: State },
    #[error("argument {0} is null, misaligned or too long")]
    Pointer(&'static str),
    #[error("value reference {reference}: no {kind} variable{}", owner.map(|(name, own)| format!(", {name} is {own}")).unwrap_or_default())]
    UnknownReference { kind: &'static str, reference: u32, owner: Option<(&'static str, &'static str)> },
    #[error("{name}: cannot be set in the state {}; {reason}", state.name())]
    NotSettable { name: &'static str, state: State, reason: &'static str },
    #[error("{name}: has no value in the state {}; outputs can be read from Initialization Mode on", state.name())]
    NotComputed { name: &'static str, state: State },
    /// A value that its variable does not allow.
    #[error(transparent)]
    Value(SceneError),
    /// Inconsistent parameters, found when an output was read in Initialization Mode.
    #[error("outputs cannot be computed yet: {0}; correct the parameters before initialisation ends")]
    Preview(SceneError),
    /// A scene that cannot be simulated.
    #[error(transparent)]
    Scene(SceneError),
    #[error(transparent)]
    Step(StepError),
    #[error("{0}; reached by its derivative in this step")]
    Course(SceneError),
    #[error("{name} = {}: not allowed, {allowed}", number(*value))]
    Argument { name: &'static str, value: f64, allowed: String },
    #[error("tolerance = {}: ignored, as it is not a positive finite number", number(*.0))]
    Tolerance(f64),
    /// A communication point that differs from the time of the instance by more than rounding. The step is done.
    #[error(
        "currentCommunicationPoint = {}: the time of the instance was {} s; the step went from there to \
         currentCommunicationPoint + communicationStepSize. Further differences of this kind are not reported",
        number(*point), number(*time)
    )]
    Offset { point: f64, time: f64 },
    /// What the user should know of a simulation that can be done.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Remarks(Vec<Remark>),
    /// A force that may be wrong by more than the tolerance. The step is done.
    #[error(
        "at {time:.9} s contact.force may be wrong by more than the tolerance {tolerance:e} (estimate: solver.forceError = {error:.1e}): \
         errors grow with each closing of this contact, or {modes} modes are too few for its impacts. Not reported again"
    )]
    Inaccurate { time: f64, tolerance: f64, error: f64, modes: usize },
    #[error(
        "category {0}: no such log category, allowed are logStatusError, logStatusWarning, logEvents and logSolver; \
         nothing changed"
    )]
    Category(String),
    #[error("{name}: no derivative of order {order}, allowed is 1")]
    Order { name: &'static str, order: i32 },
    #[error("{name}: its derivative of order {order} has no effect, nor has any above order 1. Not reported again")]
    Ignored { name: &'static str, order: i32 },
    #[error("{name}: not allowed, only {role} have derivatives")]
    NoDerivative { name: &'static str, role: &'static str },
    #[error("status kind {0}: this component has no such status of this type")]
    StatusKind(u32),
    #[error("argument {0} is not a saved state of this component, or has been freed")]
    ForeignState(&'static str),
    #[error("argument serializedState is not a saved state: {0}")]
    Serialized(String),
    #[error("size = {size}: not allowed, the saved state has {needed} bytes")]
    Size { size: usize, needed: usize },
    #[error("not supported, see {0} in modelDescription.xml")]
    Unsupported(&'static str),
    /// A panic caught at the C interface.
    #[error("internal error: {0}")]
    Panic(String),
}

impl Failure {
    /// The status with which it is logged; with `fmi2Warning` the call has done its work and returns `fmi2OK`.
    pub(super) fn status(&self) -> fmi2Status {
        match self {
            Self::Tolerance(_)
            | Self::Offset { .. }
            | Self::Inaccurate { .. }
            | Self::Ignored { .. }
            | Self::Remarks(_)
            | Self::Category(_) => fmi2Warning,
            Self::Value(_) | Self::StatusKind(_) => fmi2Discard,
            // Not fmi2Fatal: instances share nothing, and a reset rebuilds this one, also after a panic.
            _ => fmi2Error,
        }
    }

    /// Whether the instance is put into the state error.
    /// After fmi2Error the standard requires the importer to reset or free the instance; it does not require the
    /// component to reject other calls. A call of an unsupported capability changes nothing, so the instance
    /// continues. Neither does an output read before initialisation, as some importers try, or one that cannot be
    /// computed in Initialization Mode: parameters are set one after the other, and the next may make them consistent.
    /// (fmi2Discard is not available here: the standard does not list the fmi2Get functions among those that may return
    /// it in co-simulation.)
    pub(super) fn ends_instance(&self) -> bool {
        let harmless = matches!(self, Self::Unsupported(_) | Self::Preview(_) | Self::NotComputed { .. });
        self.status() == fmi2Error && !harmless
    }
}

fn listed(states: &[State]) -> String {
    match states {
        [] => "none".to_owned(),
        states => states.iter().map(|state| state.name()).collect::<Vec<_>>().join(", "),
    }
}
