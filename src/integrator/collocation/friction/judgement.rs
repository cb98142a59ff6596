//! The error estimate of a trial step with friction.

use crate::friction::{Friction, Phase};
use crate::integrator::collocation::error::{Estimate, kinked};
use crate::integrator::collocation::friction::motion::{Solved, Unforced};
use crate::integrator::collocation::newton::Tangent;
use crate::integrator::collocation::polynomial::Collocation;
use crate::math::nodal::{Nodal, end, greatest};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// How good a trial is.
#[derive(Default)]
pub(super) struct Judgement {
    pub(super) error: Estimate,
    pub(super) inner_error: Estimate,
    pub(super) start_defect: f64,
    pub(super) next_terms: f64,
    pub(super) tangent: Tangent,
}

/// The error estimate of [`error`](crate::integrator::collocation::error), for both forces: what the defects of both
/// polynomials and of the base acceleration at the start do to both forces.
#[inline(always)]
pub(super) fn judged<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    collocation: &Collocation<S>,
    unforced: &Unforced<S>,
    solved: &Solved<S>,
    largest: f64,
) -> Judgement {
    let Unforced { step, free, .. } = unforced;
    let Solved {
        forces,
        loads,
        wrong,
        wrong_loads,
        ..
    } = solved;
    let [normal, along, _] = solved.defects;
    // What moves the tip at the end.
    let own = unforced.under_defects::<A>(&solved.defects);
    let last = |columns: &[Nodal<S>; S], loads: &Nodal<S>| {
        let entries = columns.iter().zip(loads);
        entries.map(|(column, load)| end(column) * load).sum::<f64>()
    };
    let (d, v) = (&step.force, unforced.tangential);
    let wrong_d = end(&own.d) - last(&d.displacement, wrong) - last(&v.cross.displacement, wrong_loads);
    let wrong_rate = end(&own.d_rate) - last(&d.velocity, wrong) - last(&v.cross.velocity, wrong_loads);
    let wrong_v = end(&own.v) + last(&v.cross.displacement, wrong) + last(&v.own.displacement, wrong_loads);
    let wrong_v_rate = end(&own.v_rate) + last(&v.cross.velocity, wrong) + last(&v.own.velocity, wrong_loads);

    let start_stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
    let beta = model.law.damping();
    let tangent = {
        let stiffness = solved.hardest.0.max(start_stiffness);
        let damping = solved.hardest.1.max(beta * start_stiffness);
        let steady = [1.0; S];
        let gain = stiffness * last(&d.displacement, &steady) + damping * last(&d.velocity, &steady);
        Tangent {
            stiffness,
            damping,
            gain: gain.max(0.0),
        }
    };
    // What slips has no force that answers, but when it turns depends on its motion: that counts as what bends the spring.
    let sticks = state.tangential.phase == Phase::Stick;
    let (grip, memory) = if sticks {
        (friction.ratio * tangent.stiffness, beta)
    } else {
        (friction.stiffness, model.memory)
    };
    let of_way = (tangent.stiffness * wrong_d).abs() + grip * wrong_v.abs() + friction.inertia * free.missed_mean;
    let (across, lag) = ((tangent.damping * wrong_rate).abs(), grip * memory * wrong_v_rate.abs());
    // A contact that slips has no damper along the spring.
    let (passing, kept) = if sticks { (across + lag, 0.0) } else { (across, lag) };
    let both = normal.abs() + along.abs();
    let kinked = kinked::<S>(state, step.length, both);
    let reaction = tangent.gain / (1.0 + tangent.gain);
    let missed = model.inertia * free.missed_mean;
    let slow = 3.0 * (normal * normal + along * along) / largest + kinked + missed;
    let lasting = of_way + kept + slow * reaction;
    let impulse = collocation.impulse * (both + model.inertia * free.start_defect.abs()) + missed;
    let terms = |start, values: &Nodal<S>| collocation.next_terms::<A>(start, values);
    Judgement {
        error: Estimate {
            total: passing + lasting,
            lasting,
        },
        inner_error: Estimate::lasting(
            greatest(wrong)
                + greatest(wrong_loads)
                + impulse * reaction
                + friction.inertia * (collocation.impulse * free.start_defect.abs() + free.missed_mean),
        ),
        start_defect: normal.abs().max(along.abs()),
        next_terms: terms(state.force - model.preload.force, forces)
            .max(terms(state.tangential.force - friction.preload, loads)),
        tangent,
    }
}
