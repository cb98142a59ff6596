//! From nothing to the result: the published 1 kHz case under FMPy.

use anyhow::Result;

use crate::commands;
use crate::{fmu, python};

/// Builds the component, prepares Python, runs the case.
pub fn run() -> Result<()> {
    let path = fmu::build()?;
    python::prepare()?;
    commands::run(
        python::python()
            .arg("examples/python/paper_1khz.py")
            .arg("--fmu")
            .arg(path),
    )
}
