//! The Python package with the component in it, as a wheel.

use std::path::Path;

use crate::commands::run as run_command;
use anyhow::Result;

use crate::{fmu, python};

/// Builds the component for this machine, and the wheel that carries it, in `dist/`.
pub fn run() -> Result<()> {
    python::prepare()?;
    build(&fmu::build()?, "dist", None)
}

/// Builds the wheel that carries a component, in a folder; `platform` is its tag, else this machine's.
pub fn build(component: &Path, folder: &str, platform: Option<&str>) -> Result<()> {
    let mut build = crate::commands::python();
    build
        .args(["-m", "hatchling", "build", "-t", "wheel", "-d", folder])
        .env("RELAY_CONTACT_FMU", component)
        .env_remove("RELAY_CONTACT_PLATFORM")
        .envs(platform.map(|tag| ("RELAY_CONTACT_PLATFORM", tag)));
    run_command(&mut build)
}
