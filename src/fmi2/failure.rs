//! What a call can fail with, and the one place where that becomes an FMI status.

use super::states::{Function, State};
use super::types::{fmi2Discard, fmi2Error, fmi2Status, fmi2Warning};
use crate::error::{SceneError, StepError};

/// Why a call did not do what was asked.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Failure {
    /// A call that the state does not allow.
    #[error("not allowed in the state {}; allowed in: {}", state.name(), listed(function.allowed))]
    CallOrder { function: Function, state: State },
    /// A pointer that leads nowhere.
    #[error("argument {0} is null, misaligned or too long")]
    Pointer(&'static str),
    /// A value reference that no variable of the type has.
    #[error("value reference {reference}{}: no {kind} variable", owner.map(|name| format!(" ({name})")).unwrap_or_default())]
    UnknownReference {
        kind: &'static str,
        reference: u32,
        owner: Option<&'static str>,
    },
    /// An output or a parameter that cannot be set, or not any more.
    #[error("{name}: cannot be set in the state {}; {reason}", state.name())]
    NotSettable {
        name: &'static str,
        state: State,
        reason: &'static str,
    },
    /// An output read before there is one.
    #[error("{name}: has no value in the state {}; outputs can be read from Initialization Mode on", state.name())]
    NotComputed { name: &'static str, state: State },
    /// A value that its variable does not allow.
    #[error(transparent)]
    Value(SceneError),
    /// Parameters that do not fit together, met while an output was read in Initialization Mode.
    #[error("outputs cannot be computed yet: {0}; correct the parameters before initialisation ends")]
    Preview(SceneError),
    /// Parameters that do not fit together.
    #[error(transparent)]
    Initialisation(SceneError),
    /// A communication step that could not be integrated.
    #[error(transparent)]
    Step(StepError),
    /// A derivative that leads an input out of its range.
    #[error("{0}; its derivative leads there in this step")]
    Course(SceneError),
    /// A number of the experiment that is not allowed.
    #[error("{name} = {value}: not allowed, {allowed}")]
    Argument {
        name: &'static str,
        value: f64,
        allowed: String,
    },
    /// A tolerance of the experiment that says nothing.
    #[error("tolerance = {0}: not used, as it is no positive finite number")]
    Tolerance(f64),
    /// A log category that is not declared.
    #[error(
        "category {0}: no such log category, allowed are logStatusError, logStatusWarning, logEvents and logSolver; nothing changed"
    )]
    Category(String),
    /// A derivative of an order there is not.
    #[error("{name}: no derivative of order {order}, allowed is 1")]
    Order { name: &'static str, order: i32 },
    /// A variable whose derivative cannot be set or read.
    #[error("{name}: not allowed, derivatives are those of continuous {role}")]
    NoDerivative { name: &'static str, role: &'static str },
    /// A status that this component does not have.
    #[error("status kind {0}: this component has no such status of this type")]
    StatusKind(u32),
    /// A state that is none of this component, or has been freed.
    #[error("argument {0} is no saved state of this component, or one that has been freed")]
    ForeignState(&'static str),
    /// Bytes that are no saved state of this component.
    #[error("argument serializedState is no saved state: {0}")]
    Serialized(String),
    /// Room of another size than the saved state has as bytes.
    #[error("size = {size}: not allowed, the saved state has {needed} bytes")]
    Size { size: usize, needed: usize },
    /// A capability that the description declares absent.
    #[error("not supported, as modelDescription.xml says by {0}")]
    Unsupported(&'static str),
    /// A panic stopped at the boundary.
    #[error("internal error: {0}")]
    Panic(String),
}

impl Failure {
    /// The status the call returns.
    pub(super) fn status(&self) -> fmi2Status {
        match self {
            Self::Tolerance(_) | Self::Category(_) => fmi2Warning,
            Self::Value(_) | Self::StatusKind(_) => fmi2Discard,
            Self::CallOrder { .. }
            | Self::Pointer(_)
            | Self::UnknownReference { .. }
            | Self::NotSettable { .. }
            | Self::NotComputed { .. }
            | Self::Preview(_)
            | Self::Initialisation(_)
            | Self::Step(_)
            | Self::Course(_)
            | Self::Argument { .. }
            | Self::Order { .. }
            | Self::NoDerivative { .. }
            | Self::Unsupported(_)
            | Self::ForeignState(_)
            | Self::Serialized(_)
            | Self::Size { .. }
            // Not fmi2Fatal: instances share nothing, and a reset builds this one anew.
            | Self::Panic(_) => fmi2Error,
        }
    }

    /// Whether the instance is left in the state error.
    ///
    /// After fmi2Error the standard binds the importer to reset or free the instance; it does not ask the component
    /// to refuse more than that. A call for an unsupported capability touches nothing, so the instance goes on for an
    /// importer that merely tried. An output that cannot be computed in Initialization Mode touches nothing either:
    /// parameters may be set one after the other there, and the next may make them fit. (The standard's list of functions
    /// that may return fmi2Discard in co-simulation does not have the fmi2Get functions, so that status is not free for it.)
    pub(super) fn ends_instance(&self) -> bool {
        self.status() == fmi2Error && !matches!(self, Self::Unsupported(_) | Self::Preview(_))
    }
}

fn listed(states: &[State]) -> String {
    match states {
        [] => "none".to_owned(),
        states => states.iter().map(|state| state.name()).collect::<Vec<_>>().join(", "),
    }
}
