//! The Python package with the component in it, as a wheel.

use std::path::Path;

use crate::commands::run as run_command;
use anyhow::Result;

use crate::{fmu, python};

/// Builds the component for this machine, and the wheel that carries it, in `dist/`.
pub fn run() -> Result<()> {
    python::prepare()?;
    build(&fmu::build()?, "dist")
}

/// Builds the wheel that carries a component, in a folder.
pub fn build(component: &Path, folder: &str) -> Result<()> {
    run_command(
        crate::commands::python()
            .args(["-m", "hatchling", "build", "-t", "wheel", "-d", folder])
            .env("RELAY_CONTACT_FMU", component),
    )
}
