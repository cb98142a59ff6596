//! What `cargo xtask accuracy` measured.

use std::fs;

use anyhow::{Context, Result};
use commands::root;
use serde::Deserialize;

/// A line of `accuracy.csv`.
#[derive(Deserialize)]
pub struct Row {
    /// Which part of the measurement: `delivered`, `peers` and others.
    pub part: String,
    pub scene: String,
    pub integrator: String,
    /// Tolerance, or length of the step in s.
    pub value: f64,
    pub modes: u32,
    pub seconds_per_second: Option<f64>,
    /// Of the contact force, relative to the preload force.
    pub force_error: Option<f64>,
    /// Of the instants of opening and closing, us.
    pub event_error_us: Option<f64>,
    /// Of what the force is compared with.
    pub reference_force_error: f64,
}

/// The rows of a folder, and where they were measured.
pub fn read(folder: &str) -> Result<(Vec<Row>, String)> {
    let folder = root().join(folder);
    let path = folder.join("accuracy.csv");
    let mut reader = csv::Reader::from_path(&path).with_context(|| path.display().to_string())?;
    let rows = reader.deserialize().collect::<Result<_, _>>();
    let page = fs::read_to_string(folder.join("accuracy.md"))?;
    let machine = page.lines().find(|line| line.starts_with("Measured on"));
    Ok((
        rows.with_context(|| path.display().to_string())?,
        machine.unwrap_or("Measured on an unknown machine.").to_owned(),
    ))
}
