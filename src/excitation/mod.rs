//! Base acceleration generated inside the component, and [`drive`]: what comes from the inputs.

pub mod drive;

use std::f64::consts::TAU;

use crate::scene::Scene;
use crate::transient::collocation::Nodal;
use crate::variables::ExcitationKind;

/// Base accelerations over a step, m/s2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerations<const S: usize> {
    /// At the start.
    pub start: f64,
    /// At the nodes.
    pub nodes: Nodal<S>,
}

/// Sines and cosines of the angles the generator turns through from the start of a step: they depend on its length alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns<const S: usize> {
    /// To the nodes.
    sin: Nodal<S>,
    /// See [`Turns::sin`].
    cos: Nodal<S>,
}

impl<const S: usize> Turns<S> {
    /// Without a generator.
    pub fn none() -> Self {
        Self {
            sin: [0.0; S],
            cos: [0.0; S],
        }
    }
}

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

    /// Sine and cosine of the generator's phase at `time`, times its amplitude.
    pub(crate) fn phasor(&self, time: f64) -> (f64, f64) {
        match *self {
            Self::Sine {
                amplitude,
                frequency,
                phase,
                start,
            } if time >= start => {
                let (sin, cos) = (TAU * turned(frequency, time - start) + phase).sin_cos();
                (amplitude * sin, amplitude * cos)
            }
            _ => (0.0, 0.0),
        }
    }

    /// Frequency, Hz.
    pub(crate) fn frequency(&self) -> Option<f64> {
        match *self {
            Self::None => None,
            Self::Sine { frequency, .. } => Some(frequency),
        }
    }

    /// Accelerations over a step that begins at `time` (s) and has the given turns. A step that begins before the start of
    /// the generator ends there at the latest.
    #[inline(always)]
    pub fn over_step<const S: usize>(&self, time: f64, turns: &Turns<S>) -> Accelerations<S> {
        let (sin, cos) = match self {
            Self::None => {
                return Accelerations {
                    start: 0.0,
                    nodes: [0.0; S],
                };
            }
            Self::Sine { .. } => self.phasor(time),
        };
        let mut nodes = turns.cos;
        for (node, turn) in nodes.iter_mut().zip(&turns.sin) {
            *node = sin * *node + cos * turn;
        }
        Accelerations { start: sin, nodes }
    }

    /// The turns of a step of `length` seconds with these nodes.
    pub fn turns<const S: usize>(&self, length: f64, nodes: &Nodal<S>) -> Turns<S> {
        let Self::Sine { frequency, .. } = *self else {
            return Turns::none();
        };
        let angle = |x: f64| TAU * frequency * x * length;
        Turns {
            sin: nodes.map(|x| angle(x).sin()),
            cos: nodes.map(|x| angle(x).cos()),
        }
    }

    /// Whether there is an acceleration at `time` (s) or just after it.
    pub fn is_active(&self, time: f64) -> bool {
        match *self {
            Self::None => false,
            Self::Sine { start, .. } => time >= start,
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

/// Turns of a rotation at `frequency` (Hz) over a time (s) beyond whole ones. These are dropped before anything is rounded, so
/// that late instants keep their digits.
pub(crate) fn turned(frequency: f64, time: f64) -> f64 {
    let turns = frequency * time;
    turns.fract() + frequency.mul_add(time, -turns)
}
