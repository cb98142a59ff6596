//! The work that a communication step may take, so that every one of them comes to an end.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::workspace::Workspace;

/// Integration steps of known lengths that a communication step may take, and further ones per second of it.
const STEPS: u64 = 10_000_000;
/// See [`STEPS`].
const RATE: f64 = 1e7;

/// Work of a step of a new length, in steps of known lengths: its coefficients have to be computed.
const NEW_LENGTH: u64 = 10;

/// Work of a step whose length comes again, or is new, in steps of known lengths.
pub(crate) fn work(recurring: bool) -> u64 {
    if recurring { 1 } else { NEW_LENGTH }
}

/// What a communication step may still take, in integration steps of known lengths, also repeated ones and ones only
/// looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    steps: u64,
    /// The work of all communication steps so far at which it is spent.
    limit: u64,
}

impl Budget {
    /// From here on, for `size` seconds.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of steps, saturating"
    )]
    pub(crate) fn new(workspace: &Workspace, size: f64) -> Self {
        let steps = STEPS.saturating_add((size * RATE) as u64);
        Self {
            steps,
            limit: workspace.work.saturating_add(steps),
        }
    }

    /// Whether there is something left at the instant `time` (s).
    ///
    /// # Errors
    /// [`StepErrorCause::Budget`] where it is spent.
    pub(crate) fn check(&self, workspace: &Workspace, time: f64) -> Result<(), StepError> {
        let cause = StepErrorCause::Budget(self.steps);
        let left = workspace.work < self.limit;
        left.then_some(()).ok_or(StepError { time, cause })
    }
}
