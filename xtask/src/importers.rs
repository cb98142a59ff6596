//! The component in other people's importers: what they are to reproduce, and the table of what they did.
//!
//! [`prepare`] writes to `out/conformance` our own runs and a system of two contacts, and the scenes' parameter sets to
//! `out/ssv`; the tests under `conformance/` compare with them and each leave a row there; [`table`] prints the rows.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result, bail};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{RealOutput, Variable};
use serde::Deserialize;

use crate::commands::root;
use crate::package::{Files, pack};
use crate::{scene, ssv};

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
struct Row {
    importer: String,
    version: String,
    task: String,
    /// `passed`, or `not run: ` and why; what failed has failed its test before.
    result: String,
    /// Largest difference in the contact force from our own run, N, where forces were compared.
    difference: Option<f64>,
}

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

/// Prints the table. An error where a row is missing; a warning below the table where an importer did not run.
pub fn table() -> Result<()> {
    let mut rows = Vec::new();
    for entry in fs::read_dir(folder()).context("nothing was prepared")? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let row: Row = serde_json::from_slice(&fs::read(&path)?).with_context(|| path.display().to_string())?;
            rows.push(row);
        }
    }
    println!(
        "{:<12} {:<9} {:<17} {:<10} largest difference in force",
        "importer", "version", "task", "result"
    );
    let (mut missing, mut warnings) = (Vec::new(), Vec::new());
    for (importer, task) in EXPECTED {
        let Some(row) = rows.iter().find(|row| row.importer == importer && row.task == task) else {
            missing.push(format!("{importer} {task}"));
            continue;
        };
        let difference = match row.difference {
            Some(0.0) => "0 N".to_owned(),
            Some(force) => format!("{force:.1e} N"),
            None => "-".to_owned(),
        };
        let (result, _) = row.result.split_once(':').unwrap_or((&row.result, ""));
        println!("{importer:<12} {:<9} {task:<17} {result:<10} {difference}", row.version);
        if row.result != "passed" {
            warnings.push(format!("WARNING: {importer}, {task}: {}", row.result));
        }
    }
    for warning in warnings {
        println!("{warning}");
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
