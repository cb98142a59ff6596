//! The runs that importers reproduce: `out/conformance/reference.csv`, and every scene, with its parameter set in `out/ssv`.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use anyhow::Result;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;

use super::rows::folder;
use crate::scene;

/// Communication step, s.
const STEP: f64 = 1e-5;
/// Communication step, s.
const STEPS: u32 = 500;
const TOLERANCE: f64 = 1e-7;
/// Amplitude, m/s2, at which the contact opens and closes, and frequency, Hz.
const SINE: (f64, f64) = (400.0, 1000.0);
/// The frame's acceleration in `SystemStructure.ssd`, m/s2.
const JUMP: f64 = 50.0;

/// Writes all of them.
pub fn write() -> Result<()> {
    let scenes = folder().join("scenes");
    fs::create_dir_all(&scenes)?;
    fs::write(folder().join("reference.csv"), reference()?)?;
    for (name, file) in scene::all()? {
        scene::simulate(&file, &scenes.join(format!("{name}.csv")))?;
    }
    scene::ssv::write()
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

#[cfg(test)]
mod tests {
    use anyhow::Context;

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
