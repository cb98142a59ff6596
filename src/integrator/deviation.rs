//! A deviation of the motion, which shows what errors grow to.
//!
//! In a closed contact errors die out with the vibrations. In one that opens, each closing turns an error of the motion
//! into another blow, and errors may grow from one to the next. So the lowest modes of a deviation are carried along, with
//! each law at work linearised about the motion and its force linear in time over each step (trapezoidal rule, nearer to the force at
//! the end the more a damper takes back within the step: else that would ring on in long steps). Its direction
//! soon is that which grows most. Its size is that of the errors: each step adds what slow modes feel of its own, each opening and
//! closing what a wrong force or a wrong instant leaves in the motion, which would die out in a contact that stayed closed.

use std::f64::consts::SQRT_2;
use std::mem;

use crate::force_error::{Deviation, ForceError, Lanes, MODES, Slowest};
use crate::integrator::collocation::newton::Tangent;
use crate::link::{CONTACT, Link, MAX_LINKS};
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{add_products, dot, scaled};
use crate::math::simd::Arithmetic;

/// Part of the energy of a deviation below which it does not show what happens there, 1. Chosen: one in ten of the amplitude.
const HIDDEN: f64 = 1e-2;

impl Deviation {
    /// Twice the energy of each mode, J.
    #[inline(always)]
    fn energies(&self, slowest: &Slowest) -> impl Iterator<Item = f64> {
        let modes = self.q.iter().zip(&self.v).zip(&slowest.omega_squared);
        modes.map(|((q, v), omega_squared)| omega_squared * q * q + v * v)
    }
}

impl ForceError {
    /// A contact at this port opens or closes, which begins the deviation with a blow, or adds one where its modes have hardly any
    /// part in it: the other bodies' would hide how errors grow there.
    pub(crate) fn begin(&mut self, slowest: &Slowest, port: usize) {
        let (Some(shape), Some(by_impulse)) = (slowest.shapes.get(port), slowest.by_impulse.get(port)) else { return };
        let energies = self.deviation.energies(slowest).zip(shape);
        let energy: f64 = energies.filter(|(_, shape)| **shape != 0.0).map(|(energy, _)| energy).sum();
        if *by_impulse == 0.0 || energy > HIDDEN {
            return;
        }
        for (v, shape) in self.deviation.v.iter_mut().zip(shape) {
            *v += shape / by_impulse;
        }
        self.size *= self.normalise(slowest);
    }

    /// A contact of this stiffness (N/m) opens or closes: the motion keeps the energy of the largest error of its force, and as much
    /// in the velocity.
    pub(crate) fn keep(&mut self, stiffness: f64, force_scale: f64) {
        let error = self.largest * force_scale.max(self.greatest);
        self.size = (self.size + SQRT_2 * error / stiffness.sqrt()).min(f64::MAX);
    }

    /// A step was wrong by an impulse (N s) on a contact at this port; none is known where it is not a number, as in a step with
    /// constant forces after a collocation that has failed.
    pub(crate) fn disturb(&mut self, slowest: &Slowest, port: usize, impulse: f64) {
        self.size += slowest.by_impulse.get(port).copied().unwrap_or_default() * impulse.max(0.0);
    }

    /// The force that the deviation makes in the contacts that conduct is part of the estimate.
    pub(crate) fn note_deviation(&mut self, links: &[Link], force_scale: f64) {
        let conducting = links.iter().zip(&self.forces).filter(|(link, _)| link.circuit.is_some());
        let most = conducting.fold(0.0_f64, |most, (_, force)| most.max(force.abs()));
        let error = self.size * most / force_scale.max(self.greatest);
        self.by_deviation = self.by_deviation.max(error.min(f64::MAX));
    }

    /// Over a step with the given free motion; of each law at work its index among the links, its port and the tangent.
    #[inline(always)]
    pub(crate) fn advance<A: Arithmetic>(
        &mut self,
        slowest: &Slowest,
        free: &FreeMotion<Lanes>,
        at_work: impl Iterator<Item = (usize, usize, Tangent)>,
    ) {
        let (mut next_q, mut next_v) = free.moved::<A>(&self.deviation.q, &self.deviation.v);
        // What a constant force does to a mode in which it has part 1.
        let lanes = free.q_from_q.iter().zip(&free.q_from_v).zip(&slowest.omega_squared);
        let mut by_force = [0.0; MODES];
        for (by_force, ((q_from_q, q_from_v), omega_squared)) in by_force.iter_mut().zip(lanes) {
            *by_force = if *omega_squared > 0.0 { (1.0 - q_from_q) / omega_squared } else { 0.5 * q_from_v * q_from_v };
        }
        let before = mem::replace(&mut self.forces, [0.0; MAX_LINKS]);
        let (mut closed, mut drawn) = (false, false);
        // One after the other: each at the motion that those before it have left.
        for (index, port, tangent) in at_work {
            closed |= index == CONTACT;
            drawn |= tangent.stiffness < 0.0;
            let links = self.forces.get_mut(index).zip(before.get(index));
            let places = slowest.shapes.get(port).zip(slowest.compliance.get(port));
            let Some(((force, before), (shape, compliance))) = links.zip(places) else { continue };
            let (y, rate) = (dot::<MODES, A>(shape, &next_q), dot::<MODES, A>(shape, &next_v));
            // Faster modes yield at once, in series with the law.
            let yielding = 1.0 + tangent.stiffness.max(0.0) * compliance;
            let (stiffness, damping) = (tangent.stiffness / yielding, tangent.damping / yielding);
            // The force at the end is that of the law at the motion that the mean force causes.
            let (mut of_q, mut of_v) = ([0.0; MODES], [0.0; MODES]);
            add_products::<MODES, A>(&mut of_q, shape, &by_force);
            add_products::<MODES, A>(&mut of_v, shape, &free.q_from_v);
            // A magnet draws more the further it has moved; bounded, as the rule fails at -2.
            let damped = damping * dot::<MODES, A>(shape, &of_v);
            let gain = (stiffness * dot::<MODES, A>(shape, &of_q) + damped).max(-1.0);
            // Of the force at the end in the mean: 1 / (1 - exp(-x)) - 1 / x within 2 %.
            let weight = (6.0 + damped * (3.0 + damped)) / (12.0 + damped * (4.0 + damped));
            let first = (1.0 - weight) * before;
            *force = -(stiffness * y + damping * rate + gain * first) / (1.0 + weight * gain);
            let mean = [first + weight * *force; MODES];
            add_products::<MODES, A>(&mut next_q, &mean, &of_q);
            add_products::<MODES, A>(&mut next_v, &mean, &of_v);
        }
        self.deviation = Deviation { q: next_q, v: next_v };
        let size = self.normalise(slowest);
        self.size = (self.size * size).min(f64::MAX);
        self.growth += size.ln();
        // Else part of its energy is in the contact.
        if !closed || drawn {
            self.largest_growth = self.largest_growth.max(self.growth);
        }
    }

    /// Brings it back to size 1, the root of its energy; returns what it was.
    #[inline(always)]
    fn normalise(&mut self, slowest: &Slowest) -> f64 {
        let size = self.deviation.energies(slowest).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        let inverse = 1.0 / size;
        let Deviation { q, v } = &mut self.deviation;
        (*q, *v) = (scaled(q, inverse), scaled(v, inverse));
        self.forces = scaled(&self.forces, inverse);
        size
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::mode::Mode;
    use crate::link::Port;
    use crate::math::simd::Separate;

    /// Once it were not a number, every relay would be announced from then on, and its saved state refused.
    #[test]
    fn a_step_of_unknown_error_leaves_the_estimate_sound() {
        let modes = [Mode { omega_squared: 1.0, tip: 1.0, ..Mode::default() }];
        let slowest = Slowest::of(&modes, &[Port::new(&modes, |mode| mode.tip)]);
        let free = slowest.free(0.1);
        let mut of_steps = ForceError::default();
        of_steps.begin(&slowest, 0);
        for impulse in [f64::NAN, f64::INFINITY] {
            of_steps.disturb(&slowest, 0, impulse);
            of_steps.advance::<Separate>(&slowest, &free, [].into_iter());
            of_steps.note_deviation(&[], 1.0);
            assert!(of_steps.is_sound(), "{impulse}: {of_steps:?}");
            // Nothing is known of the first, all is lost with the second.
            assert_eq!(of_steps.size > 0.0, impulse.is_infinite());
        }
    }

    /// A mode that lasts, of another body, would hide what grows at a contact once its own have faded.
    #[test]
    fn a_deviation_that_has_faded_at_a_contact_begins_there_anew() {
        let of = |damping, tip, armature| Mode { omega_squared: 1.0, damping, tip, armature, ..Mode::default() };
        let modes = [of(1.0, 1.0, 0.0), of(0.0, 0.0, 1.0)];
        let ports = [|mode: &Mode| mode.tip, |mode: &Mode| mode.armature].map(|place| Port::new(&modes, place));
        let slowest = Slowest::of(&modes, &ports);
        let free = slowest.free(0.1);
        let mut error = ForceError { size: 1.0, ..ForceError::default() };
        let part = |error: &ForceError| error.deviation.energies(&slowest).next().unwrap();
        error.begin(&slowest, 0);
        error.begin(&slowest, 1);
        // Each as large as the other, and as all errors together were.
        assert!((part(&error) - 0.5).abs() < 1e-12 && (error.size - 2.0_f64.sqrt()).abs() < 1e-12);
        error.begin(&slowest, 0);
        assert!((part(&error) - 0.5).abs() < 1e-12);
        for _ in 0..200 {
            error.advance::<Separate>(&slowest, &free, [].into_iter());
        }
        assert!((1e-12..1e-6).contains(&part(&error)), "{}", part(&error));
        error.begin(&slowest, 0);
        assert!((part(&error) - 0.5).abs() < 1e-3, "{}", part(&error));
    }
}
