//! The base acceleration generator of a scene, of any waveform.

use std::f64::consts::TAU;

use crate::excitation::random::{Piece, Random};
use crate::excitation::sine::Sine;
use crate::excitation::sweep::LogSweep;
use crate::excitation::waveform::{Accelerations, Window};
use crate::math::nodal::{Nodal, scaled};
use crate::math::simd::Simd;
use crate::scene::Scene;
use crate::variables::ExcitationKind;

/// Coefficients of a generator over a step, which depend on the step length only.
#[derive(Clone, Debug)]
pub struct Turns<const S: usize> {
    /// Of a sine: sines and cosines of the phase advance from the start of the step to its nodes.
    rotation: [Nodal<S>; 2],
    /// Of another waveform, or while it rises: nodes, s from the start of the step.
    times: Nodal<S>,
}

impl<const S: usize> Turns<S> {
    pub const NONE: Self = Self { rotation: [[0.0; S]; 2], times: [0.0; S] };

    /// Computes the coefficients for a step of `length` seconds with these nodes in place.
    pub fn fill(&mut self, generator: &Generator, length: f64, nodes: &Nodal<S>) {
        match generator {
            Generator::Sine(sine) => {
                let angles = scaled(nodes, TAU * sine.frequency * length);
                self.rotation = [angles.map(f64::sin), angles.map(f64::cos)];
                self.times = scaled(nodes, length);
            }
            Generator::LogSweep(_) | Generator::Random(_) => self.times = scaled(nodes, length),
            Generator::None => {}
        }
    }
}

/// The generator of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Generator {
    /// No acceleration.
    None,
    /// A sine, or a half-sine pulse.
    Sine(Sine),
    /// A sine whose frequency grows or falls exponentially.
    LogSweep(LogSweep),
    /// A sum of sines of equal power.
    Random(Box<Random>),
}

impl Generator {
    /// The generator of the scene.
    pub fn new(scene: &Scene) -> Self {
        let excitation = &scene.excitation;
        match scene.effects.excitation {
            ExcitationKind::Random if excitation.spectral_density > 0.0 => {
                Self::Random(Box::new(Random::new(excitation)))
            }
            ExcitationKind::Random | ExcitationKind::None => Self::None,
            _ if excitation.amplitude == 0.0 => Self::None,
            ExcitationKind::Sine => Self::Sine(Sine::new(excitation)),
            ExcitationKind::HalfSine => Self::Sine(Sine::half(excitation)),
            ExcitationKind::LogSweep => Self::LogSweep(LogSweep::new(excitation)),
        }
    }

    /// Acceleration at an instant (s) within the window, m/s2.
    fn value(&self, time: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Sine(sine) => sine.reached(time) * sine.phasor(time).0,
            Self::LogSweep(sweep) => sweep.value(time),
            Self::Random(random) => random.value(time),
        }
    }

    fn window(&self) -> Option<Window> {
        match self {
            Self::None => None,
            Self::Sine(sine) => Some(sine.window),
            Self::LogSweep(sweep) => Some(sweep.window),
            Self::Random(random) => Some(random.window),
        }
    }

    /// Acceleration at an instant (s), m/s2; at a jump the limit from the right.
    pub fn acceleration(&self, time: f64) -> f64 {
        if self.is_active(time) { self.value(time) } else { 0.0 }
    }

    /// Acceleration at an instant (s), m/s2; at a jump the limit from the left.
    pub fn acceleration_before(&self, time: f64) -> f64 {
        let active = self.window().is_some_and(|window| window.is_open_before(time));
        if active { self.value(time) } else { 0.0 }
    }

    /// Sine and cosine of the generator's phase at `time` (s), times its amplitude once it has risen; zero if it is not a sine.
    pub(crate) fn phasor(&self, time: f64) -> (f64, f64) {
        match self {
            Self::Sine(sine) if sine.window.is_open_after(time) => sine.phasor(time),
            _ => (0.0, 0.0),
        }
    }

    /// Frequency of a sine generator, Hz.
    pub(crate) fn frequency(&self) -> Option<f64> {
        match self {
            Self::Sine(sine) => Some(sine.frequency),
            _ => None,
        }
    }

    /// Whether linear motion under it is known in closed form: a sine that begins at once, or none.
    pub(crate) fn is_harmonic(&self) -> bool {
        match self {
            Self::None => true,
            Self::Sine(sine) => sine.rise_time == 0.0,
            Self::LogSweep(_) | Self::Random(_) => false,
        }
    }

    /// Accelerations over a step that begins at `time` (s), with the coefficients of its length. There must be no
    /// [`Generator::next_break`] within the step. `piece` is kept from step to step.
    #[inline(always)]
    pub fn over_step<const S: usize>(
        &self,
        simd: Simd,
        time: f64,
        turns: &Turns<S>,
        piece: &mut Piece,
    ) -> Accelerations<S> {
        let mut nodes = [0.0; S];
        let start = match self {
            Self::None => 0.0,
            Self::Sine(sine) => {
                let (sin, cos) = self.phasor(time);
                let [sines, cosines] = &turns.rotation;
                for ((node, to_sin), to_cos) in nodes.iter_mut().zip(sines).zip(cosines) {
                    *node = sin * to_cos + cos * to_sin;
                }
                if sine.rises(time) {
                    raised(sine, time, &turns.times, &mut nodes);
                }
                sine.reached(time) * sin
            }
            Self::LogSweep(_) | Self::Random(_) => self.over_step_out_of_line(simd, time, turns, piece, &mut nodes),
        };
        Accelerations { start, nodes }
    }

    /// [`Generator::over_step`] of the costly generators, not inlined into the kernel of a step: returns the
    /// acceleration at the start, and replaces the zeros of `nodes`.
    #[inline(never)]
    fn over_step_out_of_line<const S: usize>(
        &self,
        simd: Simd,
        time: f64,
        turns: &Turns<S>,
        piece: &mut Piece,
        nodes: &mut Nodal<S>,
    ) -> f64 {
        let found = match self {
            Self::LogSweep(sweep) if self.is_active(time) => sweep.over_step(time, &turns.times),
            Self::Random(random) if self.is_active(time) => random.over_step(simd, time, &turns.times, piece),
            Self::None | Self::Sine(_) | Self::LogSweep(_) | Self::Random(_) => return 0.0,
        };
        *nodes = found.nodes;
        found.start
    }

    /// Whether there is an acceleration at `time` (s) or just after it.
    pub fn is_active(&self, time: f64) -> bool {
        self.window().is_some_and(|window| window.is_open_after(time))
    }

    /// The next instant after `time` at which the acceleration or its rate is not smooth, s.
    pub fn next_break(&self, time: f64) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Sine(sine) => sine.next_break(time),
            Self::LogSweep(sweep) => sweep.next_break(time),
            Self::Random(random) => random.window.next_end(time),
        }
    }

    /// Longest step from `time` (s) that resolves the acceleration: a quarter of its shortest period, s.
    pub fn longest_step(&self, time: f64) -> f64 {
        match self {
            Self::Sine(sine) if sine.window.is_open_after(time) => 0.25 / sine.frequency,
            Self::LogSweep(sweep) if sweep.window.is_open_after(time) => sweep.longest_step(time),
            Self::Random(random) if random.window.is_open_after(time) => 0.25 / random.highest,
            Self::None | Self::Sine(_) | Self::LogSweep(_) | Self::Random(_) => f64::INFINITY,
        }
    }
}

/// Lowers nodal values of a sine to what it has reached at these times from `time` (s) on.
#[inline(never)]
fn raised<const S: usize>(sine: &Sine, time: f64, times: &Nodal<S>, nodes: &mut Nodal<S>) {
    for (node, since) in nodes.iter_mut().zip(times) {
        *node *= sine.reached(time + since);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::polynomial::{LONG_BY_TIME, SHORT_BY_TIME};
    use crate::math::nodal::Nodal;

    /// A step's accelerations, at its start and at its nodes, are those of the instants.
    #[test]
    fn nodes_agree_with_direct_evaluation() {
        fn check<const S: usize>(nodes: &Nodal<S>, scene: &Scene, time: f64, length: f64) {
            let generator = Generator::new(scene);
            let mut turns = Turns::<S>::NONE;
            let e = &scene.excitation;
            // Rounding of time, in radians, and of the sums.
            let highest = e.frequency.max(e.end_frequency);
            let allowed = e.amplitude * (2.0 * TAU * highest * f64::EPSILON * (time + length) + 1e-13);
            for machine in [Simd::Portable, Simd::detect()] {
                turns.fill(&generator, length, nodes);
                let found = generator.over_step(machine, time, &turns, &mut Piece::default());
                let at_nodes = nodes.iter().map(|x| generator.acceleration_before(time + x * length));
                let expected = [generator.acceleration(time)].into_iter().chain(at_nodes);
                for (found, expected) in [found.start].iter().chain(&found.nodes).zip(expected) {
                    assert!(
                        (found - expected).abs() <= allowed,
                        "{:?} from {time} over {length}: {found} {expected}, allowed {allowed:e}",
                        scene.effects.excitation
                    );
                }
            }
        }
        let excited = |kind, (low, high): (f64, f64), times: (f64, f64)| {
            let mut scene = Scene::default();
            scene.effects.excitation = kind;
            (scene.excitation.frequency, scene.excitation.end_frequency) = (low, high);
            (scene.excitation.start_time, scene.excitation.duration) = times;
            scene.excitation.spectral_density = 4.0;
            (scene.excitation.phase, scene.excitation.displacement_limit) = (0.4, 3e-6);
            if kind == ExcitationKind::Random {
                // Half of its sines in phase.
                scene.excitation.amplitude = 0.5 * (512.0 * 4.0 * (high - low)).sqrt();
            }
            scene
        };
        let (sine, sweep, random) = (ExcitationKind::Sine, ExcitationKind::LogSweep, ExcitationKind::Random);
        let times = (3e-4, 2e-3);
        let mut rising = excited(sine, (1000.0, 0.0), times);
        rising.excitation.rise_time = 1.2e-3;
        let early = [
            rising,
            excited(sine, (1000.0, 0.0), times),
            excited(ExcitationKind::HalfSine, (1000.0, 0.0), times),
            excited(sweep, (300.0, 3000.0), times),
            excited(sweep, (3000.0, 300.0), times),
            excited(random, (100.0, 2500.0), times),
        ];
        let late = [
            excited(sweep, (1000.0, 1e6), (0.0, 1e9)),
            excited(sweep, (1e6, 1000.0), (0.0, 1e9)),
            excited(sweep, (10.0, 2000.0), (0.0, 900.0)),
            excited(sweep, (1000.0, 1001.0), (0.0, 1e9)),
            excited(sweep, (1000.0, 1000.0), (0.0, 1e9)),
            excited(sine, (1000.0, 0.0), (0.0, 1.0)),
            excited(random, (10.0, 2000.0), (0.0, 1.0)),
        ];
        let early_steps = [(0.0, 3e-4), (3e-4, 1e-4), (7.1e-4, 3e-5), (1.3e-3, 1e-9), (2.2e-3, 1e-4)];
        let late_steps = [0.1, 17.3, 449.9, 451.2, 899.9].map(|time| (time, 3e-5));
        for (scenes, steps) in [(&early[..], early_steps), (&late[..], late_steps)] {
            for (scene, (time, length)) in scenes.iter().flat_map(|scene| steps.map(|step| (scene, step))) {
                check(&SHORT_BY_TIME.nodes, scene, time, length);
                check(&LONG_BY_TIME.nodes, scene, time, length);
            }
        }
        check(&LONG_BY_TIME.nodes, &late[0], 7e8, 1e-7);
    }
}
