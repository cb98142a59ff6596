//! The report and the pages of `docs/` that are computed: written by the Python package `report`, from tables that Rust
//! programs write.

use std::iter;

use anyhow::Result;

use crate::commands::{LINT, cargo, is_there, run as run_command};
use crate::{fmu, importers, python};

/// The message where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// Everything that the report shows, and the report; quick: importers do not run anew.
pub fn run(quick: bool, fit: bool) -> Result<()> {
    python::prepare()?;
    let component = fmu::build()?;
    if !quick {
        importers::for_report(&component)?;
    }
    // Leaves what was measured for the report; fails where a property is not kept.
    run_command(cargo().args(["test", "--quiet", "--package=hard-cases", "--test=cases"]))?;
    let options = [(quick, "--quick"), (fit, "--fit")].into_iter().filter_map(|(on, name)| on.then_some(name));
    python::report(&iter::once("report").chain(options).collect::<Vec<_>>())
}

/// A task of the package `report` that runs the component.
pub fn with_component(task: &str) -> Result<()> {
    python::prepare()?;
    fmu::build()?;
    python::report(&[task])
}

/// Measures time over accuracy and what instances cost, and writes tables and figures of `docs/accuracy.md`.
pub fn accuracy(quick: bool) -> Result<()> {
    // The target folder is its own, as the library is built here with other features.
    let benches = ["--package=benches", "--features=diffsol", "--target-dir=target/benches"];
    // The comparison with diffsol and its sixty packages are compiled nowhere else.
    run_command(cargo().arg("clippy").args(benches).args(LINT))?;
    let mut run = cargo();
    run.args(["run", "--release", "--bin=accuracy"]).args(benches).arg("--");
    if quick {
        return run_command(run.arg("--quick"));
    }
    run_command(&mut run)?;
    with_component("accuracy")
}

/// Whether Chromium is installed, by one of its names.
pub fn has_chromium() -> bool {
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"].into_iter().any(is_there)
}
