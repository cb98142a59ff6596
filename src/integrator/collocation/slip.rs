//! Slip at the nodes of a step. While the contact slips, the deflection `z` of the tangential spring follows from
//! `beta_c z' + z = -T / k_t`, collocated at the same nodes.

use crate::contact::friction::Friction;
use crate::integrator::collocation::coefficients::StepCoefficients;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::trial::{SlipNodes, Trial};
use crate::link::CONTACT;
use crate::math::nodal::{add_columns, scaled};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// Sets the slip of a trial whose forces and motion are set.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "links of the model")]
pub(super) fn follow<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    (step, collocation): (StepCoefficients<'_, S>, &Collocation<S>),
    (rubbing, friction): (usize, &Friction),
    trial: &mut Trial<S>,
) {
    let Trial { links, slip, .. } = trial;
    let (contact, along) = (&links[CONTACT], &links[rubbing]);
    *slip = SlipNodes {
        deflections: [0.0; S],
        rates: [0.0; S],
    };
    let start = -state.links[rubbing].approach - state.slip.way;
    let (true, Some(law)) = (state.links[CONTACT].closed, model.law.power()) else {
        return;
    };
    let Some(sign) = state.slip.phase.sign() else {
        slip.deflections = along.approaches.map(|approach| -approach - state.slip.way);
        return;
    };
    // z = z_0 + integral of z', beta_c z' + z = -T / k_t at the nodes.
    let mut ahead = [0.0; S];
    for (ahead, (d, rate)) in ahead.iter_mut().zip(contact.approaches.iter().zip(&contact.rates)) {
        let d = model.links[CONTACT].approach + d;
        *ahead = friction.limit_deflection(law, sign, d, *rate) - start;
    }
    let (Some(following), Some(integrals)) = (step.following.first_chunk::<S>(), collocation.shapes.integrals.first())
    else {
        return;
    };
    let mut rates = [0.0; S];
    add_columns::<S, A>(&mut rates, following, &ahead);
    slip.deflections = [start; S];
    add_columns::<S, A>(&mut slip.deflections, &integrals.nodal, &scaled(&rates, step.length));
    for ((slip, rate), lagging) in slip.rates.iter_mut().zip(&along.rates).zip(&rates) {
        *slip = -rate - lagging;
    }
}
