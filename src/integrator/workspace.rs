//! Room for the steps, made once, so that no step allocates.

use crate::beam::mode::{MAX_MODES, ModeState, ModeStates};
use crate::closed_loop::propagator::Propagators;
use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::coefficients::Cache;
use crate::integrator::events::log::Events;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;

/// Scratch of the steps. Nothing in it changes a result, only the time it takes.
#[derive(Clone, Debug)]
pub struct Workspace {
    short: Cache<SHORT>,
    long: Cache<LONG>,
    /// The modes at the end of the step about to be taken.
    end: ModeStates,
    /// The modes at instants looked at.
    probe: ModeStates,
    /// Of exact steps.
    pub(crate) propagators: Propagators,
    /// Steps computed so far, taken, repeated, or only looked at; those of a new length count for several.
    pub(crate) work: u64,
    /// Of the last communication step.
    pub events: Events,
}

impl Workspace {
    /// For the model.
    pub fn new(model: &Model) -> Self {
        Self {
            short: Cache::new(model),
            long: Cache::new(model),
            end: [ModeState::default(); MAX_MODES],
            probe: [ModeState::default(); MAX_MODES],
            propagators: Propagators::default(),
            work: 0,
            events: Events::new(),
        }
    }
}

/// A workspace for steps with `S` nodes.
pub(crate) trait Room<const S: usize> {
    /// The cache, and room for the modes at the end of the step and at instants looked at.
    fn parts(&mut self) -> (&mut Cache<S>, &mut ModeStates, &mut ModeStates);
}

impl Room<SHORT> for Workspace {
    fn parts(&mut self) -> (&mut Cache<SHORT>, &mut ModeStates, &mut ModeStates) {
        (&mut self.short, &mut self.end, &mut self.probe)
    }
}

impl Room<LONG> for Workspace {
    fn parts(&mut self) -> (&mut Cache<LONG>, &mut ModeStates, &mut ModeStates) {
        (&mut self.long, &mut self.end, &mut self.probe)
    }
}

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
