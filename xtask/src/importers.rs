//! The component in other people's importers: what they are to reproduce, and the table of what they did.
//!
//! [`prepare`] writes to `out/conformance` our own runs and a system of two contacts, and the scenes' parameter sets to
//! `out/ssv`; the tests under `conformance/` compare with them and each leave a row there; [`table`] prints the rows.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{fs, io};

use anyhow::{Context, Result, bail};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{RealOutput, Variable};
use serde::Deserialize;

use crate::commands::{self, root};
use crate::package::{Files, pack};
use crate::{fmu, python, scene, ssv};

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

const STEP: f64 = 1e-5;
const STEPS: u32 = 500;
const TOLERANCE: f64 = 1e-7;
/// Amplitude, m/s2, at which the contact opens and closes, and frequency, Hz.
const SINE: (f64, f64) = (400.0, 1000.0);
/// The frame's acceleration in `SystemStructure.ssd`, m/s2.
const JUMP: f64 = 50.0;

/// Writes our own runs and the system of two contacts, and clears the table.
pub fn prepare(component: &Path) -> Result<()> {
    match fs::remove_dir_all(folder()) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error).context("cannot clear the table"),
        _ => fs::create_dir_all(folder())?,
    }
    fs::write(folder().join("reference.csv"), reference()?)?;
    ssv::write()?;
    scenes()?;
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

/// Runs every scene, its contact force to `scenes/<name>.csv`.
fn scenes() -> Result<()> {
    let folder = folder().join("scenes");
    fs::create_dir_all(&folder)?;
    let force = Variable::by_name("contact.force").context("no contact force")?;
    for (name, mut file) in scene::all()? {
        file.outputs = vec![force];
        scene::simulate(&file, &folder.join(format!("{name}.csv")))?;
    }
    Ok(())
}

/// For each communication point the acceleration over the step that begins there, and the contact forces of both runs.
///
/// Importers reckon time differently: `n h`, a sum of steps, whole nanoseconds. That makes no difference to the first run:
/// a length of step that differs from the last by the rounding of time counts as the same.
fn reference() -> Result<String> {
    let mut table = "time,base.acceleration,run,coupled".to_owned();
    let (single, coupled) = (single()?, coupled()?);
    for (n, (single, coupled)) in (0..=STEPS).zip(single.iter().zip(coupled)) {
        write!(table, "\n{},{},{single},{coupled}", time(n), acceleration(n))?;
    }
    Ok(table + "\n")
}

fn time(n: u32) -> f64 {
    f64::from(n) * STEP
}

fn acceleration(n: u32) -> f64 {
    SINE.0 * (TAU * SINE.1 * time(n)).sin()
}

fn scene() -> Scene {
    let mut scene = Scene::default();
    scene.solver.tolerance = TOLERANCE;
    scene
}

/// Contact forces, N, of one contact, its frame's acceleration a sine held from each communication point to the next.
fn single() -> Result<Vec<f64>> {
    let mut inputs = Inputs::default();
    let mut contact = Simulation::new(&scene(), &inputs, 0.0)?;
    let mut forces = vec![contact.real(RealOutput::ContactForce)];
    for n in 0..STEPS {
        inputs.base_acceleration = acceleration(n);
        contact.step(&inputs, time(n), STEP)?;
        forces.push(contact.real(RealOutput::ContactForce));
    }
    Ok(forces)
}

/// Contact forces, N, of the second of the two contacts of `SystemStructure.ssd`. Both step from the same communication
/// point; what the first reached there is what the second gets.
fn coupled() -> Result<Vec<f64>> {
    let jump = Inputs {
        base_acceleration: JUMP,
        ..Inputs::default()
    };
    let mut first = Simulation::new(&scene(), &jump, 0.0)?;
    let carried = |first: &Simulation| Inputs {
        support_displacement: first.real(RealOutput::TipDisplacement),
        ..jump
    };
    let mut second = Simulation::new(&scene(), &carried(&first), 0.0)?;
    let mut forces = vec![second.real(RealOutput::ContactForce)];
    for n in 0..STEPS {
        second.step(&carried(&first), time(n), STEP)?;
        first.step(&jump, time(n), STEP)?;
        forces.push(second.real(RealOutput::ContactForce));
    }
    Ok(forces)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_the_runs_to_reproduce_something_happens() -> Result<()> {
        let (single, second) = (single()?, coupled()?);
        let opened = single
            .iter()
            .position(|force| *force == 0.0)
            .context("it never opens")?;
        assert!(
            single.iter().skip(opened).any(|force| *force > 0.152),
            "it never closes again"
        );
        // Carried by the deflected spring of the first, the second is pressed twice as far, and vibrates.
        let start = second.first().copied().unwrap_or_default();
        assert!((start / 0.152 - 2.0).abs() < 0.01, "{start} N");
        assert!(second.iter().any(|force| (force - start).abs() > 0.01));
        Ok(())
    }
}
