//! A trial step with friction: contact force and friction force at the nodes, found together.
//!
//! The friction force `T` is a second load on the modes, a polynomial through the nodes as the contact force `F` is, and it
//! moves the contact point along the spring by `v`:
//!
//! ```text
//! d_k = d_k(free) - sum_j (D_kj F_j + X_kj T_j)      X = sum_i T_i (h T_i') (response of mode i at x_k to l_j)
//! v_k = v_k(free) + sum_j (X_kj F_j + Y_kj T_j)      Y = sum_i (h T_i')^2 (the same)
//! stick:  T_k = -k_t(d_k) (v_k - s + beta_c v'_k), s the slip so far;  slip:  T_k = -+ mu F_k
//! ```
//!
//! with Newton's method for all nodal values while the contact sticks ([`mod@sticking`]), for the contact forces while it slips
//! ([`mod@slipping`]; [`crate::friction`]: the law). While the contact slips the deflection `z` of
//! the tangential spring follows from `beta_c z' + z = -T / k_t`, collocated at the same nodes.

mod judgement;
mod motion;
mod slipping;
mod sticking;

use crate::excitation::drive::Drive;
use crate::friction::Friction;
use crate::integrator::collocation::coefficients::{Prepared, StepCoefficients, TangentialCoefficients};
use crate::integrator::collocation::end::End;
use crate::integrator::collocation::error::errors;
use crate::integrator::collocation::friction::judgement::{Judgement, judged};
use crate::integrator::collocation::friction::motion::{Motion, Unforced, along};
use crate::integrator::collocation::friction::slipping::slipping;
use crate::integrator::collocation::friction::sticking::sticking;
use crate::integrator::collocation::newton::{Solution, Source, first_forces};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::{Trial, end_of_modes, free_response, loads_on_modes};
use crate::integrator::collocation::tangential::TangentialNodes;
use crate::integrator::constants::FORCE_ROUNDING;
use crate::math::nodal::{Nodal, add, add_columns, end, scaled};
use crate::math::simd::{Arithmetic, LANES};
use crate::model::Model;
use crate::state::State;

/// [`trial`](super::trial::trial) with friction. Where the contact forces are given, so are the friction forces: those left in
/// `end`.
#[inline(always)]
pub(super) fn compute<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source<S>,
    ends: &mut End<S>,
) -> Option<Trial<S>> {
    let Prepared { step, collocation, .. } = prepared;
    let tangential = step.tangential.as_deref()?;
    let free = free_response::<S, A>(state, drive, &prepared);
    let motion = along::<S, A>(state, tangential, &free);
    let unforced = Unforced {
        step,
        tangential,
        free,
        motion,
    };
    let guess = first_forces::<S, A>(model, state, step, collocation, source);
    let solved = match source {
        Source::Law(newton) if state.closed => {
            let unforced = (&unforced, collocation);
            Some(match state.tangential.phase.sign() {
                Some(sign) => {
                    let share = sign * friction.coefficient;
                    slipping::<S, A>(model, friction, state, unforced, share, guess, newton)?
                }
                None => sticking::<S, A>(model, friction, state, unforced, guess, newton)?,
            })
        }
        _ => None,
    };
    let (forces, loads, motion) = if let Some(solved) = &solved {
        (solved.forces, solved.loads, solved.motion)
    } else {
        let loads = match source {
            Source::Law(_) => [-friction.preload; S],
            Source::Given(_) => ends.tangential.forces,
        };
        (guess, loads, unforced.under::<A>(&guess, &loads))
    };
    ends.tangential = nodes::<S, A>(model, friction, state, (step, tangential, collocation), &motion, loads);

    let accelerations = unforced.free.accelerations;
    let (tip, tip_rate) = end_of_modes::<S, A>(
        state,
        step,
        model.modes.len(),
        #[inline(always)]
        |first, lanes| {
            loads_on_modes::<S, A>(&step.end, first, &forces, &accelerations, lanes);
            let (levers, _) = friction.levers.as_chunks::<LANES>();
            for levers in levers.iter().skip(first / LANES).take(1) {
                for (lanes, load) in lanes.iter_mut().zip(&loads) {
                    add::<LANES, A>(lanes, *load, levers);
                }
            }
        },
        &mut ends.modes,
    );
    let support = state.support + drive.support_rate * step.length;
    let largest = forces.iter().fold(f64::MIN_POSITIVE, |largest, force| {
        largest.max((model.preload.force + force).abs())
    });
    let judgement = if let Some(solved) = &solved {
        judged::<S, A>(model, friction, state, collocation, &unforced, solved, largest)
    } else {
        let solution = Solution::given(forces);
        let coefficients = (step, collocation);
        let [error, inner_error] = errors(model, state, coefficients, &solution, 0.0, &unforced.free, largest);
        Judgement {
            error,
            inner_error,
            ..Judgement::default()
        }
    };
    Some(Trial {
        forces,
        indentations: motion.d,
        rates: motion.d_rate,
        accelerations,
        support,
        indentation: support - tip,
        rate: drive.support_rate - tip_rate,
        force: end(&forces),
        error: judgement.error,
        inner_error: judgement.inner_error,
        rounding: FORCE_ROUNDING * largest.max(model.preload.force),
        start_defect: judgement.start_defect,
        next_terms: judgement.next_terms,
        iterations: solved.as_ref().map_or(0, |solved| solved.iterations),
        tangent: judgement.tangent,
    })
}

/// Friction at the nodes under these forces.
#[inline(always)]
fn nodes<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    (step, tangential, collocation): (&StepCoefficients<S>, &TangentialCoefficients<S>, &Collocation<S>),
    motion: &Motion<S>,
    loads: Nodal<S>,
) -> TangentialNodes<S> {
    let start = &state.tangential;
    let mut nodes = TangentialNodes {
        forces: loads,
        displacements: motion.v,
        rates: motion.v_rate,
        ..TangentialNodes::ZERO
    };
    let (Some(law), true) = (model.law.power(), state.closed) else {
        return nodes;
    };
    let Some(sign) = start.phase.sign() else {
        let slip = start.slip;
        nodes.deflections = motion.v.map(|v| v - slip);
        return nodes;
    };
    // z = z_0 + integral of z', beta_c z' + z = -T / k_t at the nodes.
    let mut ahead = [0.0; S];
    for (ahead, (d, rate)) in ahead.iter_mut().zip(motion.d.iter().zip(&motion.d_rate)) {
        let d = model.preload.indentation + d;
        *ahead = friction.limit_deflection(law, sign, d, *rate) - start.deflection();
    }
    let mut rates = [0.0; S];
    add_columns::<S, A>(&mut rates, &tangential.following, &ahead);
    let Some(integrals) = collocation.shapes.integrals.first() else {
        return nodes;
    };
    nodes.deflections = [start.deflection(); S];
    add_columns::<S, A>(&mut nodes.deflections, &integrals.nodal, &scaled(&rates, step.length));
    for ((slip, rate), lagging) in nodes.slip_rates.iter_mut().zip(&motion.v_rate).zip(&rates) {
        *slip = rate - lagging;
    }
    nodes
}
