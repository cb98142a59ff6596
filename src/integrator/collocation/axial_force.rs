//! A step with an axial force that follows the deflection ([`Feedback`]): loads that couple all modes.
//!
//! The loads are collocation polynomials like the contact force, and weak compared with the modal stiffness. They are
//! found by fixed-point iteration: motion under the current forces, loads of that motion, contact forces under those
//! loads. The defect of the load polynomials at the start of the step enters the error estimate in the same way as that
//! of the base acceleration. If the iteration does not converge, the step is too long.
//!
//! In violent motion the axial force may temporarily exceed the buckling load: the beam then moves away from its
//! position until the sine in the law of the axial force turns to tension. Such motion is integrated like any other, in
//! shorter steps.

use crate::beam::axial::Feedback;
use crate::beam::mode::Modal;
use crate::integrator::collocation::coefficients::{ErrorColumn, ModeColumns, StepCoefficients};
use crate::integrator::collocation::end::{End, NodalModes};
use crate::integrator::collocation::newton::{FreeResponse, Solution, Source, closed_forces, first_forces};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{FORCE_ROUNDING, ROUNDS};
use crate::math::nodal::{Nodal, add, add_columns, dot};
use crate::math::simd::{Arithmetic, LANES};
use crate::model::Model;
use crate::state::State;

/// Iterates contact forces and the loads of `end`: returns the former, and the effect on the indentation of the defects of base
/// acceleration and loads at the start; `None` if they do not converge.
#[inline(always)]
pub(crate) fn settle<const S: usize, A: Arithmetic>(
    model: &Model,
    axial: &Feedback,
    state: &State,
    (step, collocation): (&StepCoefficients<S>, &Collocation<S>),
    source: Source<S>,
    free: &FreeResponse<S>,
    end: &mut End<S>,
) -> Option<(Solution<S>, ErrorColumn<S>)> {
    let End {
        loads, motion, next, ..
    } = end;
    let start = axial.loads(&model.modes, &state.modes);
    let tolerance = match source {
        Source::Law(newton) => newton,
        Source::Given(_) => 0.0,
    };
    let mut forces = first_forces::<S, A>(model, state, step, collocation, source);
    for (loads, start) in loads.iter_mut().zip(&start) {
        *loads = [*start; S];
    }
    let stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
    let mut iterations = 0;
    let mut solved: Option<Solution<S>> = None;
    for _ in 0..ROUNDS {
        let acting = (&forces, &free.accelerations, &*loads);
        set_motion::<S, A>(model, state, step, acting, motion);
        set_loads::<S, A>(model, axial, motion, next);
        let (change, size) = force_of_change(model, loads, next);
        let settled = change <= tolerance + FORCE_ROUNDING * size;
        if let Some(mut solution) = solved.take_if(|_| settled) {
            solution.iterations = iterations;
            let error = load_error::<S, A>(model, free, &start, loads, (step, collocation));
            return Some((solution, error));
        }
        *loads = *next;
        let solution = match source {
            Source::Law(newton) if state.closed => {
                let error = load_error::<S, A>(model, free, &start, loads, (step, collocation));
                let free = FreeResponse {
                    error: &error,
                    start_defect: 1.0,
                    ..with_loads::<S, A>(model, free, step, loads)
                };
                closed_forces::<S, A>(
                    model,
                    (&step.force, &step.force_error),
                    &free,
                    forces,
                    (newton, stiffness),
                )?
            }
            _ => Solution::given(forces),
        };
        iterations += solution.iterations;
        forces = solution.forces;
        solved = Some(solution);
    }
    None
}

/// Computes the modal displacements at the nodes under contact forces, base acceleration and loads.
#[inline(always)]
fn set_motion<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    step: &StepCoefficients<S>,
    (forces, accelerations, loads): (&Nodal<S>, &Nodal<S>, &NodalModes<S>),
    motion: &mut NodalModes<S>,
) {
    let modes = model.modes.iter().zip(&state.modes).zip(&step.columns).zip(loads);
    for (moved, (((mode, at), columns), load)) in motion.iter_mut().zip(modes) {
        let mut load = *load;
        let mut q = [0.0; S];
        add::<S, A>(&mut load, mode.tip, forces);
        add::<S, A>(&mut load, -mode.participation, accelerations);
        add::<S, A>(&mut q, at.q, &columns.q_from_q);
        add::<S, A>(&mut q, at.v, &columns.q_from_v);
        add_columns::<S, A>(&mut q, &columns.load.displacement, &load);
        *moved = q;
    }
}

/// Computes the modal loads of a motion at the nodes.
#[inline(always)]
fn set_loads<const S: usize, A: Arithmetic>(
    model: &Model,
    axial: &Feedback,
    motion: &NodalModes<S>,
    loads: &mut NodalModes<S>,
) {
    let count = model.modes.len();
    let mut tip = [0.0; S];
    for (mode, q) in model.modes.iter().zip(motion) {
        add::<S, A>(&mut tip, mode.tip, q);
    }
    let change = tip.map(|y| axial.change(y));
    // Several independent rows at once.
    let blocks = loads.chunks_exact_mut(LANES).zip(axial.slopes.chunks_exact(LANES));
    for (block, (loads, slopes)) in blocks.enumerate().take(count.div_ceil(LANES)) {
        let mut sums = [[0.0; S]; LANES];
        for (row, q) in axial.geometric.iter().zip(motion) {
            for (sum, entry) in sums
                .iter_mut()
                .zip(row.chunks_exact(LANES).nth(block).unwrap_or_default())
            {
                add::<S, A>(sum, *entry, q);
            }
        }
        for ((load, sum), slope) in loads.iter_mut().zip(&sums).zip(slopes) {
            let (mut values, slope) = (change, *slope);
            for (value, sum) in values.iter_mut().zip(sum) {
                *value *= slope + sum;
            }
            *load = values;
        }
    }
}

/// Static tip force of the same strain energy as the change of the loads, and as the loads, N: the largest over the
/// nodes.
#[inline(always)]
fn force_of_change<const S: usize>(model: &Model, loads: &NodalModes<S>, next: &NodalModes<S>) -> (f64, f64) {
    let (mut change, mut size, mut unit) = ([0.0; S], [0.0; S], f64::MIN_POSITIVE);
    for ((mode, load), next) in model.modes.iter().zip(loads).zip(next) {
        let compliance = 1.0 / mode.omega_squared;
        unit += mode.tip * mode.tip * compliance;
        for (((change, size), load), next) in change.iter_mut().zip(&mut size).zip(load).zip(next) {
            *change += (next - load) * (next - load) * compliance;
            *size += next * next * compliance;
        }
    }
    // Not `max`, which would hide NaN.
    let root = |values: Nodal<S>| {
        values
            .iter()
            .fold(0.0, |most, value| if most >= *value { most } else { *value })
    };
    ((root(change) / unit).sqrt(), (root(size) / unit).sqrt())
}

/// Adds the effect of the loads to the free response.
#[inline(always)]
pub(crate) fn with_loads<'a, const S: usize, A: Arithmetic>(
    model: &Model,
    free: &FreeResponse<'a, S>,
    step: &StepCoefficients<S>,
    loads: &NodalModes<S>,
) -> FreeResponse<'a, S> {
    let mut with = free.clone();
    for ((mode, columns), load) in model.modes.iter().zip(&step.columns).zip(loads) {
        let ModeColumns { load: columns, .. } = columns;
        let load = load.map(|load| -mode.tip * load);
        add_columns::<S, A>(&mut with.free, &columns.displacement, &load);
        add_columns::<S, A>(&mut with.free_rate, &columns.velocity, &load);
    }
    with
}

/// Effect on the indentation of the defects of base acceleration and loads at the start.
#[inline(always)]
fn load_error<const S: usize, A: Arithmetic>(
    model: &Model,
    free: &FreeResponse<S>,
    start: &Modal,
    loads: &NodalModes<S>,
    (step, collocation): (&StepCoefficients<S>, &Collocation<S>),
) -> ErrorColumn<S> {
    let mut error = ErrorColumn {
        displacement: free.error.displacement.map(|d| free.start_defect * d),
        velocity: free.error.velocity.map(|r| free.start_defect * r),
    };
    let modes = model.modes.iter().zip(&step.columns).zip(start).zip(loads);
    for (((mode, columns), start), load) in modes {
        let start_defect = -mode.tip * (start - dot::<S, A>(load, &collocation.at_start));
        add::<S, A>(&mut error.displacement, start_defect, &columns.error.displacement);
        add::<S, A>(&mut error.velocity, start_defect, &columns.error.velocity);
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excitation::drive::Drive;
    use crate::integrator::collocation::coefficients::Cache;
    use crate::integrator::collocation::polynomial::OF_LONG;
    use crate::math::nodal::LONG;
    use crate::scene::Scene;
    use crate::variables::AxialForceKind;

    /// A spring bent by half its length against a soft contact, without damping, pushed at the tip.
    fn pushed() -> (Model, State) {
        let mut scene = Scene::default();
        scene.effects.axial_force = AxialForceKind::FromDeflection;
        scene.contact.overtravel = 8e-3;
        scene.contact.curvature_radius = 1e-4;
        scene.contact.moving.youngs_modulus = 1e8;
        scene.contact.fixed.youngs_modulus = 1e8;
        scene.contact.damping = 0.0;
        scene.beam.stiffness_damping = 0.0;
        scene.solver.modes = 4;
        let model = Model::new(&scene, 0.0).unwrap();
        let mut state = model.initial_state(0.0);
        for (at, mode) in state.modes.iter_mut().zip(&model.modes) {
            at.v = 0.5 * mode.participation;
            state.indentation_rate -= mode.tip * at.v;
        }
        (model, state)
    }

    #[test]
    fn energy_changes_by_the_work_of_the_axial_force() {
        for source in [Source::Law(1e-12), Source::Given([0.3; LONG])] {
            let (model, mut state) = pushed();
            let mut cache = Cache::new(&model, &OF_LONG);
            let (mut most, mut wrong) = (0.0_f64, 0.0_f64);
            let start = model.energy(&state.modes, 0.0);
            let length = 1e-5;
            let collocation = Collocation::<LONG>::new();
            let axial = model.axial.as_ref().unwrap();
            for _ in 0..100 {
                let mut end: Box<End<LONG>> = bytemuck::zeroed_box();
                let mut moved = |length| {
                    let prepared = cache.prepare(state.time, length, true, &model);
                    let drive = Drive::default();
                    let trial = crate::integrator::collocation::trial::trial(
                        &model, &state, &drive, prepared, source, &mut end,
                    );
                    (trial.unwrap(), end.modes)
                };
                // Radau quadrature of the power, from steps to the nodes.
                let powers = collocation.nodes.map(|node| {
                    let (_, modes) = moved(node * length);
                    let loads = axial.loads(&model.modes, &modes);
                    loads.iter().zip(&modes).map(|(load, at)| load * at.v).sum()
                });
                let work = length * collocation.mean(&powers);
                let (trial, end) = moved(length);
                let (mut before, after) = (
                    model.energy(&state.modes, state.indentation),
                    model.energy(&end, trial.indentation),
                );
                if let Source::Given([force, ..]) = source {
                    // The given force does the work on the tip in place of the contact.
                    let contact = |d| model.law.energy_above_tangent(model.preload.indentation, d);
                    before += contact(trial.indentation) - contact(state.indentation);
                    before -= force * (trial.indentation - state.indentation);
                }
                wrong = wrong.max((after - before - work).abs());
                most = most.max(work.abs());
                state.modes = end;
                state.indentation = trial.indentation;
                state.indentation_rate = trial.rate;
                if let Source::Law(_) = source {
                    state.force = model
                        .law
                        .force(model.preload.indentation + trial.indentation, trial.rate);
                }
            }
            assert!(most > 1e-3 * start, "{most:e} of {start:e} J");
            // The phase of the fastest mode advances by x = 1.3 rad per step: polynomials of degree 8 have an error of
            // at most x^9 / 9!, some 1e-5, of its motion, and of the order of the square of that in the mean of its
            // work.
            assert!(wrong < 1e-8 * most, "{wrong:e} of {most:e} J");
        }
    }
}
