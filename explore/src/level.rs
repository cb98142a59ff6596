//! The level of a steady vibration that opens the contact.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::many::RunError;
use relay_contact::reference::{self, Model};
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

/// To this part of it: less than the line on the page is wide.
const RESOLUTION: f64 = 2e-3;

/// From guess to guess. Larger steps would pass a level at which the contact opens and stays closed again above.
const FACTOR: f64 = 1.1;

/// Guesses at most: a level a thousand times that of linear theory is none.
const GUESSES: i32 = 73;

/// Decades by which the start has died away when the vibration counts as steady: as [`RESOLUTION`].
const DECADES: f64 = 3.0;

/// Periods in which an opening counts: one that bounces may open in every second one.
const WATCHED: f64 = 4.0;

/// Least amplitude (m/s²) of a sine of this frequency (Hz) at which the contact of a scene opens in steady vibration, and that
/// of linear theory. The scene's own excitation does not act. Infinite if no level opens it.
pub fn level(text: &str, frequency: f64) -> Result<[f64; 2], RunError> {
    let file: SceneFile = text.parse()?;
    let mut scene = file.scene;
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.frequency = frequency;
    scene.excitation.start_time = 0.0;
    scene.excitation.rise_time = settling(&scene, &file.inputs)?;
    let linear = reference::opening_threshold(&Model::new(&scene, 0.0)?, TAU * frequency);
    let mut opens = |amplitude: f64| {
        scene.excitation.amplitude = amplitude;
        opens(&scene, &file.inputs)
    };
    let (mut low, mut high) = (linear / FACTOR, linear);
    let mut guesses = 0..GUESSES;
    while !opens(high)? {
        if guesses.next().is_none() {
            return Ok([f64::INFINITY, linear]);
        }
        (low, high) = (high, FACTOR * high);
    }
    // Below a guess that was raised lies one that was too low.
    while low < linear && opens(low)? {
        (low, high) = (low / FACTOR, low);
    }
    while high > (1.0 + RESOLUTION) * low {
        let middle = (low * high).sqrt();
        if opens(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok([high, linear])
}

/// Time after which the start of a vibration has died away, s: whole periods.
fn settling(scene: &Scene, inputs: &Inputs) -> Result<f64, RunError> {
    let frequency = scene.excitation.frequency;
    let natural = TAU * Simulation::new(scene, inputs, 0.0)?.real(RealOutput::PreloadFrequency);
    let decay = 0.5 * (scene.beam.mass_damping + scene.beam.stiffness_damping * natural.powi(2));
    let settling = DECADES * 10.0_f64.ln() / decay;
    Ok((settling * frequency).clamp(2.0, 1000.0).ceil() / frequency)
}

/// Whether the contact opens in steady vibration: after it has risen to the level and was held for as long.
fn opens(scene: &Scene, inputs: &Inputs) -> Result<bool, RunError> {
    let mut contact = Simulation::new(scene, inputs, 0.0)?;
    let (period, steady) = (1.0 / scene.excitation.frequency, 2.0 * scene.excitation.rise_time);
    // By periods: where a contact flutters, one step of all would take too many integration steps.
    while contact.time() < steady - 0.5 * period {
        contact.step(inputs, contact.time(), period)?;
    }
    let steady = contact.time();
    contact.step(inputs, steady, WATCHED * period)?;
    Ok(contact.real(RealOutput::ContactLastOpening) > steady)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(frequency: f64, rest: &str) -> Result<[f64; 2], RunError> {
        let text = format!("stop = 1\ncommunicationStep = 1\noutputs = []\n[parameters]\n{rest}");
        level(&text, frequency)
    }

    /// The contact is closed at rest, so the level of a linearised one is that of linear theory; the search and the run in
    /// time know nothing of that.
    #[test]
    fn a_linearised_contact_opens_at_the_level_of_linear_theory() -> Result<(), RunError> {
        for frequency in [200.0, 1000.0, 2500.0] {
            let [found, linear] = scene(frequency, "effects.contactLaw = \"Linearised\"")?;
            assert!((found / linear - 1.0).abs() < 2.0 * RESOLUTION, "{frequency} Hz: {found} {linear}");
        }
        Ok(())
    }

    /// One that is so damped that it flutters at no force: a step of the whole rise would take too many integration steps.
    #[test]
    fn a_contact_that_flutters_has_a_level() -> Result<(), RunError> {
        let rest = "effects.contactLaw = \"Linearised\"\ncontact.overtravel = 6e-4\nbeam.length = 0.03\n\
                    beam.thickness = 1e-4\ncontact.curvatureRadius = 0.06\ncontact.damping = 1.8e-4\n";
        let [found, linear] = scene(5000.0, rest)?;
        assert!((found / linear - 1.0).abs() < 2.0 * RESOLUTION, "{found} {linear}");
        Ok(())
    }

    /// Of the report, which finds it by another rise and another search: 29.7 g near the first resonance.
    #[test]
    fn the_published_contact_opens_most_easily_at_the_level_of_the_report() -> Result<(), RunError> {
        let levels = [1250.0, 1300.0, 1350.0, 1400.0, 1450.0].map(|frequency| scene(frequency, ""));
        let least =
            levels.into_iter().try_fold(f64::INFINITY, |least, level| Ok::<_, RunError>(least.min(level?[0])))?;
        assert!((least / 9.80665 - 29.7).abs() < 0.3, "{}", least / 9.80665);
        Ok(())
    }
}
