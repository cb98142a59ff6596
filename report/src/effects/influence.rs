//! What an effect changes in the scenes.

use anyhow::{Context, Result};
use rayon::prelude::*;
use relay_contact::scene::Scene;
use relay_contact::variables::RealOutput;

use super::list::{EFFECTS, Effect, Settings};
use crate::scene;

/// Scenes in which the contact stays closed.
pub const CLOSED: [&str; 2] = ["paper-1khz", "shock-50g"];

/// A scene in which it opens again and again: forces of blows are not compared, they depend on everything.
pub const OPENING: &str = "chatter-41g";

/// Contact force, N, and resistance, Ohm, at the communication points.
struct History {
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

/// Runs of the scenes with the settings of all effects, each different one once.
pub struct Runs(Vec<(&'static str, Scene, History)>);

impl Runs {
    /// Runs all of them.
    pub fn compute() -> Result<Self> {
        let mut files = Vec::new();
        for name in CLOSED.into_iter().chain([OPENING]) {
            let compared = EFFECTS.iter().filter(|effect| is_compared(effect));
            for settings in compared.flat_map(|effect| [effect.setting, effect.off]) {
                let file = scene_with(name, settings)?;
                if !files
                    .iter()
                    .any(|(known, other): &(_, scene::SceneFile)| *known == name && other.scene == file.scene)
                {
                    files.push((name, file));
                }
            }
        }
        let run = |(name, file): (&'static str, scene::SceneFile)| Ok((name, file.scene.clone(), History::of(&file)?));
        Ok(Self(files.into_par_iter().map(run).collect::<Result<_>>()?))
    }

    /// What an effect changes; none where there is nothing to compare.
    pub fn influence(&self, effect: &Effect) -> Result<Option<Influence>> {
        if !is_compared(effect) {
            return Ok(None);
        }
        let mut closed = [[0.0; 2]; CLOSED.len()];
        for (name, differences) in CLOSED.into_iter().zip(&mut closed) {
            let with = self.find(name, effect.setting)?;
            let without = self.find(name, effect.off)?;
            *differences = [
                largest_difference(&with.forces, &without.forces),
                largest_difference(&with.resistances, &without.resistances),
            ];
        }
        let open = |settings| Ok::<_, anyhow::Error>(self.find(OPENING, settings)?.open());
        Ok(Some(Influence {
            closed,
            open: [open(effect.off)?, open(effect.setting)?],
        }))
    }

    fn find(&self, name: &str, settings: Settings) -> Result<&History> {
        let scene = scene_with(name, settings)?.scene;
        let mut runs = self.0.iter();
        let found = runs.find(|(known, other, _)| *known == name && *other == scene);
        found.map(|(_, _, history)| history).context("not run")
    }
}

fn is_compared(effect: &Effect) -> bool {
    !effect.off.is_empty()
}

fn scene_with(name: &str, settings: Settings) -> Result<scene::SceneFile> {
    let mut file = scene::read(name)?;
    for (name, value) in settings {
        file.set(name, value)?;
    }
    Ok(file)
}

impl History {
    fn of(file: &scene::SceneFile) -> Result<Self> {
        let mut history = Self {
            forces: Vec::new(),
            resistances: Vec::new(),
            step: file.communication_step,
        };
        scene::each_step(file, |contact, _| {
            history.forces.push(contact.real(RealOutput::ContactForce));
            history.resistances.push(contact.real(RealOutput::ContactResistance));
            Ok(())
        })?;
        Ok(history)
    }

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
fn largest_difference(with: &[f64], without: &[f64]) -> f64 {
    let differences = with.iter().zip(without).map(|(with, without)| with - without);
    differences.fold(0.0, |largest, difference| largest.max(difference.abs()))
}
