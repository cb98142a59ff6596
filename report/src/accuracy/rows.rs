//! What `cargo xtask accuracy` measured.

use anyhow::{Context, Result};
use commands::root;
use serde::Deserialize;

/// A line of `accuracy.csv`.
#[derive(Deserialize)]
pub struct Row {
    /// Which part of the measurement: `delivered`, `peers`, `modes` and others.
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
    /// Of what the force and the instants are compared with.
    pub reference_force_error: f64,
    pub reference_event_error_us: f64,
}

/// A line of `promise.csv`: a random relay.
#[derive(Deserialize)]
pub struct Relay {
    pub opens: bool,
    pub tolerance: f64,
    pub error: f64,
    pub outcome: String,
}

/// The rows of `accuracy.csv` in a folder.
pub fn read(folder: &str) -> Result<Vec<Row>> {
    table(&format!("{folder}/accuracy.csv"))
}

/// The random relays.
pub fn relays() -> Result<Vec<Relay>> {
    table("docs/promise.csv")
}

fn table<T: for<'a> Deserialize<'a>>(name: &str) -> Result<Vec<T>> {
    let path = root().join(name);
    let mut reader = csv::Reader::from_path(&path).with_context(|| path.display().to_string())?;
    let rows = reader.deserialize().collect::<Result<_, _>>();
    rows.with_context(|| path.display().to_string())
}

/// The rows of a part and a scene.
pub fn of<'a>(rows: &'a [Row], part: &'a str, scene: &'a str) -> impl Iterator<Item = &'a Row> {
    rows.iter().filter(move |row| row.part == part && row.scene == scene)
}
