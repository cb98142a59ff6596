//! Slip at the nodes of a step. While the contact slips, the deflection `z` of the tangential spring follows from
//! `beta_c z' + z = -T / k_t`, collocated at the same nodes. In a step that is long against `beta_c` no polynomial follows how `z` moves
//! to its course where slip has just begun: there it is the polynomial `w` through the nodes that solves this equation, and a part
//! that fades,
//!
//! ```text
//! z = w + (z_0 - w_0) exp(-t / beta_c)
//! ```

use crate::contact::friction::Friction;
use crate::integrator::collocation::coefficients::{NodalMotion, StepCoefficients};
use crate::integrator::collocation::elimination::solve;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Shapes;
use crate::integrator::collocation::trial::{SlipNodes, Trial};
use crate::link::CONTACT;
use crate::math::nodal::{Nodal, add, add_columns, dot, scaled, unit};
use crate::math::simd::{Arithmetic, Separate};
use crate::model::Model;
use crate::state::State;

/// See [`StepCoefficients::following`]; `damping`: the damping time, s.
#[inline(always)]
pub(super) fn following<const S: usize, A: Arithmetic>(damping: f64, h: f64, shapes: &Shapes<S>) -> [Nodal<S>; S] {
    let long = is_long::<S>(h, damping);
    // The velocity is the derivative of the polynomial through the nodal deflections, or that of which the deflection is the integral.
    let scale = 1.0 / (damping + h);
    let (table, factor, own) = if long {
        (shapes.derivatives.get(1), damping / h, 1.0)
    } else {
        (shapes.integrals.first(), h * scale, damping * scale)
    };
    let table = table.map_or([[0.0; S]; S], |table| table.nodal);
    let (mut matrix, mut right) = (table, table);
    for (j, (column, right)) in matrix.iter_mut().zip(&mut right).enumerate() {
        *column = scaled(column, factor);
        add::<S, A>(column, own, unit(j));
        *right = if long { scaled(right, 1.0 / h) } else { scaled(unit(j), scale) };
    }
    solve::<S, S, A>(matrix, right).unwrap_or([[0.0; S]; S])
}

/// Whether a step of `length` seconds with `S` nodes is long against the damping time (s) of a contact.
pub(crate) fn is_long<const S: usize>(length: f64, damping: f64) -> bool {
    S as f64 * damping < length
}

impl<const S: usize> SlipNodes<S> {
    /// Of a contact that is open.
    pub(super) const ZERO: Self = Self { deflections: [0.0; S], rates: [0.0; S], fading: 0.0 };

    /// What is left of the fading part `at` seconds after the start, m, at the damping time of the contact, s.
    pub(crate) fn left(&self, at: f64, damping: f64) -> f64 {
        // There is none in most steps.
        if self.fading == 0.0 { 0.0 } else { self.fading * (-at / damping.max(f64::MIN_POSITIVE)).exp() }
    }

    /// Slip velocity of that, m/s; without a damper it is over at once.
    pub(crate) fn fading_rate(&self, at: f64, damping: f64) -> f64 {
        if damping > 0.0 { self.left(at, damping) / damping } else { 0.0 }
    }

    /// Energy dissipated since the start of a step of this length (s), J, by a friction force (N, at its start and nodes); with what is
    /// `left` of the fading part, which is over before the force changes.
    pub(crate) fn dissipated(
        &self,
        collocation: &Collocation<S>,
        (start, forces): (f64, Nodal<S>),
        left: &Nodal<S>,
        length: f64,
    ) -> Nodal<S> {
        let mut powers = self.rates;
        for (power, force) in powers.iter_mut().zip(&forces) {
            *power *= -length * force;
        }
        let mut dissipated = left.map(|left| -start * (self.fading - left));
        if let Some(integrals) = collocation.shapes.integrals.first() {
            add_columns::<S, Separate>(&mut dissipated, &integrals.nodal, &powers);
        }
        dissipated
    }
}

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
    *slip = SlipNodes::ZERO;
    let start = -state.links[rubbing].approach - state.slip.way;
    if !state.links[CONTACT].closed {
        return;
    }
    let law = &model.law;
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
    let Some(following) = step.following.first_chunk::<S>() else { return };
    *slip = tends::<S, A>(collocation, following, (start, &ahead), (step.length, law.damping));
    for (slip, (along, across)) in slip.rates.iter_mut().zip(along.rates.iter().zip(&contact.rates)) {
        // Without a damper the spring moves as the contact does: over a short step rounding of the motion would be a velocity.
        let spring = if law.damping > 0.0 { *slip } else { friction.limit_deflection(law, sign, *across, 0.0) };
        *slip = -along - spring;
    }
}

/// Sets what the deviation adds to the slip, by what it adds to the motion of the contact.
#[inline(always)]
pub(super) fn follow_deviation<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    (step, collocation): (StepCoefficients<'_, S>, &Collocation<S>),
    contact: &NodalMotion<S>,
    trial: &mut Trial<S>,
) {
    let Some((sign, (rubbing, friction))) = state.slip.phase.sign().zip(model.friction()) else { return };
    let Some(following) = step.following.first_chunk::<S>() else { return };
    let start = state.force_error.tangential(model.port_of(rubbing));
    let mut ahead = [0.0; S];
    for (ahead, (d, rate)) in ahead.iter_mut().zip(contact.d.iter().zip(&contact.rate)) {
        *ahead = friction.limit_deflection(&model.law, sign, *d, *rate) - start;
    }
    trial.slip_deviation = tends::<S, A>(collocation, following, (start, &ahead), (step.length, model.law.damping));
}

/// Deflection `z` from a `start` (m), and in place of the slip its velocity, as it follows one that is `ahead` of the start (m) by so
/// much at the nodes of a step of this length (s), at the damping time (s).
#[inline(always)]
fn tends<const S: usize, A: Arithmetic>(
    collocation: &Collocation<S>,
    following: &[Nodal<S>; S],
    (start, ahead): (f64, &Nodal<S>),
    (length, damping): (f64, f64),
) -> SlipNodes<S> {
    let mut rates = [0.0; S];
    add_columns::<S, A>(&mut rates, following, ahead);
    let fading = if is_long::<S>(length, damping) {
        let [tends, goes] = [ahead, &rates].map(|values| dot::<S, A>(values, &collocation.at_start));
        damping * goes - tends
    } else {
        0.0
    };
    let mut deflections = [start - fading; S];
    if let Some(integrals) = collocation.shapes.integrals.first() {
        add_columns::<S, A>(&mut deflections, &integrals.nodal, &scaled(&rates, length));
    }
    SlipNodes { deflections, rates, fading }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::polynomial::{LONG_BY_TIME, SHORT_BY_TIME};

    /// Beside the exact solution, from a start that is not on the course.
    fn follows<const S: usize>(collocation: &Collocation<S>, length: f64, allowed: impl Fn(f64) -> f64) {
        let damping = 1e-6;
        // Ahead of a start at 2: 1 + x + x^2, and the polynomial that solves the equation.
        let lag = damping / length;
        let course = |x: f64| 3.0 + x + x * x - lag * (1.0 + 2.0 * x) + 2.0 * lag * lag;
        let exact = |x: f64| course(x) + (2.0 - course(0.0)) * (-x / lag).exp();
        let following = following::<S, Separate>(damping, length, &collocation.shapes);
        let ahead = collocation.nodes.map(|x| 1.0 + x + x * x);
        let found = tends::<S, Separate>(collocation, &following, (2.0, &ahead), (length, damping));
        for (x, deflection) in collocation.nodes.iter().zip(&found.deflections) {
            let wrong = deflection + found.left(x * length, damping) - exact(*x);
            assert!(wrong.abs() <= allowed(lag), "{length} s, at {x}: {wrong:e}");
        }
    }

    /// Of the slip of a contact that moves at a velocity, as its spring relaxes from a start that is not on the course.
    #[test]
    fn a_constant_friction_force_dissipates_itself_times_the_slip() {
        let (force, velocity, damping, collocation) = (-0.3, 5e3, 1e-6, &LONG_BY_TIME);
        for length in [1e-4, 1e-6] {
            let following = following::<8, Separate>(damping, length, &collocation.shapes);
            let mut slip = tends::<8, Separate>(collocation, &following, (2.0, &[-1.5; 8]), (length, damping));
            slip.rates = slip.rates.map(|rate| velocity - rate);
            let left = collocation.nodes.map(|x| slip.left(x * length, damping));
            let dissipated = slip.dissipated(collocation, (force, [force; 8]), &left, length);
            let nodes = collocation.nodes.iter().zip(&left);
            for (energy, ((x, left), deflection)) in dissipated.iter().zip(nodes.zip(&slip.deflections)) {
                let way = velocity * x * length - (deflection + left - 2.0);
                assert!((energy + force * way).abs() < 1e-12, "{length} s: {dissipated:?}");
            }
        }
    }

    #[test]
    fn a_tangential_spring_follows_its_limit_in_steps_of_any_length() {
        // Long steps: rounding, multiplied as eight times the lag is subtracted from one. Others: what a polynomial misses of what fades,
        // most where the step is nearly long, and what rounding leaves of the exact solution, the difference of squares of the lag.
        for length in [1e-3, 1e-4, 1e-5, 8.1e-6] {
            follows(&LONG_BY_TIME, length, |_| 1e-9);
            follows(&SHORT_BY_TIME, length, |_| 1e-9);
        }
        for length in [7.9e-6, 3.9e-6, 1e-6, 1e-7, 1e-9] {
            follows(&LONG_BY_TIME, length, |lag| 1e-2 * (0.125 / lag).powi(8) + 1e-15 * (1.0 + lag * lag));
        }
        for length in [3.9e-6, 1e-6, 1e-7, 1e-9] {
            follows(&SHORT_BY_TIME, length, |lag| (0.25 / lag).powi(4) + 1e-15 * (1.0 + lag * lag));
        }
    }
}
