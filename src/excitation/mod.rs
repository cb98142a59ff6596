//! Base acceleration generated inside the component.

use std::f64::consts::TAU;

use crate::scene::Scene;
use crate::variables::ExcitationKind;

/// The generator a scene asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Generator {
    /// No acceleration.
    None,
    /// `A sin(2 pi f tau + phase)` for `tau = t - t0 >= 0`: Machines 2025, 13(1), 52, eqs. (26), (27).
    Sine {
        /// A, m/s2.
        amplitude: f64,
        /// f, Hz.
        frequency: f64,
        /// Phase, rad.
        phase: f64,
        /// t0, s.
        start: f64,
    },
}

impl Generator {
    /// The generator of the scene.
    pub fn new(scene: &Scene) -> Self {
        let excitation = &scene.excitation;
        match scene.effects.excitation {
            ExcitationKind::Sine if excitation.amplitude > 0.0 => Self::Sine {
                amplitude: excitation.amplitude,
                frequency: excitation.frequency,
                phase: excitation.phase,
                start: excitation.start_time,
            },
            _ => Self::None,
        }
    }

    /// Acceleration `offset` seconds after `time`, m/s2. A step that begins before the start ends at it at the latest.
    pub fn acceleration(&self, time: f64, offset: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Sine { start, .. } if time < start => 0.0,
            Self::Sine {
                amplitude,
                frequency,
                phase,
                start,
            } => {
                // Whole turns are dropped before the phase is formed, so that late instants keep their digits.
                let turns = (frequency * (time - start)).fract() + frequency * offset;
                amplitude * TAU.mul_add(turns, phase).sin()
            }
        }
    }

    /// The next instant after `time` at which the acceleration is not smooth, s.
    pub fn next_break(&self, time: f64) -> Option<f64> {
        match *self {
            Self::Sine { start, .. } if start > time => Some(start),
            _ => None,
        }
    }

    /// Longest step within which the acceleration cannot turn unseen, s.
    pub fn longest_step(&self) -> f64 {
        match *self {
            Self::None => f64::INFINITY,
            Self::Sine { frequency, .. } => 0.25 / frequency,
        }
    }
}
