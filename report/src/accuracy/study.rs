//! What accuracy costs: starts the measurement.

use std::process::Command;

use anyhow::Result;
use commands::cargo;

/// How much is measured.
#[derive(clap::Args)]
pub struct Arguments {
    /// Few settings, once each, into out/accuracy: to see that everything works
    #[arg(long)]
    quick: bool,
}

/// Measures into `docs/accuracy.csv` and the tables of `docs/accuracy.md`.
pub fn run(arguments: &Arguments) -> Result<()> {
    let folder = if arguments.quick { "out/accuracy" } else { "docs" };
    let quick = arguments.quick.then_some("--quick");
    commands::run(measurement().args(["--folder", folder]).args(quick))
}

/// The program that measures, to be given its arguments.
pub fn measurement() -> Command {
    let mut run = cargo();
    run.args(["run", "--release", "--package=benches", "--bin=accuracy"])
        // Its own, as the library is built here with other features.
        .args(["--target-dir=target/benches", "--"]);
    run
}
