//! The component in other importers.
//!
//! [`prepare`] writes reference runs and a system of two contacts to `out/conformance`; the tests under `conformance/` compare
//! with them and each write a row of the table of results there.

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::commands::{cargo, command, output, read, root, run as run_command, stage, write};
use anyhow::{Context, Result};

use crate::package::{Files, pack};
use crate::variant::Variant;
use crate::{fmu, python, reference};

const FOLDER: &str = "out/conformance";

/// Tests of the importers that are called from Python.
const PYTHON: &str = "conformance/python";

/// Builds the component and tests it in all importers.
pub fn run() -> Result<()> {
    let component = fmu::build()?;
    python::prepare()?;
    stages(&component)
}

/// The component in all importers, and the table of results.
pub fn stages(component: &Path) -> Result<()> {
    stage("reference runs", || prepare(component))?;
    stage("Python importers", || python::test(&[PYTHON], component))?;
    stage("Rust importer", || {
        let mut test = workspace("test")?;
        run_command(test.arg("--test=importers").env("RELAY_CONTACT_FMU", component))
    })?;
    stage("importers", || python::report(&["importers"]))
}

/// The rows shown in the full report: importers called from Python.
pub fn for_report(component: &Path) -> Result<()> {
    prepare(component)?;
    python::test(&[PYTHON], component)
}

/// Writes the reference runs, the system of two contacts and variants of the component; clears the table.
fn prepare(component: &Path) -> Result<()> {
    let folder = root().join(FOLDER);
    if folder.exists() {
        fs::remove_dir_all(&folder).context("cannot clear the table of results")?;
    }
    fmu::build_variant(&Variant::new(true, None)?)?;
    fmu::build_variant(&Variant::new(false, Some(&root().join("scenes/springs/tapered-cube.toml")))?)?;
    reference::write(FOLDER)?;
    let description = "SystemStructure.ssd";
    let system = Files::from([
        (description.to_owned(), read(format!("conformance/{description}"))?),
        ("resources/RelayContact.fmu".to_owned(), read(component)?),
    ]);
    write(format!("{FOLDER}/two-contacts.ssp"), &pack(&system)?)?;
    Ok(())
}

/// Cargo's command for all packages. The selection is the same for each subcommand: with another one cargo chooses other
/// features of what others wrote, and compiles much of it again. The build of the FMI bindings in `conformance` needs
/// libclang, and the C compiler's own headers (`stddef.h`), which the libclang of `.venv` lacks.
pub fn workspace(subcommand: &str) -> Result<Command> {
    let mut include = OsString::new();
    if cfg!(unix) {
        let folder = output(command("cc").arg("-print-file-name=include"))?;
        include.push(format!("-I{}", folder.trim()));
    }
    let mut cargo = cargo();
    cargo
        .args([subcommand, "--workspace"])
        .env("LIBCLANG_PATH", python::libclang()?)
        .env("BINDGEN_EXTRA_CLANG_ARGS", include);
    Ok(cargo)
}
