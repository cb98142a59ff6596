//! Newton's method for the nodal forces on the closed branch: each is that of the law at the motion that they cause.

use crate::integrator::collocation::coefficients::{ErrorColumn, StepCoefficients, TipColumns};
use crate::integrator::collocation::elimination::solve;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{ITERATIONS, MOTION_ROUNDING};
use crate::math::nodal::{Nodal, add_columns, end, greatest, scaled};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// Where the contact force of a step comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source<const S: usize> {
    /// The contact law at the nodes, with this Newton tolerance, N; no force while the contact is open.
    Law(f64),
    /// Given nodal forces, as deviation from the preload force, N.
    Given(Nodal<S>),
}

/// Response to everything but the contact force.
#[derive(Clone)]
pub(crate) struct FreeResponse<'a, const S: usize> {
    /// Base acceleration at the nodes, m/s2.
    pub(crate) accelerations: Nodal<S>,
    /// Indentation at the nodes without contact force, as deviation from the preload, m.
    pub(crate) free: Nodal<S>,
    /// Its velocity, m/s.
    pub(crate) free_rate: Nodal<S>,
    /// Defect of the load polynomial at the start, m/s2 for the base acceleration.
    pub(crate) start_defect: f64,
    /// Mean over the step of what the polynomial misses of the base acceleration, m/s2.
    pub(crate) missed_mean: f64,
    /// Indentation and its velocity at the nodes per unit of that defect.
    pub(crate) error: &'a ErrorColumn<S>,
}

/// Tangent of the contact law within a step; zero if the force does not depend on the motion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tangent {
    /// Greatest stiffness at the nodes, N/m.
    pub stiffness: f64,
    /// Greatest damping at the nodes, N s/m.
    pub damping: f64,
    /// Loop gain: change of the law's force at the end, at this tangent, per constant tip force over the step.
    pub gain: f64,
}

/// The nodal forces of a step.
pub(crate) struct Solution<const S: usize> {
    /// Deviation from the preload force, N.
    pub(crate) forces: Nodal<S>,
    /// Newton iterations.
    pub(crate) iterations: u64,
    /// Displacement and velocity of the tip at the end per defect of the contact force at the start.
    pub(crate) by_force: (f64, f64),
    /// The same per defect of the other loads.
    pub(crate) by_load: (f64, f64),
    /// Nodal forces per defect of the contact force at the start.
    pub(crate) nodal_by_force: Nodal<S>,
    /// The same per defect of the other loads.
    pub(crate) nodal_by_load: Nodal<S>,
    /// Tangent of the contact law.
    pub(crate) tangent: Tangent,
}

impl<const S: usize> Solution<S> {
    /// Forces that do not depend on the motion.
    pub(crate) fn given(forces: Nodal<S>) -> Self {
        Self {
            forces,
            iterations: 0,
            by_force: (0.0, 0.0),
            by_load: (0.0, 0.0),
            nodal_by_force: [0.0; S],
            nodal_by_load: [0.0; S],
            tangent: Tangent::default(),
        }
    }

    /// Of the last iterate, with the greatest stiffness and damping at its start and nodes. `force_error`: nodal forces per
    /// defect of the contact force; `load_error`: free response per defect of the other loads, and the nodal forces it
    /// causes. From these the effects at the end are formed.
    #[inline(always)]
    fn new(
        (columns, defect): (&TipColumns<S>, &ErrorColumn<S>),
        forces: Nodal<S>,
        iterations: u64,
        (stiffness, damping): (f64, f64),
        force_error: &Nodal<S>,
        load_error: (&ErrorColumn<S>, &Nodal<S>),
    ) -> Self {
        let last = |columns: &[Nodal<S>; S], loads: &Nodal<S>| {
            let entries = columns.iter().filter_map(|column| column.last());
            entries.zip(loads).map(|(entry, load)| entry * load).sum::<f64>()
        };
        let tip = |error: &ErrorColumn<S>, loads: &Nodal<S>| {
            (
                end(&error.displacement) - last(&columns.displacement, loads),
                end(&error.velocity) - last(&columns.velocity, loads),
            )
        };
        let steady = [1.0; S];
        let gain = stiffness * last(&columns.displacement, &steady) + damping * last(&columns.velocity, &steady);
        Self {
            forces,
            iterations,
            by_force: tip(defect, force_error),
            by_load: tip(load_error.0, load_error.1),
            nodal_by_force: *force_error,
            nodal_by_load: *load_error.1,
            tangent: Tangent {
                stiffness,
                damping,
                gain: gain.max(0.0),
            },
        }
    }
}

/// Nodal forces extrapolated from the last step.
#[inline(always)]
fn predicted_forces<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    step: &StepCoefficients<S>,
    collocation: &Collocation<S>,
) -> Nodal<S> {
    if state.last_step > 0.0 {
        collocation.guess::<A>(&state.course, step.length / state.last_step)
    } else {
        [state.force - model.preload.force; S]
    }
}

/// Initial guess of the nodal forces: given by the source, or extrapolated from the last step.
#[inline(always)]
pub(crate) fn first_forces<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    step: &StepCoefficients<S>,
    collocation: &Collocation<S>,
    source: Source<S>,
) -> Nodal<S> {
    match source {
        Source::Law(_) if state.closed => predicted_forces::<S, A>(model, state, step, collocation),
        Source::Law(_) => [-model.preload.force; S],
        Source::Given(forces) => forces,
    }
}

/// Solves for the nodal forces from an initial guess, to residuals of at most `newton` (N) or rounding; `None` if the
/// iteration does not converge. `tip`: its motion per nodal force and per defect of the force at the start; `start`: the
/// stiffness at the start, N/m. Velocities are computed only for a contact with damping.
#[inline(always)]
pub(crate) fn closed_forces<const S: usize, A: Arithmetic>(
    model: &Model,
    tip: (&TipColumns<S>, &ErrorColumn<S>),
    free: &FreeResponse<S>,
    guess: Nodal<S>,
    (newton, start): (f64, f64),
) -> Option<Solution<S>> {
    if model.law.damping() > 0.0 {
        iterated::<S, A, true>(model, tip, free, guess, (newton, start))
    } else {
        iterated::<S, A, false>(model, tip, free, guess, (newton, start))
    }
}

/// [`closed_forces`], compiled with and without contact damping.
#[inline(always)]
fn iterated<const S: usize, A: Arithmetic, const DAMPED: bool>(
    model: &Model,
    (columns, defect): (&TipColumns<S>, &ErrorColumn<S>),
    free: &FreeResponse<S>,
    guess: Nodal<S>,
    (newton, start): (f64, f64),
) -> Option<Solution<S>> {
    let FreeResponse {
        free, free_rate, error, ..
    } = free;
    let mut forces = guess;
    let d0 = model.preload.indentation;
    let (farthest, fastest) = (greatest(free), greatest(free_rate));
    let mut by_errors = None;
    for iterations in 0..=ITERATIONS {
        let (indentations, rates) = if DAMPED {
            at_nodes::<S, A>(columns, free, free_rate, &forces)
        } else {
            (displaced::<S, A>(free, &columns.displacement, &forces), [0.0; S])
        };
        let mut residual = forces;
        let (mut stiffness, mut damping) = ([0.0; S], [0.0; S]);
        for ((((residual, stiffness), damping), d), rate) in residual
            .iter_mut()
            .zip(&mut stiffness)
            .zip(&mut damping)
            .zip(&indentations)
            .zip(&rates)
        {
            let law = model.law.closed_branch(d0 + d, *rate);
            *residual -= law.force - model.preload.force;
            (*stiffness, *damping) = (law.stiffness, law.damping);
        }
        // Convergence is judged by the residual of the law, not by the change of the nodal forces, which on a stiff
        // contact hardly depend on the law. Rounding of the motion limits the residual.
        let rounding = MOTION_ROUNDING * (greatest(&stiffness) * farthest + greatest(&damping) * fastest);
        if let Some((by_force, by_load)) = by_errors.filter(|_| greatest(&residual) <= newton.max(rounding)) {
            return Some(Solution::new(
                (columns, defect),
                forces,
                iterations,
                (
                    greatest(&stiffness).max(start),
                    greatest(&damping).max(model.law.damping() * start),
                ),
                &by_force,
                (error, &by_load),
            ));
        }
        // Derivatives of the residuals with respect to each nodal force.
        let mut jacobian = columns.displacement;
        for (k, (column, velocity)) in jacobian.iter_mut().zip(&columns.velocity).enumerate() {
            *column = react::<S, A, DAMPED>(column, velocity, &stiffness, &damping);
            if let Some(entry) = column.get_mut(k) {
                *entry += 1.0;
            }
        }
        let answer =
            |error: &ErrorColumn<S>| react::<S, A, DAMPED>(&error.displacement, &error.velocity, &stiffness, &damping);
        let by_force = answer(defect);
        let by_load = answer(error);
        let [correction, by_force, by_load] = solve::<S, 3, A>(jacobian, [residual, by_force, by_load])?;
        for (force, correction) in forces.iter_mut().zip(&correction) {
            *force -= correction;
        }
        by_errors = Some((by_force, by_load));
    }
    None
}

/// Linearised law: nodal forces for displacements and velocities of the tip.
#[inline(always)]
fn react<const S: usize, A: Arithmetic, const DAMPED: bool>(
    displacement: &Nodal<S>,
    velocity: &Nodal<S>,
    stiffness: &Nodal<S>,
    damping: &Nodal<S>,
) -> Nodal<S> {
    let mut forces = *displacement;
    for (((force, velocity), stiffness), damping) in forces.iter_mut().zip(velocity).zip(stiffness).zip(damping) {
        *force = if DAMPED {
            A::mul_add(*stiffness, *force, damping * velocity)
        } else {
            stiffness * *force
        };
    }
    forces
}

/// Indentation and its velocity at the nodes under the nodal forces.
#[inline(always)]
pub(crate) fn at_nodes<const S: usize, A: Arithmetic>(
    columns: &TipColumns<S>,
    free: &Nodal<S>,
    free_rate: &Nodal<S>,
    forces: &Nodal<S>,
) -> (Nodal<S>, Nodal<S>) {
    (
        displaced::<S, A>(free, &columns.displacement, forces),
        displaced::<S, A>(free_rate, &columns.velocity, forces),
    )
}

/// The free response less the response to the nodal forces.
#[inline(always)]
fn displaced<const S: usize, A: Arithmetic>(free: &Nodal<S>, columns: &[Nodal<S>; S], forces: &Nodal<S>) -> Nodal<S> {
    let mut left = *free;
    add_columns::<S, A>(&mut left, columns, &scaled(forces, -1.0));
    left
}
