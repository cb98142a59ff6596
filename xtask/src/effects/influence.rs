//! What an effect changes in the scenes.

use anyhow::Result;
use relay_contact::scene_file::SceneFile;
use relay_contact::variables::RealOutput;

use super::list::{Effect, Settings};
use crate::scene;

const SCENES: [&str; 3] = ["paper-1khz", "chatter-41g", "shock-50g"];

/// Contact force, N, and resistance, Ohm, at the communication points.
struct Course {
    forces: Vec<f64>,
    resistances: Vec<f64>,
}

/// What it changes in each scene.
pub fn influence(effect: &Effect) -> Result<Vec<String>> {
    SCENES.iter().map(|name| in_scene(effect, name)).collect()
}

fn in_scene(effect: &Effect, name: &str) -> Result<String> {
    let with = course(scene::read(name)?, effect.setting)?;
    let without = course(scene::read(name)?, effect.off)?;
    let forces = with.forces.iter().zip(&without.forces);
    let force = greatest(forces.map(|(with, without)| with - without));
    // Both start closed.
    let opens = with.forces.iter().chain(&without.forces).any(|force| *force <= 0.0);
    let resistances = with.resistances.iter().zip(&without.resistances);
    let resistance = greatest(resistances.map(|(with, without)| with - without));
    let resistance = if opens {
        "the contact opens".to_owned()
    } else {
        format!("the resistance by {}", amount(1e3 * resistance, "mΩ"))
    };
    Ok(format!(
        "in *{name}* the force by {}, {resistance}",
        amount(1e3 * force, "mN")
    ))
}

fn course(mut file: SceneFile, settings: Settings) -> Result<Course> {
    for (name, value) in settings {
        file.set(name, value)?;
    }
    let mut contact = scene::start(&file)?;
    let mut course = Course {
        forces: Vec::new(),
        resistances: Vec::new(),
    };
    for (time, size) in file.steps() {
        contact.step(&file.inputs_over(time, size)?, time, size)?;
        course.forces.push(contact.real(RealOutput::ContactForce));
        course.resistances.push(contact.real(RealOutput::ContactResistance));
    }
    Ok(course)
}

fn greatest(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |greatest, difference| greatest.max(difference.abs()))
}

/// Three digits, or nothing.
fn amount(value: f64, unit: &str) -> String {
    match value {
        0.0 => "nothing".to_owned(),
        value if (0.01..1e4).contains(&value) => {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 4")]
            let places = (2.0 - value.log10().floor()).clamp(0.0, 4.0) as usize;
            format!("{value:.places$} {unit}")
        }
        value => format!("{value:.1e} {unit}"),
    }
}
