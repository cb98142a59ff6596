//! What the importers did: one file for each task, left by the tests under `conformance/`.

use std::path::PathBuf;
use std::time::SystemTime;
use std::{fs, io};

use anyhow::{Context, Result};
use commands::root;
use serde::Deserialize;

/// Where the tests leave their rows.
pub fn folder() -> PathBuf {
    root().join("out/conformance")
}

/// Every row that the table has to have.
const EXPECTED: [(&str, &str); 21] = [
    ("FMPy", "validation"),
    ("FMPy", "run"),
    ("FMPy", "published run"),
    ("FMPy", "saved states"),
    ("FMPy", "SSP description"),
    ("FMPy", "scenes"),
    ("libcosim", "run"),
    ("libcosim", "published run"),
    ("libcosim", "two coupled"),
    ("libcosim", "SSP"),
    ("Ecos", "run"),
    ("Ecos", "published run"),
    ("Ecos", "two coupled"),
    ("Ecos", "SSP"),
    ("FMU container", "run"),
    ("FMU container", "run as FMI 3"),
    ("FMU container", "two coupled"),
    ("fmi (Rust)", "run"),
    ("fmi (Rust)", "published run"),
    ("fmi-rs (Rust)", "run"),
    ("fmi-rs (Rust)", "published run"),
];

/// What became of one task of an importer.
#[derive(Deserialize)]
pub struct Row {
    pub importer: String,
    pub version: String,
    pub task: String,
    /// `passed`, or `not run: ` and why; what failed has failed its test before.
    pub result: String,
    /// Largest difference in the contact force from the run of the Rust library, N, where forces were compared.
    pub difference: Option<f64>,
}

/// The rows that are there, of those the table has to have, and those that are not: importer and task.
pub fn rows() -> Result<(Vec<Row>, Vec<String>)> {
    let mut found = Vec::new();
    let entries = match fs::read_dir(folder()) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        entries => Some(entries?),
    };
    for entry in entries.into_iter().flatten() {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let row: Row = serde_json::from_slice(&fs::read(&path)?).with_context(|| path.display().to_string())?;
            found.push(row);
        }
    }
    let (mut rows, mut missing) = (Vec::new(), Vec::new());
    for (importer, task) in EXPECTED {
        let position = found
            .iter()
            .position(|row| row.importer == importer && row.task == task);
        match position {
            Some(position) => rows.push(found.swap_remove(position)),
            None => missing.push(format!("{importer} {task}")),
        }
    }
    Ok((rows, missing))
}

/// When the runs to reproduce were written, just before the rows.
pub fn prepared() -> Result<SystemTime> {
    Ok(fs::metadata(folder().join("reference.csv"))?.modified()?)
}
