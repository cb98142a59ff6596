//! Everything of a step that depends on its length alone, and a cache of it.

use crate::excitation::{Generator, Turns};
use crate::model::{Mode, Model};
use crate::transient::collocation::{Collocation, NODES, Nodal, SHAPES};
use crate::transient::response::Response;

/// How a mode moves over a step. Its tip displacement counts, so the rows for the nodes carry the factor of the mode's tip.
#[derive(Clone, Copy, Debug, Default)]
pub struct ModeStep {
    /// Tip displacement at the nodes per initial q, and per initial v.
    pub tip_from_q: Nodal,
    /// See [`ModeStep::tip_from_q`].
    pub tip_from_v: Nodal,
    /// Tip velocity at the nodes per initial q, and per initial v.
    pub rate_from_q: Nodal,
    /// See [`ModeStep::rate_from_q`].
    pub rate_from_v: Nodal,
    /// q and v at the end per initial q and v, and per nodal load.
    pub q_from_q: f64,
    /// See [`ModeStep::q_from_q`].
    pub q_from_v: f64,
    /// See [`ModeStep::q_from_q`].
    pub v_from_q: f64,
    /// See [`ModeStep::q_from_q`].
    pub v_from_v: f64,
    /// See [`ModeStep::q_from_q`].
    pub q_from_load: Nodal,
    /// See [`ModeStep::q_from_q`].
    pub v_from_load: Nodal,
}

/// Displacement and velocity of the tip at the nodes per unit of the load at a node, one load after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct TipColumns {
    /// Displacement.
    pub displacement: [Nodal; NODES],
    /// Velocity.
    pub velocity: [Nodal; NODES],
}

/// Displacement and velocity of the tip at the end of the step per unit of the two shapes of the error estimate.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErrorRows {
    /// Displacement.
    pub displacement: [f64; 2],
    /// Velocity.
    pub velocity: [f64; 2],
}

/// The coefficients of a step of one length.
#[derive(Clone, Debug)]
pub struct StepCoefficients {
    /// The length, s.
    pub length: f64,
    /// Mode by mode.
    pub modes: Vec<ModeStep>,
    /// Per force on the tip.
    pub force: TipColumns,
    /// Per base acceleration acting on the modes as `participation`.
    pub acceleration: TipColumns,
    /// Of the generator.
    pub turns: Turns,
    /// Per force on the tip that the nodal polynomial misses.
    pub force_error: ErrorRows,
    /// Per base acceleration that the nodal polynomial misses.
    pub acceleration_error: ErrorRows,
}

impl StepCoefficients {
    /// Room for the modes, no length yet.
    fn empty(modes: usize) -> Self {
        Self {
            length: 0.0,
            modes: vec![ModeStep::default(); modes],
            force: TipColumns::default(),
            acceleration: TipColumns::default(),
            turns: Turns::default(),
            force_error: ErrorRows::default(),
            acceleration_error: ErrorRows::default(),
        }
    }

    /// Computes the coefficients of the length in place.
    fn fill(&mut self, length: f64, modes: &[Mode], generator: &Generator, collocation: &Collocation) {
        self.length = length;
        self.turns = generator.turns(length, &collocation.nodes);
        self.force = TipColumns::default();
        self.acceleration = TipColumns::default();
        self.force_error = ErrorRows::default();
        self.acceleration_error = ErrorRows::default();
        for (mode, step) in modes.iter().zip(&mut self.modes) {
            let tip = mode.tip;
            for (row, &node) in collocation.nodes.iter().enumerate() {
                let response = Response::new(mode.omega_squared, mode.damping, node * length);
                let set = |values: &mut Nodal, value: f64| values.iter_mut().skip(row).take(1).for_each(|v| *v = value);
                set(&mut step.tip_from_q, tip * response.q_from_q);
                set(&mut step.tip_from_v, tip * response.q_from_v);
                set(&mut step.rate_from_q, tip * response.v_from_q);
                set(&mut step.rate_from_v, tip * response.v_from_v);
                let (displacement, velocity) = shape_responses(&response, node, length, collocation);
                add_row(&mut self.force, row, tip * tip, &displacement, &velocity);
                add_row(
                    &mut self.acceleration,
                    row,
                    tip * mode.participation,
                    &displacement,
                    &velocity,
                );
            }
            let response = Response::new(mode.omega_squared, mode.damping, length);
            step.q_from_q = response.q_from_q;
            step.q_from_v = response.q_from_v;
            step.v_from_q = response.v_from_q;
            step.v_from_v = response.v_from_v;
            let (displacement, velocity) = shape_responses(&response, 1.0, length, collocation);
            copy(&mut step.q_from_load, &displacement);
            copy(&mut step.v_from_load, &velocity);
            add_error(&mut self.force_error, tip * tip, &displacement, &velocity);
            add_error(
                &mut self.acceleration_error,
                tip * mode.participation,
                &displacement,
                &velocity,
            );
        }
    }
}

/// Displacement and velocity of a mode at `x` (in steps) for each load shape.
fn shape_responses(
    response: &Response,
    x: f64,
    length: f64,
    collocation: &Collocation,
) -> ([f64; SHAPES], [f64; SHAPES]) {
    let t = x * length;
    let mut displacement = [0.0; SHAPES];
    let mut velocity = [0.0; SHAPES];
    for ((shape, displacement), velocity) in collocation.shapes.iter().zip(&mut displacement).zip(&mut velocity) {
        let mut power = 1.0;
        let mut below = response.q_from_v / t;
        for (coefficient, &moment) in shape.iter().zip(&response.moments) {
            *displacement += coefficient * power * moment;
            *velocity += coefficient * power * below;
            power *= x;
            below = moment;
        }
        *displacement *= t * t;
        *velocity *= t;
    }
    (displacement, velocity)
}

fn copy(to: &mut Nodal, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}

fn add_row(columns: &mut TipColumns, row: usize, factor: f64, displacement: &[f64], velocity: &[f64]) {
    let add = |columns: &mut [Nodal; NODES], values: &[f64]| {
        for (column, value) in columns.iter_mut().zip(values) {
            column
                .iter_mut()
                .skip(row)
                .take(1)
                .for_each(|sum| *sum += factor * value);
        }
    };
    add(&mut columns.displacement, displacement);
    add(&mut columns.velocity, velocity);
}

fn add_error(rows: &mut ErrorRows, factor: f64, displacement: &[f64], velocity: &[f64]) {
    let add = |sums: &mut [f64; 2], values: &[f64]| {
        sums.iter_mut()
            .zip(values.iter().skip(NODES))
            .for_each(|(sum, value)| *sum += factor * value);
    };
    add(&mut rows.displacement, displacement);
    add(&mut rows.velocity, velocity);
}

/// Coefficients by step length. What is in the cache never changes a result, only the time it takes.
#[derive(Clone, Debug)]
pub struct Cache {
    collocation: Collocation,
    slots: Vec<StepCoefficients>,
}

/// Slots for step lengths that come again; one more serves the lengths that do not.
const SLOTS: usize = 64;

impl Cache {
    /// For a model with this many modes.
    pub fn new(modes: usize) -> Self {
        Self {
            collocation: Collocation::new(),
            slots: vec![StepCoefficients::empty(modes); SLOTS + 1],
        }
    }

    /// The nodes.
    pub fn collocation(&self) -> &Collocation {
        &self.collocation
    }

    /// The coefficients of the length for the model; `recurring` says whether to keep them for later.
    pub fn get(&mut self, length: f64, recurring: bool, model: &Model) -> (&StepCoefficients, &Collocation) {
        let slot = if recurring {
            (length.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 58) as usize % SLOTS
        } else {
            SLOTS
        };
        let Self { collocation, slots } = self;
        let slot = slot.min(slots.len() - 1);
        #[expect(
            clippy::indexing_slicing,
            reason = "the slot is below the length, see the line above"
        )]
        let entry = &mut slots[slot];
        if entry.length.to_bits() != length.to_bits() {
            entry.fill(length, &model.modes, &model.generator, collocation);
        }
        (entry, collocation)
    }
}
