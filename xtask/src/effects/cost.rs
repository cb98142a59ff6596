//! Instructions and nanoseconds that a simulated millisecond takes.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::commands::{cargo, command, output, root, run};
use crate::valgrind;

/// Simulated in a run, s.
pub const LENGTH: f64 = 0.1;

/// Runs whose median time is taken.
pub const RUNS: usize = 9;

/// Communication step of the minimal scene, s: a run of one tells what is spent before the steps.
const STEP: f64 = 1e-5;

type Changes = [(String, String)];

/// Per simulated millisecond.
#[derive(Clone, Copy)]
pub struct Cost {
    /// Where they are counted.
    pub instructions: Option<f64>,
    pub nanoseconds: f64,
}

/// Builds of the example `run_scene`.
pub struct Runner {
    usual: PathBuf,
    /// For any processor, with all effects and without those that may be off.
    counted: Option<(PathBuf, PathBuf)>,
}

impl Runner {
    /// Builds what is needed, for counting too if asked for.
    pub fn build(counted: bool) -> Result<Self> {
        let counted = if counted {
            Some((
                build("target/portable", &["--features=portable"])?,
                build("target/bare", &["--features=bare"])?,
            ))
        } else {
            None
        };
        Ok(Self {
            usual: build("target", &[])?,
            counted,
        })
    }

    /// Of the minimal scene with changes.
    pub fn cost(&self, changes: &Changes) -> Result<Cost> {
        let counted = self.counted.as_ref();
        let mut times = (0..RUNS)
            .map(|_| nanoseconds(&self.usual, changes))
            .collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(Cost {
            instructions: counted.map(|(with, _)| instructions(with, changes)).transpose()?,
            nanoseconds: times.get(RUNS / 2).copied().unwrap_or(f64::NAN),
        })
    }

    /// Instructions of the minimal scene with changes, in a build with all effects and in one without those that may be off.
    pub fn with_and_without(&self, changes: &Changes) -> Result<(f64, f64)> {
        let (with, without) = self.counted.as_ref().context(valgrind::MISSING)?;
        Ok((instructions(with, changes)?, instructions(without, changes)?))
    }
}

fn build(target: &str, features: &[&str]) -> Result<PathBuf> {
    // A folder of its own, so that the library of `cargo xtask fmu` is not built over.
    let folder = root().join(target);
    run(cargo()
        .args(["build", "--release", "--package=relay-contact", "--example=run_scene"])
        .arg("--target-dir")
        .arg(&folder)
        .args(features))?;
    Ok(folder
        .join("release/examples/run_scene")
        .with_extension(std::env::consts::EXE_EXTENSION))
}

fn nanoseconds(runner: &Path, changes: &Changes) -> Result<f64> {
    let printed = output(arguments(&mut command(runner), changes, LENGTH))?;
    let words = printed
        .lines()
        .find_map(|line| line.strip_suffix(" ns per simulated millisecond"));
    words
        .context("run_scene told no time")?
        .parse()
        .context("run_scene told no time")
}

fn instructions(runner: &Path, changes: &Changes) -> Result<f64> {
    let counted = |stop| valgrind::count(runner, |run| arguments(run, changes, stop));
    Ok((counted(LENGTH)? - counted(STEP)?) / (1e3 * (LENGTH - STEP)))
}

fn arguments<'a>(command: &'a mut Command, changes: &Changes, stop: f64) -> &'a mut Command {
    command
        .arg("scenes/minimal.toml")
        .args(changes.iter().map(|(name, value)| format!("{name}={value}")))
        .arg(format!("stop={stop}"))
}
