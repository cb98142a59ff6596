//! The report and the pages of `docs/` that are computed: written by the Python package `report`, from tables that Rust
//! programs write.

use std::ffi::OsString;

use anyhow::Result;

use crate::commands::{cargo, is_there, run as run_command};
use crate::{fmu, importers, python};

/// The message where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// Arguments passed on.
#[derive(clap::Args)]
pub struct Arguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

impl Arguments {
    /// Whether one of these is among them.
    fn has(&self, names: &[&str]) -> bool {
        let known = |argument: &OsString| names.iter().any(|name| argument == name);
        self.arguments.iter().any(known)
    }
}

/// Everything that the report shows, and the report; with `--quick` importers do not run anew.
pub fn run(arguments: &Arguments) -> Result<()> {
    python::prepare()?;
    if !arguments.has(&["--help", "-h"]) {
        let component = fmu::build()?;
        if !arguments.has(&["--quick"]) {
            importers::for_report(&component)?;
        }
        // Leaves what was measured for the report; fails where a property is not kept.
        run_command(cargo().args(["test", "--quiet", "--package=hard-cases", "--test=cases"]))?;
    }
    python::report("report", &arguments.arguments)
}

/// A task of the package `report` that runs the component.
pub fn with_component(task: &str) -> Result<()> {
    python::prepare()?;
    fmu::build()?;
    python::report(task, &[])
}

/// Measures time over accuracy and what instances cost, and writes tables and figures of `docs/accuracy.md`.
pub fn accuracy(arguments: &Arguments) -> Result<()> {
    let mut run = cargo();
    run.args(["run", "--release", "--package=benches", "--bin=accuracy"])
        // Its own, as the library is built here with other features.
        .args(["--target-dir=target/benches", "--"]);
    run_command(run.args(&arguments.arguments))?;
    if arguments.has(&["--quick", "--help", "-h"]) {
        return Ok(());
    }
    with_component("accuracy")
}

/// Whether Chromium is installed, by one of its names.
pub fn has_chromium() -> bool {
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"].into_iter().any(is_there)
}
