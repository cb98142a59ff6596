//! Instructions and nanoseconds that a simulated millisecond takes.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::commands::{cargo, command, output, root, run};
use crate::valgrind;

/// Simulated in a run, s.
pub const LENGTH: f64 = 0.1;

/// Runs of which the shortest is taken: what else the machine does only makes one longer.
pub const RUNS: usize = 15;

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

/// Builds of the example `run_scene` for any processor, whose instructions are counted.
pub struct Counter {
    with_all: PathBuf,
    /// Without the effects that reach into the steps of the integrator.
    bare: PathBuf,
}

impl Counter {
    /// Builds both.
    pub fn build() -> Result<Self> {
        Ok(Self {
            with_all: build("target/portable", &["--features=portable"])?,
            bare: build("target/bare", &["--features=bare"])?,
        })
    }

    /// Instructions per simulated millisecond of the minimal scene with changes, in both builds.
    pub fn both(&self, changes: &Changes) -> Result<(f64, f64)> {
        Ok((
            instructions(&self.with_all, changes)?,
            instructions(&self.bare, changes)?,
        ))
    }
}

/// Runs the usual build, and counts where it can.
pub struct Runner<'a> {
    usual: PathBuf,
    counter: Option<&'a Counter>,
}

impl<'a> Runner<'a> {
    /// Builds what is needed besides the counter.
    pub fn build(counter: Option<&'a Counter>) -> Result<Self> {
        Ok(Self {
            usual: build("target", &[])?,
            counter,
        })
    }

    /// Of the minimal scene with changes.
    pub fn cost(&self, changes: &Changes) -> Result<Cost> {
        let mut shortest = f64::INFINITY;
        for _ in 0..RUNS {
            shortest = shortest.min(nanoseconds(&self.usual, changes)?);
        }
        Ok(Cost {
            instructions: self
                .counter
                .map(|counter| instructions(&counter.with_all, changes))
                .transpose()?,
            nanoseconds: shortest,
        })
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
