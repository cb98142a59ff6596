//! Preallocated memory of the integrator, so that no step allocates, and the limit of steps.

use bytemuck::zeroed_box;

use crate::beam::mode::ModeStates;
use crate::closed_loop::dense::{DensePropagator, TipAtNodes};
use crate::closed_loop::propagator::{ByLength, Propagator};
use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::coefficients::Cache;
use crate::integrator::collocation::end::End;
use crate::integrator::collocation::part::Instant;
use crate::integrator::collocation::polynomial::{Collocation, OF_LONG, OF_SHORT};
use crate::integrator::constants::{DEPTH, LENGTHS, NEW_LENGTH, WORK};
use crate::integrator::events::log::Events;
use crate::integrator::motion::Motion;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;

/// Caches and scratch memory. Its content never affects results, only the time they take.
#[derive(Clone, Debug)]
pub struct Workspace {
    short: Cache<SHORT>,
    long: Cache<LONG>,
    /// Of the current trial step.
    short_end: Box<End<SHORT>>,
    /// See `short_end`.
    long_end: Box<End<LONG>>,
    /// Of the half steps of the energy balance.
    half_end: Box<End<LONG>>,
    /// Later halves of intervals in which a closing is sought: end, error of the cubic (m), depth.
    pub(crate) halves: Vec<(Instant, f64, usize)>,
    /// Modes at an instant inside it (event location).
    inside: Box<ModeStates>,
    /// Caches of exact linear steps, without and with dense output.
    pub(crate) propagators: ByLength<Box<Propagator>>,
    /// See [`Workspace::propagators`].
    dense_propagators: ByLength<DensePropagator>,
    /// The motion before a communication step, to which a failed one returns.
    pub(crate) former: Box<Motion>,
    /// Work so far, of rejected and probe steps too, in modes at nodes.
    pub(crate) work: u64,
    /// Openings and closings of the last communication step.
    pub events: Events,
}

impl Workspace {
    /// What it takes of memory for the model, bytes; the rest of a simulation takes far less.
    pub fn size(model: &Model) -> usize {
        let lengths = if model.closed_loop.is_some() { 2 * LENGTHS } else { 0 };
        let propagators = lengths * (size_of::<Propagator>() + model.modes.len() * size_of::<[TipAtNodes; 2]>());
        let ends = size_of::<End<SHORT>>() + 2 * size_of::<End<LONG>>();
        Cache::<SHORT>::size(model) + Cache::<LONG>::size(model) + propagators + ends
    }

    /// Allocates for the model.
    pub fn new(model: &Model) -> Self {
        let oscillators = model
            .closed_loop
            .as_ref()
            .map(|closed_loop| closed_loop.oscillators.len());
        let lengths = if oscillators.is_some() { LENGTHS } else { 0 };
        Self {
            short: Cache::new(model, &OF_SHORT),
            long: Cache::new(model, &OF_LONG),
            short_end: zeroed_box(),
            long_end: zeroed_box(),
            half_end: zeroed_box(),
            halves: Vec::with_capacity(DEPTH + 1),
            inside: zeroed_box(),
            propagators: ByLength::new(lengths, zeroed_box),
            dense_propagators: ByLength::new(lengths, || DensePropagator::room(oscillators.unwrap_or_default())),
            former: Motion::at_rest(model, 0.0),
            work: 0,
            events: Events::new(),
        }
    }
}

impl Workspace {
    /// For exact steps with dense output.
    pub(crate) fn for_exact_steps(&mut self) -> (&mut ByLength<DensePropagator>, &Collocation<LONG>) {
        (&mut self.dense_propagators, self.long.collocation())
    }

    /// For the half steps of the energy balance: coefficient cache, and what is left at their ends.
    pub(crate) fn for_half_steps(&mut self) -> (&mut Cache<LONG>, &mut End<LONG>) {
        (&mut self.long, &mut self.half_end)
    }
}

/// The parts of the workspace for steps with `S` nodes.
pub(crate) trait Room<const S: usize> {
    /// The polynomials of the steps.
    fn collocation(&self) -> &Collocation<S>;

    /// Coefficient cache, end of the trial step, modes at an instant inside it.
    fn parts(&mut self) -> (&mut Cache<S>, &mut End<S>, &mut ModeStates);
}

impl Room<SHORT> for Workspace {
    fn collocation(&self) -> &Collocation<SHORT> {
        self.short.collocation()
    }

    fn parts(&mut self) -> (&mut Cache<SHORT>, &mut End<SHORT>, &mut ModeStates) {
        (&mut self.short, &mut self.short_end, &mut self.inside)
    }
}

impl Room<LONG> for Workspace {
    fn collocation(&self) -> &Collocation<LONG> {
        self.long.collocation()
    }

    fn parts(&mut self) -> (&mut Cache<LONG>, &mut End<LONG>, &mut ModeStates) {
        (&mut self.long, &mut self.long_end, &mut self.inside)
    }
}

/// Work of a motion of the modes over `S` nodes, with coefficients that are kept, or with new ones.
pub(crate) fn work<const S: usize>(model: &Model, recurring: bool) -> u64 {
    let nodes = (model.modes.len() * S) as u64;
    if recurring { nodes } else { NEW_LENGTH * nodes }
}

/// Limit of the work of a communication step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Value of [`Workspace::work`] at which it is exhausted.
    limit: u64,
}

impl Budget {
    /// For a communication step that begins now.
    pub(crate) fn new(workspace: &Workspace) -> Self {
        let limit = workspace.work.saturating_add(WORK);
        Self { limit }
    }

    /// Checks the limit at the instant `time` (s).
    ///
    /// # Errors
    /// [`StepErrorCause::Budget`] if it is exhausted.
    pub(crate) fn check(self, workspace: &Workspace, time: f64) -> Result<(), StepError> {
        let cause = StepErrorCause::Budget;
        let exhausted = self.is_exhausted(workspace);
        (!exhausted).then_some(()).ok_or(StepError { time, cause })
    }

    /// Whether it is: a search inside a step then gives up, and the step counts for nothing.
    pub(crate) fn is_exhausted(self, workspace: &Workspace) -> bool {
        workspace.work >= self.limit
    }
}
