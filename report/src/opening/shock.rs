//! The specimen under a half-sine shock, from rest.

use std::f64::consts::PI;

use anyhow::Result;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;

use super::vibration::Outcome;

/// The acceleration is linear between communication points this far apart, s: off the sine by 1e-6 of its amplitude.
const STEP: f64 = 1e-5;

/// Time looked at from the start of the shock, in its durations.
const LENGTH: f64 = 3.0;

/// A shock of an amplitude (m/s2; negative: pulling the contact open) and a duration (s).
pub fn shock(amplitude: f64, duration: f64) -> Result<Outcome> {
    let at = |time: f64| {
        if time < duration {
            amplitude * (PI * time / duration).sin()
        } else {
            0.0
        }
    };
    let mut contact = Simulation::new(&Scene::default(), &Inputs::default(), 0.0)?;
    let preload = contact.real(RealOutput::PreloadForce);
    let mut least_force = 1.0_f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousands")]
    let steps = (LENGTH * duration / STEP).round() as u32;
    for step in 0..steps {
        let time = f64::from(step) * STEP;
        let inputs = Inputs {
            base_acceleration: at(time),
            base_acceleration_rate: (at(time + STEP) - at(time)) / STEP,
            ..Inputs::default()
        };
        contact.step(&inputs, time, STEP)?;
        least_force = least_force.min(contact.real(RealOutput::StepMinimumForce) / preload);
    }
    Ok(Outcome::of(&contact, least_force))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shock_that_presses_is_that_of_the_generator() -> Result<()> {
        use relay_contact::variables::ExcitationKind;
        let mut scene = Scene::default();
        scene.effects.excitation = ExcitationKind::HalfSine;
        scene.excitation.amplitude = 490.0;
        scene.excitation.duration = 0.011;
        let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
        contact.step(&Inputs::default(), 0.0, LENGTH * 0.011)?;
        let generated = contact.real(RealOutput::StepMinimumForce) / contact.real(RealOutput::PreloadForce);
        let given = shock(490.0, 0.011)?.least_force;
        assert!((given - generated).abs() < 1e-5, "{given} {generated}");
        Ok(())
    }
}
