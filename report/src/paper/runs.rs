//! The runs behind the comparison: periodic states of the nonlinear model, linear response, first frequencies.

use std::f64::consts::{PI, TAU};

use anyhow::{Context, Result};
use relay_contact::inputs::Inputs;
use relay_contact::reference::{self, ElectricalContact, Law, Model, Power};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ExcitationKind, RealOutput};

use super::published::{ACCELERATION, BEST};
use identify::Amplitude;

/// Communication steps of the last period, which is recorded.
const SAMPLES: u32 = 1000;
/// A motion is periodic if the extremes of the force change by less than this fraction of the preload from one period
/// to the next; below the digits shown.
const PERIODIC: f64 = 1e-6;
/// Transients decay to this fraction.
const DECAYED: f64 = 1e-8;
/// Tolerance of the runs: far below the digits shown.
const TOLERANCE: f64 = 1e-9;

/// The damping times per published ratio, s; the start values correspond to ratio 10.
pub fn damping_per_ratio() -> f64 {
    Scene::default().beam.stiffness_damping / BEST
}

/// The specimen with the damping of a published ratio.
pub fn specimen(ratio: f64) -> Scene {
    with_damping(damping_per_ratio() * ratio)
}

/// The specimen with damping times of beam and contact, s.
pub fn with_damping(damping: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::FromPreload;
    scene.beam.stiffness_damping = damping;
    scene.contact.damping = damping;
    scene
}

/// The specimen of the frequency domain with mass damping only; mass coefficient in 1/s.
pub fn with_mass_damping(alpha: f64) -> Scene {
    let mut scene = with_damping(0.0);
    scene.beam.mass_damping = alpha;
    scene
}

/// A spring of another length and overtravel, m.
pub fn spring(length: f64, overtravel: f64, axial: AxialForceKind) -> Scene {
    let mut scene = Scene::default();
    scene.beam.length = length;
    scene.contact.overtravel = overtravel;
    scene.effects.axial_force = axial;
    scene
}

/// The model of a scene.
pub fn model(scene: &Scene) -> Result<Model> {
    Ok(Model::new(scene, 0.0)?)
}

/// Amplitude of the base displacement, m.
pub fn excitation(frequency: f64) -> f64 {
    ACCELERATION / (TAU * frequency).powi(2)
}

/// Amplitude of the contact force in the linear response to the published vibration, cN.
pub fn linear_force(model: &Model, frequency: f64) -> f64 {
    Amplitude::Whole.of(model, frequency)
}

/// That of its elastic part, cN, without the contribution of contact damping.
pub fn elastic_force(model: &Model, frequency: f64) -> f64 {
    Amplitude::Elastic.of(model, frequency)
}

/// Contact resistance of the specimen at a force (N), mOhm.
pub fn resistance(force: f64) -> f64 {
    let scene = Scene::default();
    let law = Law::Power(Power::hertz(&scene.contact));
    ElectricalContact::new(&scene, &law).map_or(f64::NAN, |path| 1e3 / path.conductance(force))
}

/// The periodic motion under the published vibration.
#[derive(Clone, Debug, Default)]
pub struct Periodic {
    pub frequency: f64,
    /// Extremes of the contact force, N.
    pub least: f64,
    pub greatest: f64,
    /// Amplitude of the displacement of the contact with the base, m.
    pub displacement: f64,
    /// Phase by which the force leads that displacement, degrees from 0 to 180.
    pub phase: f64,
    /// Whether the motion is periodic. Otherwise the extremes are those of the last period.
    pub repeats: bool,
    /// Whether the force reaches zero in the last ten periods.
    pub opens: bool,
    /// Over the last period: time, s; force, N; displacement of the contact with the base, m.
    pub course: Vec<(f64, f64, f64)>,
}

impl Periodic {
    /// Half the difference between the extremes of the force, cN.
    pub fn amplitude(&self) -> f64 {
        50.0 * (self.greatest - self.least)
    }
}

/// The periodic motion that a scene reaches from rest under the published vibration at a frequency, Hz.
/// The run lasts until the transients have fallen below the digits shown: the slowest one of the damped linear model,
/// or the relaxation time if the motion is overdamped.
pub fn periodic(scene: &Scene, frequency: f64) -> Result<Periodic> {
    let mut scene = scene.clone();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = ACCELERATION;
    scene.excitation.frequency = frequency;
    scene.solver.tolerance = TOLERANCE;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let omega = TAU * simulation.model().frequency();
    let decay = scene.beam.mass_damping + scene.beam.stiffness_damping * omega * omega;
    let slowest = (2.0 / decay).max(decay / (omega * omega)).max(scene.contact.damping);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousands at most
    let periods = (-DECAYED.ln() * slowest * frequency).ceil().max(10.0) as u32 + 2;

    let base = excitation(frequency);
    let deflection = simulation.model().preload().deflection;
    let force_scale = simulation.model().preload().force;
    let mut found = Periodic {
        frequency,
        ..Periodic::default()
    };
    let mut last = (f64::NAN, f64::NAN);
    for period in 0..periods {
        last = (found.least, found.greatest);
        (found.least, found.greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        found.course.clear();
        let samples = if period + 1 == periods { SAMPLES } else { 1 };
        for sample in 1..=samples {
            let time = simulation.time();
            let next = (f64::from(period) + f64::from(sample) / f64::from(samples)) / frequency;
            simulation
                .step(&Inputs::default(), time, next - time)
                .with_context(|| format!("{frequency} Hz"))?;
            found.least = found.least.min(simulation.real(RealOutput::StepMinimumForce));
            found.greatest = found.greatest.max(simulation.real(RealOutput::StepMaximumForce));
            if period + 1 == periods {
                let shaken = -base * (TAU * f64::from(sample) / f64::from(SAMPLES)).sin();
                let displacement = simulation.real(RealOutput::TipDisplacement) - deflection + shaken;
                let force = simulation.real(RealOutput::ContactForce);
                found
                    .course
                    .push((f64::from(sample) / f64::from(SAMPLES) / frequency, force, displacement));
            }
        }
        found.opens |= period + 10 >= periods && found.least <= 0.0;
    }
    let changed = (found.least - last.0).abs().max((found.greatest - last.1).abs());
    found.repeats = changed < PERIODIC * force_scale;
    let displacements = found.course.iter().map(|point| point.2);
    found.displacement =
        0.5 * (displacements.clone().fold(f64::MIN, f64::max) - displacements.fold(f64::MAX, f64::min));
    let angle = angle(&found.course, |point| point.1) - angle(&found.course, |point| point.2);
    found.phase = angle.sin().atan2(angle.cos()).abs() * 180.0 / PI;
    Ok(found)
}

/// Phase of the component of a signal at the excitation frequency, rad.
fn angle(course: &[(f64, f64, f64)], value: impl Fn(&(f64, f64, f64)) -> f64) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (k, point) in (1..).zip(course) {
        let turn = TAU * f64::from(k) / f64::from(SAMPLES);
        sine += value(point) * turn.sin();
        cosine += value(point) * turn.cos();
    }
    f64::atan2(cosine, sine)
}

/// Axial compression at which the specimen has a given first frequency (Hz), N.
pub fn axial_force_for(frequency: f64) -> Result<f64> {
    let with = |force: f64| {
        let mut scene = Scene::default();
        scene.effects.axial_force = AxialForceKind::Prescribed;
        scene.beam.axial_force = force;
        Model::new(&scene, 0.0).map_or(f64::NAN, |model| model.frequency() - frequency)
    };
    let limit = model(&Scene::default())?.section().buckling_load();
    reference::bracketed(with, 0.0, 0.99 * limit).context("no axial force below the buckling load gives this frequency")
}
