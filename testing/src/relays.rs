//! Random plausible relays: springs, contacts, damping, gaps, excitations, inputs, tolerances and communication steps as
//! relays have them, drawn by number.

use std::f64::consts::TAU;

use fastrand::Rng;
use relay_contact::error::{SceneError, StepError};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{
    AxialForceKind, BooleanOutput, ContactLawKind, ExcitationKind, IntegerOutput, RealOutput,
};

use crate::scenes::{propped_mass, tip_stiffness};

/// A relay, how it is driven, and how it is asked.
#[derive(Clone, Debug)]
pub struct Relay {
    /// What kind of relay ([`crate::kinds`]).
    pub kind: &'static str,
    /// Parameters and effects.
    pub scene: Scene,
    /// Amplitude (m/s2) and frequency (Hz) of `base.acceleration`, an input beside the generator.
    pub shake: (f64, f64),
    /// Amplitude (m) and frequency (Hz) of `support.displacement`.
    pub travel: (f64, f64),
    /// Where a pusher stands at the start, m, and whether it moves to and fro in place of the fixed contact.
    pub pusher: f64,
    /// See [`Relay::pusher`].
    pub pushes: bool,
    /// Whether inputs are held over each communication step, and jump to the next; else they change linearly.
    pub held: bool,
    /// Inputs of each communication step, in place of both and of `held`; empty: none.
    pub knots: Vec<Inputs>,
    /// Length of the communication steps, s, and their number.
    pub steps: (f64, u32),
    /// Equal parts in which each of them is taken, 1.
    pub parts: u32,
    /// Damping of the first mode of the spring without contact, relative to critical.
    pub damping: f64,
}

/// What was read after each communication step, and the events.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// Number of contacts.
    pub contacts: usize,
    /// Contact force, N; of each contact after the other.
    pub force: Vec<f64>,
    /// Least force within the step, N.
    pub least: Vec<f64>,
    /// Greatest force within the step, N.
    pub greatest: Vec<f64>,
    /// Instants of openings and closings, s.
    pub events: Vec<f64>,
    /// `solver.forceError` at the end, 1.
    pub estimate: f64,
    /// Integration steps.
    pub steps: i32,
    /// Force scale of the tolerance, N.
    pub scale: f64,
}

/// What is read of a contact: force, extremes of a step, instants of the last opening and closing, and whether it is closed.
pub type Outputs = ([RealOutput; 5], BooleanOutput);

const CONTACT: Outputs = (
    [
        RealOutput::ContactForce,
        RealOutput::StepMinimumForce,
        RealOutput::StepMaximumForce,
        RealOutput::ContactLastOpening,
        RealOutput::ContactLastClosing,
    ],
    BooleanOutput::ContactClosed,
);
const SECOND: Outputs = (
    [
        RealOutput::SecondForce,
        RealOutput::SecondMinimumForce,
        RealOutput::SecondMaximumForce,
        RealOutput::SecondLastOpening,
        RealOutput::SecondLastClosing,
    ],
    BooleanOutput::SecondClosed,
);
const PARALLEL: Outputs = (
    [
        RealOutput::ParallelForce,
        RealOutput::ParallelMinimumForce,
        RealOutput::ParallelMaximumForce,
        RealOutput::ParallelLastOpening,
        RealOutput::ParallelLastClosing,
    ],
    BooleanOutput::ParallelClosed,
);

/// The contacts that a scene has.
pub fn contacts(scene: &Scene) -> Vec<Outputs> {
    let effects = &scene.effects;
    let second = effects.second_contact.then_some(SECOND);
    let parallel = effects.parallel_contact.then_some(PARALLEL);
    [CONTACT].into_iter().chain(second).chain(parallel).collect()
}

/// Between both, each order of magnitude as likely as the others.
pub(crate) fn logarithmic(rng: &mut Rng, least: f64, greatest: f64) -> f64 {
    least * (greatest / least).powf(rng.f64())
}

pub(crate) fn uniform(rng: &mut Rng, least: f64, greatest: f64) -> f64 {
    least + (greatest - least) * rng.f64()
}

impl Relay {
    /// The relay of a number.
    pub fn draw(number: u64) -> Self {
        let rng = &mut Rng::with_seed(number);
        let mut scene = Scene::default();
        let damping = spring(rng, &mut scene);
        contact(rng, &mut scene);
        let static_force = scene.contact.overtravel.max(2e-5) * tip_stiffness(&scene);
        // The base acceleration that would open the contact, if it were slow.
        let threshold = static_force / propped_mass(&scene);
        let frequency = logarithmic(rng, 50.0, 3000.0);
        let amplitude = (threshold * logarithmic(rng, 0.05, 5.0)).min(3e4);
        generator(rng, &mut scene, amplitude, frequency);
        let shake = match rng.u8(..4) {
            0 => (amplitude * 0.5, logarithmic(rng, 50.0, 3000.0)),
            _ => (0.0, 1.0),
        };
        let travel = match rng.u8(..4) {
            0 => {
                let frequency = logarithmic(rng, 20.0, 1000.0);
                let fastest = 0.5 / (TAU * frequency);
                let way = scene.contact.overtravel.abs() * logarithmic(rng, 0.1, 2.0);
                (way.min(fastest), frequency)
            }
            _ => (0.0, 1.0),
        };
        scene.solver.tolerance = logarithmic(rng, 1e-8, 1e-2);
        let duration = (5.0 / frequency).clamp(2e-3, 2e-2);
        let step = logarithmic(rng, 2e-6, 1e-3_f64.min(duration / 5.0));
        Self { shake, travel, damping, ..Self::of("plain", scene, steps(step, duration)) }
    }

    /// A scene in so many communication steps of a length (s), driven by its generator alone.
    pub fn of(kind: &'static str, scene: Scene, steps: (f64, u32)) -> Self {
        let still = (0.0, 1.0);
        Self {
            kind,
            scene,
            shake: still,
            travel: still,
            pusher: 0.0,
            pushes: false,
            held: false,
            knots: Vec::new(),
            steps,
            parts: 1,
            damping: f64::NAN,
        }
    }

    /// The inputs over a communication step: values at its start, and the rates that lead to those at its end.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of steps")]
    pub fn inputs(&self, time: f64, size: f64) -> Inputs {
        if let Some(inputs) = self.knots.get((time / size).round() as usize) {
            return Inputs { pusher_displacement: self.pusher, ..*inputs };
        }
        let at = |(amplitude, frequency): (f64, f64), time: f64| amplitude * (TAU * frequency * time).sin();
        let rate = |wave| {
            if self.held { 0.0 } else { (at(wave, time + size) - at(wave, time)) / size }
        };
        let mut inputs = Inputs {
            base_acceleration: at(self.shake, time),
            base_acceleration_rate: rate(self.shake),
            pusher_displacement: self.pusher,
            ..Inputs::default()
        };
        let (way, rate) = (at(self.travel, time), rate(self.travel));
        if self.pushes {
            inputs.pusher_displacement += way;
            inputs.pusher_displacement_rate = rate;
        } else {
            inputs.support_displacement = way;
            inputs.support_displacement_rate = rate;
        }
        inputs
    }

    /// Simulates with the parameters changed by `change`.
    /// A step that fails ends the course.
    pub fn run(&self, change: impl FnOnce(&mut Scene)) -> Result<(Course, Option<StepError>), SceneError> {
        let mut scene = self.scene.clone();
        change(&mut scene);
        let (size, count) = self.steps;
        let mut simulation = Simulation::new(&scene, &self.inputs(0.0, size), 0.0)?;
        let contacts = contacts(&scene);
        let mut course =
            Course { contacts: contacts.len(), scale: simulation.model().force_scale, ..Course::default() };
        let part = size / f64::from(self.parts);
        for k in 0..count {
            let start = f64::from(k) * size;
            let inputs = self.inputs(start, size);
            let mut extremes = vec![(f64::INFINITY, f64::NEG_INFINITY); contacts.len()];
            for done in (0..self.parts).map(|done| f64::from(done) * part) {
                if let Err(error) = simulation.step(&after(&inputs, done), start + done, part) {
                    return Ok((course, Some(error)));
                }
                for (([_, least, greatest, ..], _), (low, high)) in contacts.iter().zip(&mut extremes) {
                    let [least, greatest] = [least, greatest].map(|output| simulation.real(*output));
                    (*low, *high) = (low.min(least), high.max(greatest));
                }
                course.events.extend(simulation.events().0.map(|event| event.time));
            }
            for (([force, ..], _), (low, high)) in contacts.iter().zip(extremes) {
                let force = simulation.real(*force);
                let recorded = scene.effects.extremes;
                course.force.push(force);
                course.least.push(if recorded { low } else { force });
                course.greatest.push(if recorded { high } else { force });
            }
            course.estimate = simulation.real(RealOutput::SolverForceError);
            course.steps = simulation.integer(IntegerOutput::SolverSteps);
        }
        Ok((course, None))
    }
}

/// The inputs of a relay after `size` seconds.
pub fn after(inputs: &Inputs, size: f64) -> Inputs {
    let [support_displacement, _, pusher_displacement] = inputs.displacements_after(size);
    Inputs {
        base_acceleration: inputs.base_acceleration + inputs.base_acceleration_rate * size,
        support_displacement,
        pusher_displacement,
        ..*inputs
    }
}

/// Communication steps of this length (s) over a duration (s): their length and number.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of steps
pub(crate) fn steps(length: f64, duration: f64) -> (f64, u32) {
    (length, (duration / length).ceil() as u32)
}

/// Returns the damping of the first mode, relative to critical.
fn spring(rng: &mut Rng, scene: &mut Scene) -> f64 {
    // The others have the section of the start values.
    if rng.u8(..6) > 0 {
        let beam = &mut scene.beam;
        beam.length = logarithmic(rng, 5e-3, 4e-2);
        beam.width = logarithmic(rng, 1e-3, 1e-2);
        beam.thickness = beam.length * logarithmic(rng, 5e-3, 2e-2);
        beam.youngs_modulus = uniform(rng, 8e10, 2.1e11);
        beam.density = uniform(rng, 4e3, 9e3);
    }
    let beam = scene.beam;
    let mass = beam.density * beam.width * beam.thickness * beam.length;
    scene.tip.mass = if rng.u8(..4) == 0 { 0.0 } else { mass * logarithmic(rng, 0.03, 3.0) };
    // First mode of the cantilever, its tip mass included (Rayleigh's quotient with the static shape).
    let stiffness = tip_stiffness(scene);
    let omega = (stiffness / (33.0 / 140.0 * mass + scene.tip.mass)).sqrt();
    let ratio = logarithmic(rng, 1e-3, 0.34);
    let share = if rng.bool() { 0.0 } else { rng.f64() * 0.5 };
    scene.beam.stiffness_damping = 2.0 * ratio * (1.0 - share) / omega;
    scene.beam.mass_damping = 2.0 * ratio * share * omega;
    scene.effects.axial_force = match rng.u8(..6) {
        0 => AxialForceKind::None,
        1 => AxialForceKind::FromDeflection,
        2 => AxialForceKind::Prescribed,
        _ => AxialForceKind::FromPreload,
    };
    let buckling = stiffness * scene.beam.length * std::f64::consts::PI.powi(2) / 12.0;
    scene.beam.axial_force = buckling * uniform(rng, -0.3, 0.5);
    scene.environment.gravity = [0.0, 9.81, -9.81][rng.usize(..3)];
    ratio
}

fn contact(rng: &mut Rng, scene: &mut Scene) {
    let contact = &mut scene.contact;
    contact.overtravel = scene.beam.length * logarithmic(rng, 1e-3, 2e-2);
    if rng.u8(..6) == 0 {
        contact.overtravel *= -0.2;
    }
    contact.curvature_radius = logarithmic(rng, 3e-4, 3e-2);
    contact.damping = logarithmic(rng, 1e-7, 1e-4);
    scene.effects.contact_damping = rng.u8(..10) > 0;
    scene.effects.contact_law = match rng.u8(..8) {
        0 if scene.contact.overtravel > 0.0 => ContactLawKind::Linearised,
        _ => ContactLawKind::Hertz,
    };
}

fn generator(rng: &mut Rng, scene: &mut Scene, amplitude: f64, frequency: f64) {
    let excitation = &mut scene.excitation;
    excitation.amplitude = amplitude;
    excitation.frequency = frequency;
    excitation.phase = uniform(rng, 0.0, TAU);
    excitation.seed = rng.i32(0..1000);
    scene.effects.excitation = match rng.u8(..8) {
        0 => ExcitationKind::None,
        1 => {
            excitation.end_frequency = frequency * 4.0;
            excitation.duration = 5.0 / frequency;
            ExcitationKind::LogSweep
        }
        2 => {
            excitation.duration = 1.0 / frequency;
            ExcitationKind::HalfSine
        }
        3 => {
            excitation.end_frequency = frequency * 4.0;
            excitation.spectral_density = amplitude.powi(2) / 9.0 / (3.0 * frequency);
            ExcitationKind::Random
        }
        _ => ExcitationKind::Sine,
    };
}

impl Course {
    /// Whether the contact opened or closed.
    pub fn opens(&self) -> bool {
        let first = self.least.iter().step_by(self.contacts.max(1));
        !self.events.is_empty() || first.copied().any(|force| force <= 0.0)
    }

    /// The largest error of the force and its extremes, relative to the larger of force scale and largest force so far in the
    /// reference.
    pub fn error(&self, reference: &Self) -> f64 {
        let (mut scale, mut error) = (reference.scale, 0.0_f64);
        for (k, greatest) in reference.greatest.iter().enumerate() {
            scale = scale.max(*greatest);
            let difference = |own: &[f64], other: &[f64]| match (own.get(k), other.get(k)) {
                (Some(a), Some(b)) if (a - b).is_finite() => (a - b).abs() / scale,
                _ => f64::INFINITY,
            };
            error = error.max(difference(&self.force, &reference.force));
            error = error.max(difference(&self.least, &reference.least));
            error = error.max(difference(&self.greatest, &reference.greatest));
        }
        error
    }

    /// The largest error of an instant of opening or closing, s; `None` if there are more or fewer of them.
    pub fn error_of_instants(&self, reference: &Self) -> Option<f64> {
        let pairs = self.events.iter().zip(&reference.events);
        (self.events.len() == reference.events.len())
            .then(|| pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs())))
    }
}
