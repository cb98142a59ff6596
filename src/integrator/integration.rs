//! The data shared by all parts of an integration in progress: a communication step, or one free step.

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::STEP_GROWTH;
use crate::integrator::dense_output::DenseOutput;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::{Grid, Target};
use crate::integrator::workspace::{Budget, Room, Workspace};
use crate::model::Model;
use crate::state::State;

/// An integration in progress.
pub(crate) struct Integration<'a> {
    /// The contact that is looked at, as the only one that may be closed.
    pub(crate) model: &'a Model,
    /// The other one, where there are two.
    pub(crate) other: Option<&'a Model>,
    pub(crate) state: &'a mut State,
    pub(crate) workspace: &'a mut Workspace,
    pub(crate) budget: Budget,
    pub(crate) drive: Drive,
    pub(crate) grid: Grid,
    /// Dense output of a free step, read from the given instant (s) on.
    pub(crate) dense: Option<(f64, &'a mut DenseOutput)>,
    /// Extremes of the contact force, if requested.
    pub(crate) extremes: Option<&'a mut Extremes>,
    /// Tolerance of the contact force, N.
    pub(crate) tolerance: f64,
    /// Error allowed per step, N.
    pub(crate) allowed: f64,
    /// Successive rejected steps.
    pub(crate) refusals: u32,
    /// Whether one of them was too long to end at an event inside.
    pub(crate) before_event: bool,
    /// Changes between stick and slip in succession that took no time.
    pub(crate) changes: u32,
    /// Whether an input has changed as the communication step began, in a contact that is closed since the beginning.
    pub(crate) driven: bool,
    /// Whether the energy changes only by the work of the drive ([`crate::integrator::energy::conservation`]).
    pub(crate) conserves: bool,
}

/// How far to advance.
#[derive(Debug)]
pub(crate) enum Steps<'a> {
    /// From `time` exactly to `time + size`.
    Exactly {
        /// s.
        time: f64,
        /// s.
        size: f64,
        /// What is new in it.
        news: News,
    },
    /// By one step as long as the error allows, with dense output.
    Own {
        /// Dense output is read from here on where the step goes beyond it, within the tolerance, s.
        until: f64,
        /// The tip during the step.
        dense: &'a mut DenseOutput,
    },
}

/// What a communication step has that the one before it had not, as if that were to go on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct News {
    /// An input that has changed.
    pub(crate) inputs: bool,
    /// Another length.
    pub(crate) length: bool,
}

/// Outcome of a step: accepted or rejected, and the size of the next one.
pub(crate) struct StepOutcome {
    /// Whether it was accepted.
    pub(crate) taken: bool,
    /// Whether the contact opened or closed with it, or began or ceased to slip: short steps begin anew.
    pub(crate) switched: bool,
    /// Factor to its length that its error would have allowed.
    pub(crate) growth: f64,
    /// Proposed length of the next step, s.
    pub(crate) length: f64,
}

impl StepOutcome {
    /// After an accepted step of `length` seconds where `requested` seconds were proposed.
    pub(crate) fn after(length: f64, requested: f64, growth: f64) -> Self {
        let next = growth.min(STEP_GROWTH) * length;
        Self {
            taken: true,
            switched: false,
            growth,
            // A step shortened by the grid keeps the size proposed before.
            length: if length < 0.9 * requested {
                requested.max(next)
            } else {
                next
            },
        }
    }
}

/// Rounding of time from `start` over `size` (s): spacing of floating-point numbers, s.
pub(crate) fn resolution(start: f64, size: f64) -> f64 {
    f64::EPSILON * (start.abs() + size)
}

impl Integration<'_> {
    pub(crate) fn error(&self, cause: StepErrorCause) -> StepError {
        StepError {
            time: self.state.time,
            cause,
        }
    }

    /// Whether the step cannot be halved.
    pub(crate) fn is_shortest(&self, target: &Target) -> bool {
        target.length <= 2.0 * self.shortest()
    }

    /// Shortest step, s.
    pub(crate) fn shortest(&self) -> f64 {
        8.0 * self.resolution()
    }

    /// Rounding of time in the communication step, s.
    pub(crate) fn resolution(&self) -> f64 {
        resolution(self.grid.start, self.grid.size)
    }

    /// The polynomials of the steps.
    pub(crate) fn collocation<const S: usize>(&self) -> &Collocation<S>
    where
        Workspace: Room<S>,
    {
        Room::<S>::collocation(self.workspace)
    }
}
