//! The component in other people's importers.
//!
//! [`prepare`] writes to `out/conformance` our own runs and a system of two contacts, and the scenes' parameter sets to
//! `out/ssv`; the tests under `conformance/` compare with them and each leave a row there; [`table`] prints the rows.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result};

use crate::commands::{self, root};
use crate::package::{Files, pack};
use crate::{fmu, python, report};

/// Tests in `conformance/python` that leave rows; the others compare with numbers of their own.
const PYTHON: [&str; 6] = [
    "test_ecos.py",
    "test_fmpy.py",
    "test_libcosim.py",
    "test_scenes.py",
    "test_state.py",
    "test_validate.py",
];

fn folder() -> PathBuf {
    root().join("out/conformance")
}

/// Writes our own runs and the system of two contacts, and clears the table.
pub fn prepare(component: &Path) -> Result<()> {
    match fs::remove_dir_all(folder()) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error).context("cannot clear the table"),
        _ => fs::create_dir_all(folder())?,
    }
    report::start("reference-runs", [""; 0])?;
    let system = Files::from([
        (
            "SystemStructure.ssd".to_owned(),
            fs::read(root().join("conformance/SystemStructure.ssd"))?,
        ),
        ("resources/RelayContact.fmu".to_owned(), fs::read(component)?),
    ]);
    fs::write(folder().join("two-contacts.ssp"), pack(&system)?)?;
    Ok(())
}

/// Runs the importers that are called from Python, those alone that leave rows.
pub fn run_python() -> Result<()> {
    let component = fmu::build()?;
    python::prepare()?;
    prepare(&component)?;
    let tests = PYTHON.map(|name| format!("conformance/python/{name}"));
    commands::output(
        python::python()
            .args(["-m", "pytest", "--quiet"])
            .args(tests)
            .env("RELAY_CONTACT_FMU", component),
    )?;
    Ok(())
}

/// Prints the table of what the importers did; an error where a row is missing.
pub fn table() -> Result<()> {
    report::start("importers", [""; 0])
}
