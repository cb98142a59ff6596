//! A sine, and the half-sine shock pulse.

use std::f64::consts::TAU;

use crate::excitation::waveform::{Window, displacement_limit, limited, turned};
use crate::scene::Excitation;

/// `A sin(2 pi f tau + phase)`, `tau = t - t0`, within its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// A, m/s2; of either sign, as for every waveform.
    pub amplitude: f64,
    /// f, Hz.
    pub frequency: f64,
    /// Phase at the start, rad.
    pub phase: f64,
    /// Interval of time in which it acts.
    pub window: Window,
}

impl Sine {
    /// From the start time on: Machines 2025, 13(1), 52, eqs. (26), (27), with the amplitude within the displacement
    /// limit.
    pub fn new(excitation: &Excitation) -> Self {
        Self {
            amplitude: limited(
                excitation.amplitude,
                displacement_limit(excitation),
                excitation.frequency,
            ),
            frequency: excitation.frequency,
            phase: excitation.phase,
            window: Window::from(excitation.start_time),
        }
    }

    /// `A sin(pi tau / D)` for the duration D, in which the velocity changes by `2 A D / pi`: a shock as in MIL-STD-202
    /// method 213. Neither phase nor displacement limit apply.
    pub fn half(excitation: &Excitation) -> Self {
        Self {
            amplitude: excitation.amplitude,
            frequency: 0.5 / excitation.duration,
            phase: 0.0,
            window: Window {
                start: excitation.start_time,
                end: excitation.start_time + excitation.duration,
            },
        }
    }

    /// Sine and cosine of the phase at `time` (s), times the amplitude.
    pub fn phasor(&self, time: f64) -> (f64, f64) {
        let angle = TAU * turned(self.frequency, time - self.window.start) + self.phase;
        let (sin, cos) = angle.sin_cos();
        (self.amplitude * sin, self.amplitude * cos)
    }
}
