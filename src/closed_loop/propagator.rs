//! Exact motion of the oscillators of beam and linear contact over a step: the coefficients, which depend on the step
//! length only, and a cache of such.
//!
//! Step lengths are used exactly, to the last bit. Collocation steps treat lengths that differ by rounding as equal;
//! here the resulting phase error would never be corrected, and in undamped vibration it would accumulate over millions
//! of steps. Nor would it save much: an importer that computes step sizes as differences of times passes multiples of
//! the spacing of floating-point numbers there, so only two or three different ones until time doubles.

use std::f64::consts::TAU;

use bytemuck::Zeroable;
use nalgebra::Complex;

use crate::beam::mode::MAX_MODES;
use crate::closed_loop::oscillator::{Coordinates, Oscillator, set};
use crate::excitation::generator::Generator;
use crate::excitation::waveform::turned;
use crate::math::free_motion::FreeMotion;

#[derive(Clone, Debug, Zeroable)]
pub struct Propagator {
    /// Free motion of each oscillator.
    pub(crate) free: FreeMotion<[f64; MAX_MODES]>,
    /// Motion from rest under the generator with unit amplitude, per sine and per cosine of its phase at the start.
    pub(crate) from_sine: Coordinates,
    pub(crate) from_cosine: Coordinates,
}

impl Propagator {
    /// Computes the coefficients for a length (s) in place.
    pub(crate) fn fill(&mut self, length: f64, oscillators: &[Oscillator], generator: &Generator) {
        let count = oscillators.len();
        let generated = generator.frequency().map(|frequency| {
            let turn = Complex::from_polar(1.0, TAU * turned(frequency, length));
            (frequency, turn)
        });
        for (n, oscillator) in oscillators.iter().enumerate() {
            let free = FreeMotion::new(oscillator.omega_squared, oscillator.damping, length);
            self.free.set(n, &free);
            if let Some((frequency, turn)) = generated {
                let driven = oscillator.loaded(oscillator.driven_from_rest(&free, frequency, turn, length));
                set(&mut self.from_sine, n, count, driven.map(|motion| motion.re));
                set(&mut self.from_cosine, n, count, driven.map(|motion| motion.im));
            }
        }
    }
}

/// Cache of what depends on the step length only, for the last lengths. Its content never affects results, only the time
/// they take.
#[derive(Clone, Debug)]
pub struct ByLength<T> {
    /// Each with its length, s; 0: none yet.
    kept: Vec<(f64, T)>,
    /// The entry to be replaced next.
    oldest: usize,
}

impl<T> ByLength<T> {
    pub(crate) fn new(room: usize, empty: impl Fn() -> T) -> Self {
        Self { kept: (0..room).map(|_| (0.0, empty())).collect(), oldest: 0 }
    }

    /// The entry for a length (s), filled in if it is not kept; `None` without any room.
    pub(crate) fn get(&mut self, length: f64, fill: impl FnOnce(&mut T)) -> Option<&T> {
        let known = self.kept.iter().position(|(known, _)| *known == length);
        let place = known.unwrap_or(self.oldest);
        let count = self.kept.len();
        let (kept, entry) = self.kept.get_mut(place)?;
        if known.is_none() {
            fill(entry);
            *kept = length;
            self.oldest = (place + 1) % count;
        }
        Some(entry)
    }
}
