//! A communication step, or one step of the integrator's own, under way: what all its parts share.
use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::{Grid, Target};
use crate::integrator::workspace::{Room, Workspace};
use crate::math::prediction::Prediction;
use crate::model::Model;
use crate::state::State;
use serde::{Deserialize, Serialize};

/// A communication step under way.
pub(crate) struct Integration<'a> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a mut State,
    pub(crate) workspace: &'a mut Workspace,
    pub(crate) drive: Drive,
    pub(crate) grid: Grid,
    /// The instant beyond which the step is looked into, s, and what the tip does in it.
    pub(crate) dense: Option<(f64, &'a mut DenseOutput)>,
    /// Of the contact force, where they are asked for.
    pub(crate) extremes: Option<&'a mut Extremes>,
    /// Error allowed in the contact force, N.
    pub(crate) tolerance: f64,
    /// Error allowed in a step, N.
    pub(crate) allowed: f64,
    /// Steps given up in succession.
    pub(crate) refusals: u32,
    /// Whether the energy changes by the work done alone.
    pub(crate) conserves: bool,
}

/// The tip over a step: polynomials about its end, in steps. Deviations from the preload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseOutput {
    /// Whether they are within the tolerance; just after a blow no polynomial is.
    pub good: bool,
    /// Contact force, N.
    pub force: Prediction,
    /// Indentation, m.
    pub indentation: Prediction,
    /// Its velocity, m/s.
    pub rate: Prediction,
}

/// How far to advance.
#[derive(Debug)]
pub(crate) enum Steps<'a> {
    /// From the instant `time` (s) by `size` (s), neither more nor less.
    Exactly {
        /// s.
        time: f64,
        /// s.
        size: f64,
    },
    /// By one step as long as the error allows, also within it where it goes beyond the instant `until` (s); what the
    /// tip does in it goes to `dense`.
    Own {
        /// s.
        until: f64,
        /// See [`Steps::Own`].
        dense: &'a mut DenseOutput,
    },
}

/// What a step says about the next.
pub(crate) struct StepOutcome {
    /// Whether it was taken.
    pub(crate) taken: bool,
    /// How many times as long as this one it could have been.
    pub(crate) growth: f64,
    /// Length wanted next, s.
    pub(crate) length: f64,
}

impl StepOutcome {
    /// After a step of `length` seconds taken, where `wanted` seconds were wanted.
    pub(crate) fn after(length: f64, wanted: f64, growth: f64) -> Self {
        let next = growth.min(4.0) * length;
        Self {
            taken: true,
            growth,
            // A step cut short by the grid says nothing against the length wanted before.
            length: if length < 0.9 * wanted { wanted.max(next) } else { next },
        }
    }
}

impl Integration<'_> {
    pub(crate) fn error(&self, cause: StepErrorCause) -> StepError {
        StepError {
            time: self.state.time,
            cause,
        }
    }

    /// Whether the step is as short as steps get: half of it would be too short.
    pub(crate) fn is_shortest(&self, target: &Target) -> bool {
        target.length <= 2.0 * self.shortest()
    }

    /// Length below which no step is wanted, s.
    pub(crate) fn shortest(&self) -> f64 {
        8.0 * self.resolution()
    }

    /// Difference between instants that cannot be told apart, s.
    pub(crate) fn resolution(&self) -> f64 {
        f64::EPSILON * (self.grid.start.abs() + self.grid.size)
    }

    /// The polynomials of the steps.
    pub(crate) fn collocation<const S: usize>(&mut self) -> &Collocation<S>
    where
        Workspace: Room<S>,
    {
        self.workspace.parts().0.collocation()
    }
}
