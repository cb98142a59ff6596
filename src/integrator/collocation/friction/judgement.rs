//! The error estimate of a trial step with friction.

use crate::friction::Friction;
use crate::integrator::collocation::error::kinked;
use crate::integrator::collocation::friction::coupled::Coupled;
use crate::integrator::collocation::friction::motion::{Motion, Unforced};
use crate::integrator::collocation::newton::Tangent;
use crate::integrator::collocation::polynomial::Collocation;
use crate::math::nodal::{Nodal, dot, end, greatest};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// How good a trial is.
#[derive(Default)]
pub(super) struct Judgement {
    pub(super) error: f64,
    pub(super) inner_error: f64,
    pub(super) start_defect: f64,
    pub(super) next_terms: f64,
    pub(super) tangent: Tangent,
}

/// The error estimate of [`error`](super::error), for both forces: what the defects of both polynomials and of the base
/// acceleration at the start do to both forces.
#[inline(always)]
pub(super) fn judged<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    collocation: &Collocation<S>,
    unforced: &Unforced<S>,
    coupled: &Coupled<S>,
    largest: f64,
) -> Judgement {
    let Unforced { step, free, .. } = unforced;
    let Coupled {
        forces,
        tangential,
        laws,
        by_defect,
        ..
    } = coupled;
    let starts = [
        state.force - model.preload.force,
        state.tangential.force - friction.preload,
    ];
    let [normal, along] = [(starts[0], forces), (starts[1], tangential)]
        .map(|(start, values)| start - dot::<S, A>(values, &collocation.at_start));
    let defects = [normal, along, free.start_defect];
    // Both forces at the nodes, and what moves the tip at the end.
    let (mut wrong, mut wrong_loads) = ([0.0; S], [0.0; S]);
    for (defect, both) in defects.iter().zip(by_defect) {
        for (sum, value) in wrong.iter_mut().chain(&mut wrong_loads).zip(both) {
            *sum += defect * value;
        }
    }
    let own = unforced.by_defects();
    let direct = |of: fn(&Motion<S>) -> &Nodal<S>| -> f64 {
        defects
            .iter()
            .zip(&own)
            .map(|(defect, motion)| defect * end(of(motion)))
            .sum()
    };
    let last = |columns: &[Nodal<S>; S], loads: &Nodal<S>| {
        columns
            .iter()
            .zip(loads)
            .map(|(column, load)| end(column) * load)
            .sum::<f64>()
    };
    let (d, v) = (&step.force, unforced.tangential);
    let wrong_d =
        direct(|motion| &motion.d) - last(&d.displacement, &wrong) - last(&v.cross.displacement, &wrong_loads);
    let wrong_rate =
        direct(|motion| &motion.d_rate) - last(&d.velocity, &wrong) - last(&v.cross.velocity, &wrong_loads);
    let wrong_v =
        direct(|motion| &motion.v) + last(&v.cross.displacement, &wrong) + last(&v.own.displacement, &wrong_loads);
    let wrong_v_rate =
        direct(|motion| &motion.v_rate) + last(&v.cross.velocity, &wrong) + last(&v.own.velocity, &wrong_loads);

    let start_stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
    let beta = model.law.damping();
    let tangent = {
        let stiffness = greatest(&laws.stiffness).max(start_stiffness);
        let damping = greatest(&laws.damping).max(beta * start_stiffness);
        let steady = [1.0; S];
        let gain = stiffness * last(&d.displacement, &steady) + damping * last(&d.velocity, &steady);
        Tangent {
            stiffness,
            damping,
            gain: gain.max(0.0),
        }
    };
    // What slips has no force that answers, but when it turns depends on its motion: that counts as what bends the spring.
    let (grip, memory) = if state.tangential.phase.sign().is_none() {
        (friction.ratio * tangent.stiffness, beta)
    } else {
        (friction.stiffness, model.memory)
    };
    let fast = (tangent.stiffness * wrong_d).abs()
        + (tangent.damping * wrong_rate).abs()
        + grip * (wrong_v.abs() + memory * wrong_v_rate.abs())
        + friction.inertia * free.missed_mean;
    let both = normal.abs() + along.abs();
    let kinked = kinked::<S>(state, step.length, both);
    let reaction = tangent.gain / (1.0 + tangent.gain);
    let missed = model.inertia * free.missed_mean;
    let slow = 3.0 * (normal * normal + along * along) / largest + kinked + missed;
    let impulse = collocation.impulse * (both + model.inertia * free.start_defect.abs()) + missed;
    let terms = |start, values: &Nodal<S>| collocation.next_terms::<A>(start, values);
    Judgement {
        error: fast + slow * reaction,
        inner_error: greatest(&wrong)
            + greatest(&wrong_loads)
            + impulse * reaction
            + friction.inertia * (collocation.impulse * free.start_defect.abs() + free.missed_mean),
        start_defect: normal.abs().max(along.abs()),
        next_terms: terms(starts[0], forces).max(terms(starts[1], tangential)),
        tangent,
    }
}
