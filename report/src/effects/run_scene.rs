//! The example `run_scene`, built for release: time and instructions of scenes, as users get them.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result};
use commands::{cargo, command, output, root, run};

use super::callgrind;

/// Names of variables and their values.
pub type Changes = [(String, String)];

/// A build of it.
pub struct RunScene(PathBuf);

impl RunScene {
    /// The usual one.
    pub fn build() -> Result<Self> {
        Self::build_in("target/run_scene", &[])
    }

    /// For any processor.
    pub fn build_portable() -> Result<Self> {
        Self::build_in("target/portable", &["--features=portable"])
    }

    /// With features, in a target folder of its own: the file of the library has the same name in all builds, and in one
    /// folder each would build over the others.
    fn build_in(target: &str, features: &[&str]) -> Result<Self> {
        let folder = root().join(target);
        run(cargo()
            .args(["build", "--release", "--package=relay-contact", "--example=run_scene"])
            .arg("--target-dir")
            .arg(&folder)
            .args(features))?;
        Ok(Self(
            folder
                .join("release/examples/run_scene")
                .with_extension(std::env::consts::EXE_EXTENSION),
        ))
    }

    /// Nanoseconds per simulated millisecond of a scene file with changes: the shortest of some runs, as what else the
    /// machine does only makes one longer.
    pub fn nanoseconds(&self, scene: &str, changes: &Changes, runs: usize) -> Result<f64> {
        let mut shortest = f64::INFINITY;
        for _ in 0..runs {
            let printed = output(arguments(&mut command(&self.0), scene, changes))?;
            let words = printed
                .lines()
                .find_map(|line| line.strip_suffix(" ns per simulated millisecond"));
            let time: f64 = words
                .context("run_scene told no time")?
                .parse()
                .context("run_scene told no time")?;
            shortest = shortest.min(time);
        }
        Ok(shortest)
    }

    /// Instructions of a whole run of a scene file with changes.
    pub fn instructions(&self, scene: &str, changes: &Changes) -> Result<f64> {
        callgrind::count(&self.0, |run| arguments(run, scene, changes))
    }
}

fn arguments<'a>(command: &'a mut Command, scene: &str, changes: &Changes) -> &'a mut Command {
    let changes = changes.iter().map(|(name, value)| format!("{name}={value}"));
    command.arg(scene).args(changes)
}
