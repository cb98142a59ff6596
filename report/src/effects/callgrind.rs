//! Instructions, counted by valgrind's callgrind.

use std::env::consts::EXE_EXTENSION;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use commands::{cargo, command, root, run};

/// Said where valgrind is missing.
const MISSING: &str = "valgrind is missing (on Debian: apt-get install valgrind)";

/// Communication steps of the shorter of the two runs whose instructions are compared.
const STEPS: u32 = 5000;

/// Prints the instructions of a communication step through C and in the library alone.
pub fn print_steps() -> Result<()> {
    let program = build(["--package=campaign", "--bin=steps"], "steps")?;
    for scene in ["1us", "10us", "shaken", "sampled", "random"] {
        let through_c = per_step(&program, scene, "fmi2DoStep")?;
        let alone = per_step(&program, scene, "library")?;
        println!(
            "{scene}: {through_c:.0} instructions per fmi2DoStep, {alone:.0} per Simulation::step: {:+.2} %",
            100.0 * (through_c / alone - 1.0)
        );
    }
    Ok(())
}

/// Builds a program for any processor, as valgrind does not know all instructions of this one, in a target folder of its own:
/// the file of the library has the same name in all builds.
pub fn build(which: [&str; 2], name: &str) -> Result<PathBuf> {
    let folder = "target/portable";
    let mut cargo = cargo();
    cargo.args(["build", "--release", "--features=portable", "--target-dir", folder]);
    run(cargo.args(which))?;
    let program = root().join(folder).join("release").join(name);
    Ok(program.with_extension(EXE_EXTENSION))
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
    let printed = String::from_utf8_lossy(&finished.stderr);
    if !finished.status.success() {
        bail!("{printed}");
    }
    let count = printed.lines().find_map(|line| line.split_once("Collected : "));
    let (_, count) = count.with_context(|| format!("callgrind printed no count: {printed}"))?;
    count.trim().parse().context("callgrind printed no number")
}
