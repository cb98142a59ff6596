//! Common to the waveforms: values over a step, the interval in which they act, accurate phases, and the displacement limit.

use std::f64::consts::TAU;

use crate::math::nodal::Nodal;
use crate::scene::Excitation;

/// Base accelerations over a step, m/s2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerations<const S: usize> {
    pub start: f64,
    pub nodes: Nodal<S>,
}

/// The interval of time in which a generator acts, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// t0.
    pub start: f64,
    /// Infinite if there is no end.
    pub end: f64,
}

impl From<f64> for Window {
    /// From the instant (s) on, without an end.
    fn from(start: f64) -> Self {
        Self { start, end: f64::INFINITY }
    }
}

impl Window {
    /// Whether it is open at `time` (s) and just after it.
    pub fn is_open_after(&self, time: f64) -> bool {
        self.start <= time && time < self.end
    }

    /// Whether it is open at `time` (s) and just before it.
    pub fn is_open_before(&self, time: f64) -> bool {
        self.start < time && time <= self.end
    }

    /// The next instant after `time` (s) at which it opens or closes.
    pub fn next_end(&self, time: f64) -> Option<f64> {
        let next = if self.start > time { self.start } else { self.end };
        (next > time && next < f64::INFINITY).then_some(next)
    }
}

/// Phase advance at `frequency` (Hz) over a time (s) in turns, without whole ones, which are removed before rounding:
/// accurate also for long times.
pub(crate) fn turned(frequency: f64, time: f64) -> f64 {
    let turns = frequency * time;
    turns.fract() + frequency.mul_add(time, -turns)
}

/// The largest displacement amplitude of a scene, m; infinite without a limit.
pub(crate) fn displacement_limit(excitation: &Excitation) -> f64 {
    let limit = excitation.displacement_limit;
    if limit > 0.0 { limit } else { f64::INFINITY }
}

/// An amplitude (m/s2) of either sign within a displacement limit (m) at a frequency (Hz): the crossover of vibration
/// standards.
pub(crate) fn limited(amplitude: f64, limit: f64, frequency: f64) -> f64 {
    let largest = (TAU * frequency).powi(2) * limit;
    amplitude.abs().min(largest).copysign(amplitude)
}
