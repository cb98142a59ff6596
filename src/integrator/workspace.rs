//! Room for the steps, made once, so that no step allocates.

use crate::beam::mode::{MAX_MODES, ModeState, ModeStates};
use crate::closed_loop::propagator::Propagators;
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
