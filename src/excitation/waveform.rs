//! What the waveforms share: their values over a step, phases without loss of digits, and the displacement limit.

use std::f64::consts::TAU;

use crate::math::nodal::Nodal;
use crate::scene::Excitation;

/// Base accelerations over a step, m/s2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerations<const S: usize> {
    /// At the start.
    pub start: f64,
    /// At the nodes.
    pub nodes: Nodal<S>,
}

/// Sines and cosines of the angles that a phase turns through from the start of a step to its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation<const S: usize> {
    /// Sines.
    pub(crate) sin: Nodal<S>,
    /// Cosines.
    pub(crate) cos: Nodal<S>,
}

impl<const S: usize> Rotation<S> {
    /// By nothing yet.
    pub(crate) const ZERO: Self = Self {
        sin: [0.0; S],
        cos: [0.0; S],
    };
}

/// Turns of a rotation at `frequency` (Hz) over a time (s) beyond whole ones. These are dropped before anything is rounded, so
/// that late instants keep their digits.
pub(crate) fn turned(frequency: f64, time: f64) -> f64 {
    let turns = frequency * time;
    turns.fract() + frequency.mul_add(time, -turns)
}

/// Amplitude at a frequency (Hz), m/s2: that of the displacement limit where this is lower, as in the crossover of vibration
/// standards.
pub(crate) fn limited_amplitude(excitation: &Excitation, frequency: f64) -> f64 {
    if excitation.displacement_limit > 0.0 {
        excitation
            .amplitude
            .min((TAU * frequency).powi(2) * excitation.displacement_limit)
    } else {
        excitation.amplitude
    }
}
