//! The specimen under a half-sine shock, from rest.

use anyhow::Result;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

use super::vibration::Outcome;

/// Time simulated from the start of the shock, in its durations.
const LENGTH: f64 = 3.0;

/// A shock of an amplitude (m/s2; negative: pulling the contact open) and a duration (s).
pub fn shock(amplitude: f64, duration: f64) -> Result<Outcome> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.amplitude = amplitude;
    scene.excitation.duration = duration;
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let preload = contact.real(RealOutput::PreloadForce);
    contact.step(&Inputs::default(), 0.0, LENGTH * duration)?;
    let least_force = contact.real(RealOutput::StepMinimumForce);
    Ok(Outcome::of(&contact, least_force / preload))
}
