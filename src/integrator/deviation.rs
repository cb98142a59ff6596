//! A small deviation of the motion, which shows how errors grow.
//!
//! In a closed contact errors die out with the vibrations. In one that opens, each closing turns an error of the motion
//! into another blow, and errors may grow from one to the next. So the lowest modes of a deviation are carried along, with
//! each law at work linearised about the motion and its force linear in time over each step (trapezoidal rule). Only the
//! growth of its size is used, the root of its energy.

use std::mem;

use crate::beam::mode::{Modal, Mode, ModeState};
use crate::force_error::{ForceError, MODES};
use crate::integrator::collocation::newton::Tangent;
use crate::link::{CONTACT, MAX_LINKS};
use crate::math::free_motion::FreeMotion;
use crate::model::Model;

impl ForceError {
    /// Begins with a blow where a contact with this displacement per mode opens or closes, unless there is a deviation already.
    pub(crate) fn begin(&mut self, model: &Model, shape: &Modal) {
        if !self.deviates() {
            for (at, (i, _)) in self.deviation.iter_mut().zip(model.slowest()) {
                at.v = shape.get(i).copied().unwrap_or_default();
            }
            self.normalise(model);
        }
    }

    /// Over a step with the given free motion of each mode; of each law at work its index among the links, the displacement
    /// per mode and the tangent.
    pub(crate) fn advance<'a>(
        &mut self,
        model: &Model,
        free: impl Fn(usize, &Mode) -> FreeMotion,
        at_work: impl Iterator<Item = (usize, &'a Modal, Tangent)>,
    ) {
        // What a constant force does to a mode in which it has part 1.
        let mut by_force = [ModeState::default(); MODES];
        for ((at, by_force), (i, mode)) in self.deviation.iter_mut().zip(&mut by_force).zip(model.slowest()) {
            let ModeState { q, v } = *at;
            let free = free(i, mode);
            at.q = free.q_from_q * q + free.q_from_v * v;
            at.v = free.v_from_q * q + free.v_from_v * v;
            by_force.q = if mode.omega_squared > 0.0 {
                (1.0 - free.q_from_q) / mode.omega_squared
            } else {
                0.5 * free.q_from_v * free.q_from_v
            };
            by_force.v = free.q_from_v;
        }
        let before = mem::replace(&mut self.forces, [0.0; MAX_LINKS]);
        let (mut closed, mut drawn) = (false, false);
        // One after the other: each at the motion that those before it have left.
        for (index, shape, tangent) in at_work {
            closed |= index == CONTACT;
            drawn |= tangent.stiffness < 0.0;
            let Some((force, before)) = self.forces.get_mut(index).zip(before.get(index)) else {
                continue;
            };
            let (mut y, mut rate) = (0.0, 0.0);
            let part = |i: usize| shape.get(i).copied().unwrap_or_default();
            for ((i, _), at) in model.slowest().zip(&self.deviation) {
                y += part(i) * at.q;
                rate += part(i) * at.v;
            }
            // The force at the end is that of the law at the motion that the mean force causes.
            let Tangent {
                stiffness,
                damping,
                gain,
            } = tangent;
            // A magnet draws more the further it has moved; bounded, as the rule fails at -2.
            let gain = if stiffness < 0.0 { -gain.min(1.0) } else { gain };
            *force = -(stiffness * y + damping * rate + 0.5 * gain * before) / (1.0 + 0.5 * gain);
            let mean = 0.5 * (before + *force);
            for (((i, _), at), by_force) in model.slowest().zip(&mut self.deviation).zip(&by_force) {
                at.q += part(i) * by_force.q * mean;
                at.v += part(i) * by_force.v * mean;
            }
        }
        let size = self.normalise(model);
        self.growth += size.ln();
        // Else part of its energy is in the contact.
        if !closed || drawn {
            self.largest_growth = self.largest_growth.max(self.growth);
        }
    }

    /// The root of the energy.
    fn size(&self, model: &Model) -> f64 {
        let pairs = model.slowest().zip(&self.deviation);
        pairs
            .map(|((_, mode), at)| mode.omega_squared * at.q * at.q + at.v * at.v)
            .sum::<f64>()
            .sqrt()
    }

    /// Brings it back to size 1; returns what it was.
    fn normalise(&mut self, model: &Model) -> f64 {
        let size = self.size(model).max(f64::MIN_POSITIVE);
        for at in &mut self.deviation {
            at.q /= size;
            at.v /= size;
        }
        for force in &mut self.forces {
            *force /= size;
        }
        size
    }
}
