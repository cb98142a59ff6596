//! Everything of a step that depends on its length alone, and a cache of it.

use crate::excitation::Turns;
use crate::model::Model;
use crate::transient::collocation::{Collocation, MAX_SHAPES, Nodal};
use crate::transient::response::Response;

/// How a mode moves over a step. Its tip displacement counts, so the rows for the nodes carry the factor of the mode's tip.
#[derive(Clone, Copy, Debug)]
pub struct ModeStep<const S: usize> {
    /// Tip displacement at the nodes per initial q, and per initial v.
    pub tip_from_q: Nodal<S>,
    /// See [`ModeStep::tip_from_q`].
    pub tip_from_v: Nodal<S>,
    /// Tip velocity at the nodes per initial q, and per initial v.
    pub rate_from_q: Nodal<S>,
    /// See [`ModeStep::rate_from_q`].
    pub rate_from_v: Nodal<S>,
    /// q and v at the end per initial q and v, and per nodal load.
    pub q_from_q: f64,
    /// See [`ModeStep::q_from_q`].
    pub q_from_v: f64,
    /// See [`ModeStep::q_from_q`].
    pub v_from_q: f64,
    /// See [`ModeStep::q_from_q`].
    pub v_from_v: f64,
    /// See [`ModeStep::q_from_q`].
    pub q_from_load: Nodal<S>,
    /// See [`ModeStep::q_from_q`].
    pub v_from_load: Nodal<S>,
}

/// Displacement and velocity of the tip at the nodes per unit of the load at a node, one load after the other.
#[derive(Clone, Copy, Debug)]
pub struct TipColumns<const S: usize> {
    /// Displacement.
    pub displacement: [Nodal<S>; S],
    /// Velocity.
    pub velocity: [Nodal<S>; S],
}

/// Displacement and velocity of the tip at the nodes per unit of the shape of the error estimate.
#[derive(Clone, Copy, Debug)]
pub struct ErrorColumn<const S: usize> {
    /// Displacement.
    pub displacement: Nodal<S>,
    /// Velocity.
    pub velocity: Nodal<S>,
}

/// The coefficients of a step of one length.
#[derive(Clone, Debug)]
pub struct StepCoefficients<const S: usize> {
    /// The length, s.
    pub length: f64,
    /// Whether the rows for the nodes are filled in; free flight does not need them.
    complete: bool,
    /// Mode by mode.
    pub modes: Vec<ModeStep<S>>,
    /// Per force on the tip.
    pub force: TipColumns<S>,
    /// Per base acceleration acting on the modes as `participation`.
    pub acceleration: TipColumns<S>,
    /// Of the generator.
    pub turns: Turns<S>,
    /// Per force on the tip that the nodal polynomial misses.
    pub force_error: ErrorColumn<S>,
    /// Per base acceleration that the nodal polynomial misses.
    pub acceleration_error: ErrorColumn<S>,
}

impl<const S: usize> TipColumns<S> {
    const ZERO: Self = Self {
        displacement: [[0.0; S]; S],
        velocity: [[0.0; S]; S],
    };

    fn add(&mut self, node: usize, factor: f64, displacement: &[f64], velocity: &[f64]) {
        for (columns, values) in [(&mut self.displacement, displacement), (&mut self.velocity, velocity)] {
            for (column, value) in columns.iter_mut().zip(values) {
                set(column, node, |sum| sum + factor * value);
            }
        }
    }
}

impl<const S: usize> ErrorColumn<S> {
    const ZERO: Self = Self {
        displacement: [0.0; S],
        velocity: [0.0; S],
    };

    fn add(&mut self, node: usize, factor: f64, displacement: f64, velocity: f64) {
        set(&mut self.displacement, node, |sum| sum + factor * displacement);
        set(&mut self.velocity, node, |sum| sum + factor * velocity);
    }
}

impl<const S: usize> StepCoefficients<S> {
    /// Room for the modes, no length yet.
    fn empty(modes: usize) -> Self {
        let mode = ModeStep {
            tip_from_q: [0.0; S],
            tip_from_v: [0.0; S],
            rate_from_q: [0.0; S],
            rate_from_v: [0.0; S],
            q_from_q: 0.0,
            q_from_v: 0.0,
            v_from_q: 0.0,
            v_from_v: 0.0,
            q_from_load: [0.0; S],
            v_from_load: [0.0; S],
        };
        Self {
            length: 0.0,
            complete: false,
            modes: vec![mode; modes],
            force: TipColumns::ZERO,
            acceleration: TipColumns::ZERO,
            turns: Turns::none(),
            force_error: ErrorColumn::ZERO,
            acceleration_error: ErrorColumn::ZERO,
        }
    }

    /// Computes the coefficients of the length in place.
    fn fill(&mut self, length: f64, complete: bool, model: &Model, collocation: &Collocation<S>) {
        self.length = length;
        self.complete = complete;
        self.turns = model.generator.turns(length, &collocation.nodes);
        self.force = TipColumns::ZERO;
        self.acceleration = TipColumns::ZERO;
        self.force_error = ErrorColumn::ZERO;
        self.acceleration_error = ErrorColumn::ZERO;
        // The last node is the end.
        let skipped = if complete { 0 } else { S - 1 };
        for (mode, step) in model.modes.iter().zip(&mut self.modes) {
            let tip = mode.tip;
            for (node, &x) in collocation.nodes.iter().enumerate().skip(skipped) {
                let response = Response::new(mode.omega_squared, mode.damping, x * length, S + 1);
                set(&mut step.tip_from_q, node, |_| tip * response.q_from_q);
                set(&mut step.tip_from_v, node, |_| tip * response.q_from_v);
                set(&mut step.rate_from_q, node, |_| tip * response.v_from_q);
                set(&mut step.rate_from_v, node, |_| tip * response.v_from_v);
                let (displacement, velocity) = shape_responses(&response, x, length, collocation);
                self.force.add(node, tip * tip, &displacement, &velocity);
                self.acceleration
                    .add(node, tip * mode.participation, &displacement, &velocity);
                let last = |values: [f64; MAX_SHAPES]| values.get(S).copied().unwrap_or_default();
                let (error_q, error_v) = (last(displacement), last(velocity));
                self.force_error.add(node, tip * tip, error_q, error_v);
                self.acceleration_error
                    .add(node, tip * mode.participation, error_q, error_v);
                if node + 1 == S {
                    step.q_from_q = response.q_from_q;
                    step.q_from_v = response.q_from_v;
                    step.v_from_q = response.v_from_q;
                    step.v_from_v = response.v_from_v;
                    step.q_from_load
                        .iter_mut()
                        .zip(displacement)
                        .for_each(|(to, from)| *to = from);
                    step.v_from_load
                        .iter_mut()
                        .zip(velocity)
                        .for_each(|(to, from)| *to = from);
                }
            }
        }
    }
}

fn set<const S: usize>(values: &mut Nodal<S>, node: usize, value: impl Fn(f64) -> f64) {
    if let Some(entry) = values.get_mut(node) {
        *entry = value(*entry);
    }
}

/// Displacement and velocity of a mode at `x` (in steps) for each of the S + 1 load shapes.
fn shape_responses<const S: usize>(
    response: &Response,
    x: f64,
    length: f64,
    collocation: &Collocation<S>,
) -> ([f64; MAX_SHAPES], [f64; MAX_SHAPES]) {
    let t = x * length;
    let mut displacement = [0.0; MAX_SHAPES];
    let mut velocity = [0.0; MAX_SHAPES];
    let shapes = collocation.shapes.iter();
    for ((shape, displacement), velocity) in shapes.zip(&mut displacement).zip(&mut velocity) {
        let mut power = 1.0;
        let mut below = response.q_from_v / t;
        let mut sizes = (0.0, 0.0);
        for (coefficient, &moment) in shape.iter().zip(&response.moments).take(S + 1) {
            let terms = (coefficient * power * moment, coefficient * power * below);
            *displacement += terms.0;
            *velocity += terms.1;
            sizes = (sizes.0 + terms.0.abs(), sizes.1 + terms.1.abs());
            power *= x;
            below = moment;
        }
        // What cancels down to rounding is nothing.
        let significant = |sum: f64, size: f64| {
            if sum.abs() > 16.0 * f64::EPSILON * size {
                sum
            } else {
                0.0
            }
        };
        *displacement = t * t * significant(*displacement, sizes.0);
        *velocity = t * significant(*velocity, sizes.1);
    }
    (displacement, velocity)
}

/// Coefficients by step length. What is in the cache never changes a result, only the time it takes.
#[derive(Clone, Debug)]
pub struct Cache<const S: usize> {
    collocation: Collocation<S>,
    slots: Vec<StepCoefficients<S>>,
    other: StepCoefficients<S>,
}

/// Slots for step lengths that come again.
const SLOTS: usize = 64;

impl<const S: usize> Cache<S> {
    /// For a model with this many modes.
    pub fn new(modes: usize) -> Self {
        Self {
            collocation: Collocation::new(),
            slots: vec![StepCoefficients::empty(modes); SLOTS],
            other: StepCoefficients::empty(modes),
        }
    }

    /// The polynomials.
    pub fn collocation(&self) -> &Collocation<S> {
        &self.collocation
    }

    /// The coefficients of the length for the model; `recurring` says whether to keep them for later.
    pub fn get(&mut self, length: f64, recurring: bool, model: &Model) -> (&StepCoefficients<S>, &Collocation<S>) {
        let Self {
            collocation,
            slots,
            other,
        } = self;
        let slot = (length.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 58) as usize;
        let entry = slots.get_mut(slot).filter(|_| recurring).unwrap_or(other);
        if entry.length.to_bits() != length.to_bits() || !entry.complete {
            entry.fill(length, true, model, collocation);
        }
        (entry, collocation)
    }

    /// The coefficients of a step of free flight that is only to be looked at.
    pub fn flight(&mut self, length: f64, model: &Model) -> (&StepCoefficients<S>, &Collocation<S>) {
        let Self { collocation, other, .. } = self;
        other.fill(length, false, model, collocation);
        (other, collocation)
    }
}
