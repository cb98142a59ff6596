//! A sine, and the half-sine shock pulse.

use std::f64::consts::{PI, TAU};

use crate::excitation::waveform::{Window, displacement_limit, limited, turned};
use crate::scene::Excitation;

/// `A r sin(2 pi f tau + phase)`, `tau = t - t0`, within its window; `r = (1 - cos(pi tau / T)) / 2` while it rises, then 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// A, m/s2; of either sign, as for every waveform.
    pub amplitude: f64,
    /// f, Hz.
    pub frequency: f64,
    /// Phase at the start, rad.
    pub phase: f64,
    pub window: Window,
    /// T, s; 0: it begins at once.
    pub rise_time: f64,
}

impl Sine {
    /// From the start time on: Machines 2025, 13(1), 52, eqs. (26), (27), with the amplitude within the displacement
    /// limit.
    pub fn new(excitation: &Excitation) -> Self {
        let limit = displacement_limit(excitation);
        Self {
            amplitude: limited(excitation.amplitude, limit, excitation.frequency),
            frequency: excitation.frequency,
            phase: excitation.phase,
            window: Window::from(excitation.start_time),
            rise_time: excitation.rise_time,
        }
    }

    /// `A sin(pi tau / D)` for the duration D, in which the velocity changes by `2 A D / pi`: a shock as in MIL-STD-202
    /// method 213. Neither phase, displacement limit nor rise apply.
    pub fn half(excitation: &Excitation) -> Self {
        Self {
            amplitude: excitation.amplitude,
            frequency: 0.5 / excitation.duration,
            phase: 0.0,
            window: Window { start: excitation.start_time, end: excitation.start_time + excitation.duration },
            rise_time: 0.0,
        }
    }

    /// The instant at which it has risen, s.
    fn risen(&self) -> f64 {
        self.window.start + self.rise_time
    }

    /// Whether it rises at `time` (s) or just after it.
    pub fn rises(&self, time: f64) -> bool {
        self.window.start <= time && time < self.risen()
    }

    /// The share of its amplitude at `time` (s) that it has reached, 1.
    pub fn reached(&self, time: f64) -> f64 {
        if self.rises(time) {
            let half = 0.5 * PI * (time - self.window.start) / self.rise_time;
            half.sin().powi(2)
        } else {
            1.0
        }
    }

    /// The next instant after `time` (s) at which it begins, has risen or ends.
    pub fn next_break(&self, time: f64) -> Option<f64> {
        let risen = self.rises(time).then(|| self.risen());
        risen.or_else(|| self.window.next_end(time))
    }

    /// Sine and cosine of the phase at `time` (s), times the amplitude once it has risen.
    pub fn phasor(&self, time: f64) -> (f64, f64) {
        let angle = TAU * turned(self.frequency, time - self.window.start) + self.phase;
        let (sin, cos) = angle.sin_cos();
        (self.amplitude * sin, self.amplitude * cos)
    }
}
