//! Instructions and nanoseconds that a simulated millisecond takes.

use anyhow::Result;

use super::run_scene::{Changes, RunScene};

/// Simulated in a run, s.
pub const LENGTH: f64 = 0.1;

/// Communication step of the minimal scene, s: a run of one tells what is spent before the steps.
const STEP: f64 = 1e-5;

const SCENE: &str = "scenes/minimal.toml";

/// Per simulated millisecond.
#[derive(Clone, Copy)]
pub struct Cost {
    /// Where they are counted.
    pub instructions: Option<f64>,
    pub nanoseconds: f64,
}

/// Instructions per simulated millisecond of the minimal scene with changes, counted in a portable build.
pub fn instructions(portable: &RunScene, changes: &Changes) -> Result<f64> {
    let counted = |stop| portable.instructions(SCENE, &until(changes, stop));
    Ok((counted(LENGTH)? - counted(STEP)?) / (1e3 * (LENGTH - STEP)))
}

/// Nanoseconds per simulated millisecond of the minimal scene with changes, in the usual build.
pub fn nanoseconds(usual: &RunScene, changes: &Changes, runs: usize) -> Result<f64> {
    usual.nanoseconds(SCENE, &until(changes, LENGTH), runs)
}

fn until(changes: &Changes, stop: f64) -> Vec<(String, String)> {
    let stop = [("stop".to_owned(), stop.to_string())];
    changes.iter().cloned().chain(stop).collect()
}
