//! Preallocated memory of the integrator, so that no step allocates, and the limit of work.

use bytemuck::zeroed_box;

use crate::beam::mode::ModeStates;
use crate::closed_loop::dense::{DensePropagator, TipAtNodes};
use crate::closed_loop::propagator::{ByLength, Propagator};
use crate::contact::law::Law;
use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::cache::{Cache, Left, OF_LONG, OF_SHORT};
use crate::integrator::collocation::modal_response::ModeOverStep;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::collocation::polynomial::{Collocation, LONG_BY_TIME, SHORT_BY_TIME};
use crate::integrator::collocation::trial::{Scratch, Trial};
use crate::integrator::constants::HALVINGS;
use crate::integrator::events::log::Events;
use crate::integrator::events::swings::Swings;
use crate::integrator::motion::Motion;
use crate::link::Link;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::shared::Home;
use crate::state::State;

/// Work that a communication step may take, however long it is, in modes at nodes: each takes some forty instructions, all
/// together one to three seconds on processors of 2026. Pinned: ÷ 1e5 and × 100, `tests/fmi_api`.
pub const WORK: u64 = 500_000_000;

/// Work of a step of a new length, in that of one of a known length. Instructions of both. Cost.
pub const NEW_LENGTH: u64 = 10;

/// Step lengths for which the coefficients of exact linear steps are kept. Chosen. Cost.
pub const LENGTHS: usize = 8;

/// Caches and scratch memory. Its content never affects results, only the time they take.
#[derive(Clone, Debug)]
pub struct Workspace {
    short: Room<SHORT>,
    pub(crate) long: Room<LONG>,
    /// Longest leap, s, where the model allows them.
    pub(crate) longest_leap: Option<f64>,
    /// The half steps of the energy balance.
    pub(crate) half: Box<Trial<LONG>>,
    pub(crate) search: Search,
    /// Caches of exact linear steps, without and with dense output.
    pub(crate) propagators: ByLength<Box<Propagator>>,
    /// See [`Workspace::propagators`].
    pub(crate) dense_propagators: ByLength<DensePropagator>,
    /// The motion before a communication step, to which a failed one returns.
    pub(crate) former: Box<Motion>,
    /// Openings and closings of the last communication step.
    pub events: Events,
}

/// See [`Workspace::longest_leap`]: leaps are for a model whose contact force is smooth by the root of the time since a closing, and
/// all that happens after it.
fn longest_leap(model: &Model) -> Option<f64> {
    let is_smooth = |law: &Law| (2.0 * law.exponent).fract() == 0.0;
    let mut laws = model.links.iter().filter_map(Link::contact);
    let leaps = laws.all(is_smooth) && model.axial.is_none() && model.friction().is_none();
    let longest = model.modes.iter().map(ModeOverStep::longest_by_root);
    leaps.then(|| longest.fold(f64::INFINITY, f64::min))
}

/// For steps with `S` nodes.
#[derive(Clone, Debug)]
pub(crate) struct Room<const S: usize> {
    pub(crate) cache: Box<Cache<S>>,
    pub(crate) scratch: Scratch<S>,
    /// The trial step; none while it is looked at.
    pub(crate) trial: Option<Box<Trial<S>>>,
}

/// For searches inside a step.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    /// The modes at the instant looked at last.
    pub(crate) modes: Box<ModeStates>,
    /// That instant, s after the start of the trial; `None`: of another trial.
    pub(crate) looked: Option<f64>,
    /// Later halves of intervals in which a closing is sought: end, error of the cubic (m), depth.
    pub(crate) halves: Vec<(Instant, f64, u32)>,
    /// The modes that oscillate in the trial in which it is sought.
    pub(crate) swings: Swings,
    /// Work in this communication step so far, of rejected and probe steps too, in modes at nodes.
    pub(crate) work: u64,
}

impl<const S: usize> Room<S> {
    fn new(model: &Model, home: &'static Home<Left<S>>, collocation: &'static Collocation<S>) -> Self {
        Self {
            cache: Box::new(Cache::new(model, home, collocation)),
            scratch: Scratch::new(model),
            trial: Some(zeroed_box()),
        }
    }

    /// A trial of `length` seconds made in it.
    pub(crate) fn whole<'a>(
        &'a self,
        (model, state, drive): (&'a Model, &'a State, &'a Drive),
        trial: &'a Trial<S>,
        length: f64,
    ) -> Whole<'a, S> {
        Whole { model, state, drive, collocation: self.cache.collocation, trial, axial: &self.scratch.axial, length }
    }
}

impl Workspace {
    /// What it takes of memory for the model, bytes; the rest of a simulation takes far less.
    pub fn size(model: &Model) -> usize {
        let lengths = if model.closed_loop.is_some() { 2 * LENGTHS } else { 0 };
        let propagators = lengths * (size_of::<Propagator>() + model.modes.len() * size_of::<[TipAtNodes; 2]>());
        let trials = size_of::<Trial<SHORT>>() + 2 * size_of::<Trial<LONG>>();
        Cache::<SHORT>::size(model) + Cache::<LONG>::size(model) + propagators + trials
    }

    /// Allocates for the model.
    pub fn new(model: &Model) -> Self {
        let oscillators = model.closed_loop.as_ref().map(|closed_loop| closed_loop.oscillators.len());
        let lengths = if oscillators.is_some() { LENGTHS } else { 0 };
        Self {
            short: Room::new(model, &OF_SHORT, &SHORT_BY_TIME),
            long: Room::new(model, &OF_LONG, &LONG_BY_TIME),
            longest_leap: longest_leap(model),
            half: zeroed_box(),
            search: Search {
                modes: zeroed_box(),
                looked: None,
                halves: Vec::with_capacity(HALVINGS as usize + 1),
                swings: Swings::room(model.modes.len()),
                work: 0,
            },
            propagators: ByLength::new(lengths, zeroed_box),
            dense_propagators: ByLength::new(lengths, || DensePropagator::room(oscillators.unwrap_or_default())),
            former: Motion::at_rest(model, 0.0),
            events: Events::new(),
        }
    }
}

/// The parts of the workspace for steps with `S` nodes.
pub(crate) trait Rooms<const S: usize> {
    /// For the steps.
    fn room(&self) -> &Room<S>;

    /// For the steps, and for searches inside them.
    fn parts(&mut self) -> (&mut Room<S>, &mut Search);
}

impl Rooms<SHORT> for Workspace {
    fn room(&self) -> &Room<SHORT> {
        &self.short
    }

    fn parts(&mut self) -> (&mut Room<SHORT>, &mut Search) {
        (&mut self.short, &mut self.search)
    }
}

impl Rooms<LONG> for Workspace {
    fn room(&self) -> &Room<LONG> {
        &self.long
    }

    fn parts(&mut self) -> (&mut Room<LONG>, &mut Search) {
        (&mut self.long, &mut self.search)
    }
}

/// Work of a motion of the modes over `S` nodes, with coefficients that are kept, or with new ones.
pub(crate) fn work<const S: usize>(model: &Model, recurring: bool) -> u64 {
    let nodes = (model.modes.len() * S) as u64;
    if recurring { nodes } else { NEW_LENGTH * nodes }
}

impl Search {
    /// Checks at the instant `time` (s) whether there is work left in this communication step.
    ///
    /// # Errors
    /// [`StepErrorCause::Budget`] if there is none.
    pub(crate) fn check(&self, time: f64) -> Result<(), StepError> {
        let cause = StepErrorCause::Budget;
        (!self.is_exhausted()).then_some(()).ok_or(StepError { time, cause })
    }

    /// Whether there is none left: a search inside a step then gives up, and the step counts for nothing.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.work >= WORK
    }
}
