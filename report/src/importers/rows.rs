//! What the importers did: one file for each task, left by the tests under `conformance/`.

use std::path::PathBuf;
use std::time::SystemTime;
use std::{fs, io};

use anyhow::{Context, Result, bail};
use commands::root;
use serde::Deserialize;

/// Where the tests leave their rows.
pub fn folder() -> PathBuf {
    root().join("out/conformance")
}

/// Every row that the table has to have.
const EXPECTED: [(&str, &str); 12] = [
    ("FMPy", "validation"),
    ("FMPy", "run"),
    ("FMPy", "saved states"),
    ("FMPy", "SSP description"),
    ("FMPy", "scenes"),
    ("libcosim", "run"),
    ("libcosim", "two coupled"),
    ("libcosim", "SSP"),
    ("Ecos", "run"),
    ("Ecos", "two coupled"),
    ("Ecos", "SSP"),
    ("fmi (Rust)", "run"),
];

/// What became of one task of an importer.
#[derive(Deserialize)]
pub struct Row {
    pub importer: String,
    pub version: String,
    pub task: String,
    /// `passed`, or `not run: ` and why; what failed has failed its test before.
    pub result: String,
    /// Largest difference in the contact force from our own run, N, where forces were compared.
    pub difference: Option<f64>,
}

impl Row {
    /// The difference in words.
    pub fn difference(&self) -> String {
        match self.difference {
            Some(0.0) => "0 N".to_owned(),
            Some(force) => format!("{force:.1e} N"),
            None => "-".to_owned(),
        }
    }
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

/// Prints the table. An error where a row is missing; a warning below the table where an importer did not run.
pub fn table() -> Result<()> {
    let (rows, missing) = rows()?;
    println!(
        "{:<12} {:<9} {:<17} {:<10} largest difference in force",
        "importer", "version", "task", "result"
    );
    for row in &rows {
        let (result, _) = row.result.split_once(':').unwrap_or((&row.result, ""));
        println!(
            "{:<12} {:<9} {:<17} {result:<10} {}",
            row.importer,
            row.version,
            row.task,
            row.difference()
        );
    }
    for row in rows.iter().filter(|row| row.result != "passed") {
        println!("WARNING: {}, {}: {}", row.importer, row.task, row.result);
    }
    if !missing.is_empty() {
        bail!("no result of {}", missing.join(", "));
    }
    Ok(())
}
