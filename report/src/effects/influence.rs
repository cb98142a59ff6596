//! What an effect changes in the scenes.

use anyhow::Result;
use relay_contact::scene::file::SceneFile;
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

/// What an effect changes.
pub struct Influence {
    /// Largest difference of force, N, and of resistance, Ohm, in each of [`CLOSED`].
    pub closed: [[f64; 2]; CLOSED.len()],
    /// Time open in [`OPENING`] without it and with it, s.
    pub open: [f64; 2],
}

/// What it changes in the scenes.
pub fn influence(effect: &Effect) -> Result<Influence> {
    let mut closed = [[0.0; 2]; CLOSED.len()];
    for (name, differences) in CLOSED.into_iter().zip(&mut closed) {
        let with = course(name, effect.setting)?;
        let without = course(name, effect.off)?;
        *differences = [
            greatest(&with.forces, &without.forces),
            greatest(&with.resistances, &without.resistances),
        ];
    }
    let open = |settings| Ok::<_, anyhow::Error>(course(OPENING, settings)?.open());
    Ok(Influence {
        closed,
        open: [open(effect.off)?, open(effect.setting)?],
    })
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
