//! From nothing to the result: the published 1 kHz case under FMPy.

use anyhow::Result;

use crate::{fmu, python};

/// Prepares Python, builds the component, runs the case.
pub fn run() -> Result<()> {
    // Python first: what is missing is reported before anything long starts.
    python::prepare()?;
    let path = fmu::build()?;
    commands::run(
        commands::python()
            .arg("examples/python/paper_1khz.py")
            .arg("--fmu")
            .arg(path),
    )
}
