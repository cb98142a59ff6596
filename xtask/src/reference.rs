//! The runs that importers reproduce, by the Rust library: `out/conformance/reference.csv`, and every scene.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::commands::{root, write as write_file};
use anyhow::{Context, Result, ensure};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;

/// Communication step, s.
const STEP: f64 = 1e-5;
/// Communication steps.
const STEPS: u32 = 500;
const TOLERANCE: f64 = 1e-7;
/// Amplitude, m/s2, at which the contact opens and closes, and frequency, Hz.
const SINE: (f64, f64) = (400.0, 1000.0);
/// The frame's acceleration in `SystemStructure.ssd`, m/s2.
const JUMP: f64 = 50.0;

/// Writes all of them.
pub fn write(folder: &str) -> Result<()> {
    write_file(format!("{folder}/reference.csv"), reference()?)?;
    for entry in fs::read_dir(root().join("scenes"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            let table = scene(&path).with_context(|| name.clone().into_owned())?;
            write_file(format!("{folder}/scenes/{name}.csv"), table)?;
        }
    }
    Ok(())
}

/// The outputs of a scene file at its communication points, which have to be finite.
fn scene(path: &Path) -> Result<String> {
    let file = SceneFile::read(path)?;
    let names: Vec<_> = file.outputs.iter().map(|output| output.name).collect();
    let mut table = format!("time,{}\n", names.join(","));
    run(&file, |simulation, time| {
        write!(table, "{time}")?;
        for output in &file.outputs {
            let value = simulation.output(output).context("not an output")?;
            ensure!(value.is_finite(), "{} at {time} s: {value}", output.name);
            write!(table, ",{value}")?;
        }
        table.push('\n');
        Ok(())
    })?;
    Ok(table)
}

/// Runs a scene file, and does something at each of its communication points.
pub fn run(file: &SceneFile, mut each: impl FnMut(&Simulation, f64) -> Result<()>) -> Result<()> {
    let mut simulation = Simulation::new(&file.scene, &file.first_inputs()?, 0.0)?;
    each(&simulation, 0.0)?;
    for (time, size) in file.steps() {
        simulation.step(&file.inputs_over(time, size)?, time, size)?;
        each(&simulation, time + size)?;
    }
    Ok(())
}

/// For each communication step the acceleration over it, and the contact forces, N, of two runs at its start: of one contact,
/// its frame's acceleration a sine held from each communication point to the next; and of the second of the two contacts of
/// `SystemStructure.ssd`.
///
/// Importers reckon time differently: `n h`, a sum of steps, whole nanoseconds. That makes no difference to the first run:
/// a length of step that differs from the last by the rounding of time counts as the same.
fn reference() -> Result<String> {
    let mut table = "time,base.acceleration,run,coupled\n".to_owned();
    let mut held = Inputs::default();
    let jump = Inputs { base_acceleration: JUMP, ..held };
    let carried = |first: &Simulation| Inputs { support_displacement: first.real(RealOutput::TipDisplacement), ..jump };
    let (mut single, mut first) = (start(&held)?, start(&jump)?);
    let mut second = start(&carried(&first))?;
    let mut forces = Vec::new();
    for n in 0..=STEPS {
        let time = f64::from(n) * STEP;
        held.base_acceleration = SINE.0 * (TAU * SINE.1 * time).sin();
        let [force, coupled] = [&single, &second].map(|contact| contact.real(RealOutput::ContactForce));
        writeln!(table, "{time},{},{force},{coupled}", held.base_acceleration)?;
        forces.push(force);
        single.step(&held, time, STEP)?;
        // Both step from the same communication point; what the first reached there is what the second gets.
        second.step(&carried(&first), time, STEP)?;
        first.step(&jump, time, STEP)?;
    }
    // It opens, closes again, and the second contact vibrates about twice the preload.
    let opened = forces.iter().position(|force| *force == 0.0);
    let mut after = forces.iter().skip(opened.context("it never opens")?);
    ensure!(after.any(|force| *force > 0.152), "it never closes again");
    Ok(table)
}

fn start(inputs: &Inputs) -> Result<Simulation> {
    let mut scene = Scene::default();
    scene.solver.tolerance = TOLERANCE;
    Ok(Simulation::new(&scene, inputs, 0.0)?)
}
