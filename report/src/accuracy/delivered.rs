//! What the component delivers at a tolerance: errors against a finer run of its own, and the time it takes.

use anyhow::{Context, Result};
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::{IntegerOutput, RealOutput};

use crate::effects::run_scene::RunScene;
use crate::{scene, threads};

/// Scenes, and what is changed in them.
pub const SCENES: [(&str, &[(&str, &str)]); 3] = [
    ("paper-1khz", &[]),
    ("chatter-41g", &[]),
    // A support that moves makes every communication step an integration step at least.
    ("closing-bounce", &[("communicationStep", "1e-5")]),
];

/// How a run is made: tolerance, number of modes (0: as the tolerance asks), longest integration step (s; 0: no limit).
type Fineness = (f64, i32, f64);

/// The run that the others are measured against, and one that shows its own error, with other modes and short steps. The
/// steps of the first are not limited: more of them have more rounding, which is felt just after a blow, where 1e-17 s
/// earlier or later are 1e-9 of the preload force.
const REFERENCES: [Fineness; 2] = [(1e-11, 34, 0.0), (1e-11, 30, 5e-7)];

/// What a run comes to.
struct Run {
    /// At the communication points, N.
    forces: Vec<f64>,
    /// Ohm.
    resistances: Vec<f64>,
    /// Openings and closings, s.
    events: Vec<f64>,
    /// Greatest force at any instant, N.
    greatest: f64,
    modes: i32,
    /// What the tolerance is relative to, N.
    scale: f64,
}

/// Differences from the finest run.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    /// Contact force, of what the tolerance is relative to.
    pub force: f64,
    /// Contact resistance, of itself.
    pub resistance: f64,
    /// Instants of openings and closings, s; infinite where there are more or fewer of them.
    pub instants: f64,
    /// Force of the hardest blow, of itself.
    pub blow: f64,
}

/// A scene at a tolerance.
pub struct Delivered {
    pub tolerance: f64,
    pub modes: i32,
    pub errors: Errors,
    /// Processor seconds for a simulated second.
    pub time: f64,
}

/// A scene at all tolerances.
pub struct Scene {
    pub name: &'static str,
    pub delivered: Vec<Delivered>,
    /// Error of what they are measured against.
    pub own_error: f64,
}

impl Scene {
    /// Those with a tolerance well above what the reference itself does not know.
    pub fn judged(&self) -> impl Iterator<Item = &Delivered> {
        let known = |delivered: &&Delivered| delivered.tolerance > 5.0 * self.own_error;
        self.delivered.iter().filter(known)
    }
}

/// All scenes at the tolerances. Errors first, on all cores; then times, one after the other, in the build for release.
pub fn measure(tolerances: &[f64], timings: usize) -> Result<Vec<Scene>> {
    let finenesses = || {
        let asked = tolerances.iter().map(|tolerance| (*tolerance, 0, 0.0));
        REFERENCES.into_iter().chain(asked)
    };
    let tasks: Vec<_> = SCENES
        .into_iter()
        .flat_map(|scene| finenesses().map(move |fineness| (scene, fineness)))
        .collect();
    let runs = threads::map(&tasks, |((name, changes), fineness)| run(name, changes, *fineness))?;
    let program = RunScene::build()?;
    let mut scenes = Vec::new();
    for ((name, changes), runs) in SCENES.into_iter().zip(runs.chunks(finenesses().count())) {
        let [finest, finer, runs @ ..] = runs else {
            continue;
        };
        let mut delivered = Vec::new();
        for (tolerance, run) in tolerances.iter().zip(runs) {
            let tolerance_asked = [("solver.tolerance", tolerance.to_string())];
            let fixed = changes.iter().map(|(name, value)| (*name, (*value).to_owned()));
            let output = [("outputs", "contact.force".to_owned())];
            let changes: Vec<_> = fixed
                .chain(tolerance_asked)
                .chain(output)
                .map(|(name, value)| (name.to_owned(), value))
                .collect();
            // Nanoseconds per millisecond.
            let time = 1e-6 * program.nanoseconds(&format!("scenes/{name}.toml"), &changes, timings)?;
            delivered.push(Delivered {
                tolerance: *tolerance,
                modes: run.modes,
                errors: run.errors(finest),
                time,
            });
        }
        scenes.push(Scene {
            name,
            delivered,
            own_error: finer.errors(finest).force,
        });
    }
    Ok(scenes)
}

fn run(name: &str, changes: &[(&str, &str)], (tolerance, modes, longest): Fineness) -> Result<Run> {
    let mut file: SceneFile = scene::read(name)?;
    for (name, value) in changes {
        file.set(name, value)?;
    }
    file.scene.solver.tolerance = tolerance;
    file.scene.solver.modes = modes;
    file.scene.solver.maximum_step = longest;
    let mut contact = scene::start(&file)?;
    let mut run = Run {
        forces: Vec::new(),
        resistances: Vec::new(),
        events: Vec::new(),
        greatest: 0.0,
        modes: contact.integer(IntegerOutput::SolverModesUsed),
        scale: contact.model().force_scale,
    };
    for (time, size) in file.steps() {
        contact
            .step(&file.inputs_over(time, size)?, time, size)
            .with_context(|| format!("{name} at tolerance {tolerance}"))?;
        run.forces.push(contact.real(RealOutput::ContactForce));
        run.resistances.push(contact.real(RealOutput::ContactResistance));
        run.events.extend(contact.events().0.map(|event| event.time));
        run.greatest = run.greatest.max(contact.real(RealOutput::StepMaximumForce));
    }
    Ok(run)
}

impl Run {
    fn errors(&self, finest: &Self) -> Errors {
        let greatest = |differences: &mut dyn Iterator<Item = f64>| differences.fold(0.0, f64::max);
        let pairs = |own: &'_ [f64], other: &'_ [f64]| -> Vec<(f64, f64)> {
            own.iter().copied().zip(other.iter().copied()).collect()
        };
        let absolute =
            |own: &[f64], other: &[f64]| greatest(&mut pairs(own, other).into_iter().map(|(a, b)| (a - b).abs()));
        let resistances = pairs(&self.resistances, &finest.resistances);
        Errors {
            force: absolute(&self.forces, &finest.forces) / self.scale,
            resistance: greatest(&mut resistances.into_iter().map(|(a, b)| (a / b - 1.0).abs())),
            instants: if self.events.len() == finest.events.len() {
                absolute(&self.events, &finest.events)
            } else {
                f64::INFINITY
            },
            blow: (self.greatest / finest.greatest - 1.0).abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_the_runs() -> Result<()> {
        let (name, changes) = ("chatter-41g", &[("stop", "0.0015")]);
        let finest = run(name, changes, (1e-10, 30, 1e-6))?;
        let coarse = run(name, changes, (1e-3, 0, 0.0))?;
        let errors = coarse.errors(&finest);
        assert_eq!(finest.events.len(), 2, "it opens and closes once");
        assert!(errors.force > 0.0 && errors.force < 1e-3, "{errors:?}");
        assert!(errors.instants < 1e-9 && errors.blow < 1e-3, "{errors:?}");
        assert_eq!(finest.errors(&finest).force, 0.0);
        Ok(())
    }
}
