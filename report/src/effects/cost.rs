//! Instructions of the minimal scene with changes, per simulated millisecond.

use std::path::PathBuf;

use anyhow::Result;

use super::callgrind;

/// Simulated in a run, s.
pub const LENGTH: f64 = 0.1;

/// Communication step of the minimal scene, s: a run of one has the instructions spent before the steps.
const STEP: f64 = 1e-5;

/// The example `run_scene`.
pub struct RunScene(PathBuf);

impl RunScene {
    /// Builds it.
    pub fn build() -> Result<Self> {
        let which = ["--package=relay-contact", "--example=run_scene"];
        callgrind::build(which, "examples/run_scene").map(Self)
    }

    /// Instructions per simulated millisecond with names of variables and their values.
    pub fn instructions(&self, changes: &[(String, String)]) -> Result<f64> {
        let changes = changes.iter().map(|(name, value)| format!("{name}={value}"));
        let changes: Vec<_> = changes.collect();
        let counted = |stop: f64| {
            let stop = format!("stop={stop}");
            callgrind::count(&self.0, |run| run.arg("scenes/minimal.toml").args(&changes).arg(stop))
        };
        Ok((counted(LENGTH)? - counted(STEP)?) / (1e3 * (LENGTH - STEP)))
    }
}
