//! A trial step: the nodal contact forces ([`crate::integrator::collocation::newton`]), the motion they cause, and its
//! error ([`crate::integrator::collocation::error`]).

use crate::beam::axial::Feedback;
use crate::beam::mode::{Modal, ModeStates};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::axial_force;
use crate::integrator::collocation::coefficients::{EndRows, Prepared, StepCoefficients};
use crate::integrator::collocation::end::End;
use crate::integrator::collocation::error::{Estimate, errors};
use crate::integrator::collocation::newton::{
    FreeResponse, Solution, Source, Tangent, at_nodes, closed_forces, first_forces,
};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{FORCE_ROUNDING, QUADRATURE_LONG, QUADRATURE_SHORT};
use crate::math::nodal::{Nodal, SHORT, add, add_columns, add_products, dot, end};
use crate::math::simd::{Arithmetic, LANES};
use crate::model::Model;
use crate::state::State;

/// A step computed but not yet accepted.
#[derive(Clone, Copy, Debug)]
pub struct Trial<const S: usize> {
    /// Nodal forces as deviation from the preload force, N.
    pub forces: Nodal<S>,
    /// Indentation at the nodes as deviation from the preload, m.
    pub indentations: Nodal<S>,
    /// Its velocity at the nodes, m/s.
    pub rates: Nodal<S>,
    /// Base acceleration at the nodes, m/s2.
    pub accelerations: Nodal<S>,
    /// Displacement of the fixed contact at the end, m.
    pub support: f64,
    /// Indentation at the end as deviation from the preload, m.
    pub indentation: f64,
    /// Its velocity at the end, m/s.
    pub rate: f64,
    /// Contact force at the end as deviation from the preload force, N: the last of the nodal forces, unless it ends
    /// inside the step that was computed.
    pub force: f64,
    /// Estimate of the error this step adds to the contact force, N.
    pub error: Estimate,
    /// Estimate of the same at instants inside the step, N.
    pub inner_error: Estimate,
    /// Rounding of the contact force, N: an error estimate below it is meaningless.
    pub rounding: f64,
    /// Defect of the force polynomial at the start: difference from the contact force there, N.
    pub start_defect: f64,
    /// Estimate of the terms beyond it, N.
    pub next_terms: f64,
    /// Newton iterations.
    pub iterations: u64,
    /// Tangent of the contact law.
    pub tangent: Tangent,
}

impl<const S: usize> Trial<S> {
    /// In the view of the other contact ([`State::mirror`]), with the second fixed contact at these places (m) at the
    /// nodes, moving at this velocity (m/s).
    pub(crate) fn mirrored(&self, second: &Nodal<S>, second_rate: f64) -> Self {
        let mut indentations = *second;
        for (image, own) in indentations.iter_mut().zip(&self.indentations) {
            *image -= own;
        }
        Self {
            forces: self.forces.map(|force| -force),
            force: -self.force,
            accelerations: self.accelerations.map(|acceleration| -acceleration),
            indentations,
            rates: self.rates.map(|rate| second_rate - rate),
            support: end(second) - self.support,
            indentation: end(second) - self.indentation,
            rate: second_rate - self.rate,
            ..*self
        }
    }
}

/// The loads on [`LANES`] modes at the nodes.
pub(super) type LaneLoads<const S: usize> = [[f64; LANES]; S];

/// [`trial`](super::trial::trial) with constant axial force, which is part of the modes.
#[inline(always)]
pub(super) fn compute<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source<S>,
    end: &mut End<S>,
) -> Option<Trial<S>> {
    let Prepared { step, collocation, .. } = prepared;
    let free = free_response::<S, A>(state, drive, &prepared);
    let guess = first_forces::<S, A>(model, state, step, collocation, source);
    let solution = match source {
        Source::Law(newton) if state.closed => {
            let stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
            closed_forces::<S, A>(
                model,
                (&step.force, &step.force_error),
                &free,
                guess,
                (newton, stiffness),
            )?
        }
        _ => Solution::given(guess),
    };
    let coefficients = (step, collocation);
    Some(judged::<S, A>(
        model,
        state,
        drive,
        coefficients,
        (&solution, &[]),
        &free,
        &mut end.modes,
    ))
}

/// [`trial`](super::trial::trial) with an axial force that follows the deflection, as loads on the modes.
#[inline(always)]
pub(super) fn compute_with_axial_force<const S: usize, A: Arithmetic>(
    model: &Model,
    axial: &Feedback,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source<S>,
    end: &mut End<S>,
) -> Option<Trial<S>> {
    let Prepared { step, collocation, .. } = prepared;
    let free = free_response::<S, A>(state, drive, &prepared);
    let (solution, error) = axial_force::settle::<S, A>(model, axial, state, (step, collocation), source, &free, end)?;
    // One combined defect of all loads.
    let free = FreeResponse {
        error: &error,
        start_defect: 1.0,
        ..axial_force::with_loads::<S, A>(model, &free, step, &end.loads)
    };
    let coefficients = (step, collocation);
    Some(judged::<S, A>(
        model,
        state,
        drive,
        coefficients,
        (&solution, &end.loads),
        &free,
        &mut end.modes,
    ))
}

/// Response of the tip to everything but the contact force.
#[inline(always)]
pub(super) fn free_response<'a, const S: usize, A: Arithmetic>(
    state: &State,
    drive: &Drive,
    prepared: &Prepared<'a, S>,
) -> FreeResponse<'a, S> {
    let Prepared {
        step,
        collocation,
        generated,
    } = prepared;
    let h = step.length;
    let driven = drive.acceleration(state.time);
    let mut accelerations = generated.nodes;
    add::<S, A>(&mut accelerations, drive.jerk * h, &collocation.nodes);
    for acceleration in &mut accelerations {
        *acceleration += driven;
    }

    let mut free = [state.support; S];
    add::<S, A>(&mut free, drive.support_rate * h, &collocation.nodes);
    let mut free_rate = [drive.support_rate; S];
    // Separate sums for q and v, which the processor computes in parallel.
    let [mut from_q, mut from_v, mut rate_from_q, mut rate_from_v] = [[0.0; S]; 4];
    for (mode, row) in state.modes.iter().zip(&step.modes) {
        add::<S, A>(&mut from_q, mode.q, &row.tip_from_q);
        add::<S, A>(&mut from_v, mode.v, &row.tip_from_v);
        add::<S, A>(&mut rate_from_q, mode.q, &row.rate_from_q);
        add::<S, A>(&mut rate_from_v, mode.v, &row.rate_from_v);
    }
    subtract(&mut free, &from_q, &from_v);
    subtract(&mut free_rate, &rate_from_q, &rate_from_v);
    add_columns::<S, A>(&mut free, &step.acceleration.displacement, &accelerations);
    add_columns::<S, A>(&mut free_rate, &step.acceleration.velocity, &accelerations);
    let start_defect = driven + generated.start - dot::<S, A>(&accelerations, &collocation.at_start);
    let largest = accelerations
        .iter()
        .fold(f64::MIN_POSITIVE, |largest, a| largest.max(a.abs()));
    let quadrature = if S == SHORT { QUADRATURE_SHORT } else { QUADRATURE_LONG };
    FreeResponse {
        start_defect,
        missed_mean: quadrature * start_defect * start_defect / largest,
        error: &step.acceleration_error,
        accelerations,
        free,
        free_rate,
    }
}

/// The trial with its error estimate, from the nodal forces and the loads on the modes, where there are such; the modes at
/// its end go to `end_modes`.
#[inline(always)]
fn judged<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    drive: &Drive,
    (step, collocation): (&StepCoefficients<S>, &Collocation<S>),
    (solution, mode_loads): (&Solution<S>, &[Nodal<S>]),
    free: &FreeResponse<S>,
    end_modes: &mut ModeStates,
) -> Trial<S> {
    let (tip, tip_rate) = end_of_modes::<S, A>(
        state,
        step,
        model.modes.len(),
        #[inline(always)]
        |first, lanes| {
            loads_on_modes::<S, A>(&step.end, first, &solution.forces, &free.accelerations, lanes);
            for (i, load) in mode_loads.iter().skip(first).take(LANES).enumerate() {
                for (lanes, load) in lanes.iter_mut().zip(load) {
                    lanes.iter_mut().skip(i).take(1).for_each(|lane| *lane += load);
                }
            }
        },
        end_modes,
    );
    let Solution { forces, iterations, .. } = *solution;
    let (indentations, rates) = at_nodes::<S, A>(&step.force, &free.free, &free.free_rate, &forces);
    let support = state.support + drive.support_rate * step.length;
    let (indentation, rate) = (support - tip, drive.support_rate - tip_rate);

    let largest = forces.iter().fold(f64::MIN_POSITIVE, |largest, force| {
        largest.max((model.preload.force + force).abs())
    });
    let (start_defect, next_terms) = if state.closed {
        let start = state.force - model.preload.force;
        let defect = start - dot::<S, A>(&forces, &collocation.at_start);
        (defect, collocation.next_terms::<A>(start, &forces))
    } else {
        (0.0, 0.0)
    };
    let [error, inner_error] = errors(model, state, (step, collocation), solution, start_defect, free, largest);
    Trial {
        forces,
        indentations,
        rates,
        accelerations: free.accelerations,
        support,
        indentation,
        rate,
        force: end(&forces),
        error,
        inner_error,
        rounding: FORCE_ROUNDING * largest.max(model.preload.force),
        start_defect: start_defect.abs(),
        next_terms,
        iterations,
        tangent: solution.tangent,
    }
}

/// Loads of contact force and base acceleration on [`LANES`] modes from `first` on.
#[inline(always)]
#[expect(
    clippy::indexing_slicing,
    reason = "the room for the modes is a whole number of lanes"
)]
pub(super) fn loads_on_modes<const S: usize, A: Arithmetic>(
    rows: &EndRows<S>,
    first: usize,
    forces: &Nodal<S>,
    accelerations: &Nodal<S>,
    loads: &mut LaneLoads<S>,
) {
    let tips = &rows.tip[first..first + LANES];
    let participations = &rows.participation[first..first + LANES];
    for ((load, force), acceleration) in loads.iter_mut().zip(forces).zip(accelerations) {
        for ((load, tip), participation) in load.iter_mut().zip(tips).zip(participations) {
            *load = A::mul_add(*tip, *force, -participation * acceleration);
        }
    }
}

/// Writes the modes at the end of a step to `ends`; `loads_from` computes the loads on [`LANES`] modes from a given one
/// on. Returns displacement and velocity of the tip.
#[inline(always)]
#[expect(
    clippy::indexing_slicing,
    reason = "the room for the modes is a whole number of lanes"
)]
pub(super) fn end_of_modes<const S: usize, A: Arithmetic>(
    state: &State,
    step: &StepCoefficients<S>,
    modes: usize,
    loads_from: impl Fn(usize, &mut LaneLoads<S>),
    ends: &mut ModeStates,
) -> (f64, f64) {
    let rows = &step.end;
    let (mut tip, mut tip_rate) = ([0.0; LANES], [0.0; LANES]);
    let lanes = |values: &Modal, first: usize| -> [f64; LANES] { std::array::from_fn(|i| values[first + i]) };
    for first in (0..modes).step_by(LANES) {
        let starts = &state.modes[first..first + LANES];
        let (start_q, start_v): ([f64; LANES], [f64; LANES]) = (
            std::array::from_fn(|i| starts[i].q),
            std::array::from_fn(|i| starts[i].v),
        );
        let tips = lanes(&rows.tip, first);
        let mut loads = [[0.0; LANES]; S];
        loads_from(first, &mut loads);
        let (mut q, mut v) = ([0.0; LANES], [0.0; LANES]);
        add_products::<LANES, A>(&mut q, &lanes(&rows.q_from_q, first), &start_q);
        add_products::<LANES, A>(&mut q, &lanes(&rows.q_from_v, first), &start_v);
        add_products::<LANES, A>(&mut v, &lanes(&rows.v_from_q, first), &start_q);
        add_products::<LANES, A>(&mut v, &lanes(&rows.v_from_v, first), &start_v);
        for (node, load) in loads.iter().enumerate() {
            add_products::<LANES, A>(&mut q, &lanes(&rows.q_from_load[node], first), load);
            add_products::<LANES, A>(&mut v, &lanes(&rows.v_from_load[node], first), load);
        }
        add_products::<LANES, A>(&mut tip, &tips, &q);
        add_products::<LANES, A>(&mut tip_rate, &tips, &v);
        for (end, (q, v)) in ends[first..first + LANES].iter_mut().zip(q.iter().zip(&v)) {
            (end.q, end.v) = (*q, *v);
        }
    }
    (tip.iter().sum(), tip_rate.iter().sum())
}

/// Subtracts `a` and `b`.
#[inline(always)]
fn subtract<const S: usize>(values: &mut Nodal<S>, a: &Nodal<S>, b: &Nodal<S>) {
    for ((value, a), b) in values.iter_mut().zip(a).zip(b) {
        *value -= a + b;
    }
}
