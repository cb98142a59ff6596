//! The published 1 kHz case in FMPy, including all preparation.

use anyhow::Result;

use crate::{fmu, python};

/// Prepares Python, builds the component, runs the case.
pub fn run() -> Result<()> {
    // Python first, so that missing programs are reported before the build.
    python::prepare()?;
    let path = fmu::build()?;
    crate::commands::run(
        crate::commands::python()
            .arg("examples/python/paper_1khz.py")
            .arg("--fmu")
            .arg(path),
    )
}
