//! Instructions, counted by valgrind's callgrind.

use std::env::consts::EXE_EXTENSION;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};
use commands::{cargo, command, output, root, run};

/// Said where valgrind is missing.
pub const MISSING: &str = "valgrind is missing (on Debian: apt-get install valgrind)";

/// Communication steps of the shorter of the two runs whose instructions are compared.
const STEPS: u32 = 5000;

/// Whether valgrind is there.
pub fn is_installed() -> bool {
    output(command("valgrind").arg("--version")).is_ok()
}

/// Prints the instructions of a communication step through C and in the library alone.
pub fn instructions() -> Result<()> {
    if !is_installed() {
        bail!(MISSING);
    }
    let folder = "target/portable";
    run(cargo()
        .args([
            "build",
            "--release",
            "--package=campaign",
            "--bin=steps",
            "--features=portable",
        ])
        .args(["--target-dir", folder]))?;
    let program = root().join(folder).join("release/steps").with_extension(EXE_EXTENSION);
    for scene in ["1us", "10us", "shaken"] {
        let through_c = per_step(&program, scene, "fmi2DoStep")?;
        let alone = per_step(&program, scene, "library")?;
        println!(
            "{scene}: {through_c:.0} instructions per fmi2DoStep, {alone:.0} per Simulation::step: {:+.2} %",
            100.0 * (through_c / alone - 1.0)
        );
    }
    Ok(())
}

/// Instructions of one step: the difference of two runs, so that all that is done once drops out.
fn per_step(program: &Path, scene: &str, way: &str) -> Result<f64> {
    let count = |steps: u32| count(program, |run| run.args([scene, way, &steps.to_string()]));
    Ok((count(2 * STEPS)? - count(STEPS)?) / f64::from(STEPS))
}

/// Instructions of a whole run of a program, with the arguments given to it.
pub fn count(program: &Path, arguments: impl FnOnce(&mut Command) -> &mut Command) -> Result<f64> {
    let mut valgrind = command("valgrind");
    valgrind
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program);
    let finished = arguments(&mut valgrind).output().context(MISSING)?;
    let told = String::from_utf8_lossy(&finished.stderr);
    if !finished.status.success() {
        bail!("{told}");
    }
    let count = told.lines().find_map(|line| line.split_once("Collected : "));
    let (_, count) = count.with_context(|| format!("callgrind told no count: {told}"))?;
    count.trim().parse().context("callgrind told no number")
}
