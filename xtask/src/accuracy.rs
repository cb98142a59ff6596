//! What accuracy costs: measures, then draws the figures of `docs/accuracy.md`.

use anyhow::Result;

use crate::commands::{self, cargo};
use crate::python;

/// How much is measured.
#[derive(clap::Args)]
pub struct Arguments {
    /// Few settings, once each, into out/accuracy: to see that everything works
    #[arg(long)]
    quick: bool,
}

/// Measures into `docs/accuracy.csv` and the tables of `docs/accuracy.md`, and draws.
pub fn run(arguments: &Arguments) -> Result<()> {
    python::prepare()?;
    let folder = if arguments.quick { "out/accuracy" } else { "docs" };
    let quick = arguments.quick.then_some("--quick");
    commands::run(
        cargo()
            .args(["run", "--release", "--package=benches", "--bin=accuracy", "--"])
            .args(["--folder", folder])
            .args(quick),
    )?;
    commands::run(python::python().args(["docs/accuracy.py", folder]))
}
