//! A small deviation of the motion, which shows how errors grow.
//!
//! In a closed contact errors die out with the vibrations. In one that opens, each closing turns an error of the motion
//! into another blow, and errors may grow from one to the next. So the lowest modes of a deviation are carried along, with
//! the contact linearised about the motion and its force linear in time over each step (trapezoidal rule). Only the
//! growth of its size is used, the root of its energy.

use crate::beam::mode::{Modal, Mode, ModeState};
use crate::force_error::{ForceError, MODES};
use crate::integrator::collocation::newton::Tangent;
use crate::math::free_motion::FreeMotion;

impl ForceError {
    /// Begins with a blow on the tip, unless there is a deviation already.
    pub(crate) fn begin(&mut self, modes: &[Mode]) {
        if !self.deviates() {
            for (at, mode) in self.deviation.iter_mut().zip(modes) {
                at.v = mode.tip;
            }
            self.normalise(modes);
        }
    }

    /// Over a step with the given free motion of the modes, and of a closed contact the displacement per mode and the tangent.
    pub(crate) fn advance(
        &mut self,
        modes: &[Mode],
        free: impl Iterator<Item = FreeMotion>,
        closed: Option<(&Modal, Tangent)>,
    ) {
        let shape = |i: usize| closed.and_then(|(shape, _)| shape.get(i)).copied().unwrap_or_default();
        let (mut tip, mut tip_rate) = (0.0, 0.0);
        let mut by_force = [ModeState::default(); MODES];
        let all = self.deviation.iter_mut().zip(free).zip(modes).zip(&mut by_force);
        for (i, (((at, free), mode), by_force)) in all.enumerate() {
            let ModeState { q, v } = *at;
            let b = shape(i);
            at.q = free.q_from_q * q + free.q_from_v * v;
            at.v = free.v_from_q * q + free.v_from_v * v;
            // Of a constant force.
            by_force.q = if mode.omega_squared > 0.0 {
                b * (1.0 - free.q_from_q) / mode.omega_squared
            } else {
                b * 0.5 * free.q_from_v * free.q_from_v
            };
            by_force.v = b * free.q_from_v;
            tip += b * at.q;
            tip_rate += b * at.v;
        }
        let before = self.force;
        self.force = 0.0;
        if let Some((_, tangent)) = closed {
            // The force at the end is that of the law at the motion that the mean force causes.
            let Tangent {
                stiffness,
                damping,
                gain,
            } = tangent;
            self.force = -(stiffness * tip + damping * tip_rate + 0.5 * gain * before) / (1.0 + 0.5 * gain);
            let mean = 0.5 * (before + self.force);
            for (at, by_force) in self.deviation.iter_mut().zip(&by_force) {
                at.q += by_force.q * mean;
                at.v += by_force.v * mean;
            }
        }
        let size = self.normalise(modes);
        self.growth += size.ln();
        if closed.is_none() {
            self.largest_growth = self.largest_growth.max(self.growth);
        }
    }

    /// The root of the energy.
    fn size(&self, modes: &[Mode]) -> f64 {
        let pairs = modes.iter().zip(&self.deviation);
        pairs
            .map(|(mode, at)| mode.omega_squared * at.q * at.q + at.v * at.v)
            .sum::<f64>()
            .sqrt()
    }

    /// Brings it back to size 1; returns what it was.
    fn normalise(&mut self, modes: &[Mode]) -> f64 {
        let size = self.size(modes).max(f64::MIN_POSITIVE);
        for at in &mut self.deviation {
            at.q /= size;
            at.v /= size;
        }
        self.force /= size;
        size
    }
}
