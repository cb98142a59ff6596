//! What an effect changes in the scenes.

use anyhow::Result;
use relay_contact::scene_file::SceneFile;
use relay_contact::variables::RealOutput;

use super::list::{Effect, Settings};
use crate::scene;

/// Scenes in which the contact stays closed.
pub const CLOSED: [&str; 2] = ["paper-1khz", "shock-50g"];

/// A scene in which it opens again and again: forces of blows are not compared, they depend on everything.
pub const OPENING: &str = "chatter-41g";

/// Contact force, N, and resistance, Ohm, at the communication points.
struct Course {
    forces: Vec<f64>,
    resistances: Vec<f64>,
    step: f64,
}

/// What it changes, as the cells of a row: force and resistance in each of [`CLOSED`], the time open in [`OPENING`].
pub fn influence(effect: &Effect) -> Result<String> {
    let mut cells = Vec::new();
    for name in CLOSED {
        let with = course(name, effect.setting)?;
        let without = course(name, effect.off)?;
        cells.push(amount(1e3 * greatest(&with.forces, &without.forces)));
        cells.push(amount(1e3 * greatest(&with.resistances, &without.resistances)));
    }
    for settings in [effect.off, effect.setting] {
        cells.push(format!("{:.3}", 1e3 * course(OPENING, settings)?.open()));
    }
    Ok(cells.join(" | "))
}

fn course(name: &str, settings: Settings) -> Result<Course> {
    let mut file: SceneFile = scene::read(name)?;
    for (name, value) in settings {
        file.set(name, value)?;
    }
    let mut contact = scene::start(&file)?;
    let mut course = Course {
        forces: Vec::new(),
        resistances: Vec::new(),
        step: file.communication_step,
    };
    for (time, size) in file.steps() {
        contact.step(&file.inputs_over(time, size)?, time, size)?;
        course.forces.push(contact.real(RealOutput::ContactForce));
        course.resistances.push(contact.real(RealOutput::ContactResistance));
    }
    Ok(course)
}

impl Course {
    /// Time without force, s, by the communication points.
    fn open(&self) -> f64 {
        self.forces
            .iter()
            .filter(|force| **force <= 0.0)
            .map(|_| self.step)
            .sum()
    }
}

/// The largest difference at a communication point.
fn greatest(with: &[f64], without: &[f64]) -> f64 {
    let differences = with.iter().zip(without).map(|(with, without)| with - without);
    differences.fold(0.0, |greatest, difference| greatest.max(difference.abs()))
}

/// Two digits.
fn amount(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if (0.01..1e4).contains(&value) => {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 3")]
            let places = (1.0 - value.log10().floor()).clamp(0.0, 3.0) as usize;
            format!("{value:.places$}")
        }
        value => format!("{value:.0e}"),
    }
}
