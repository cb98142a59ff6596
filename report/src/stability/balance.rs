//! Forces that are known: from statics, or in closed form.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use anyhow::{Context, Result};
use relay_contact::error::SceneError;
use relay_contact::harmonic;
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::{Scene, Solver};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind, IntegerOutput, RealOutput};

use super::common::{Rig, compose, hertz, oscillator};
use super::{Case, Check};

pub const CASES: &[Case] = &[
    hour_at_rest,
    crushed,
    accumulating,
    linear,
    nanoseconds,
    long_steps,
    buckling,
];

fn force(contact: &Simulation) -> f64 {
    contact.real(RealOutput::ContactForce)
}

fn hour_at_rest(_: bool) -> Result<Vec<Check>> {
    let mut whole = Simulation::new(&Scene::default(), &Inputs::default(), 0.0)?;
    let mut seconds = whole.clone();
    let preload = whole.real(RealOutput::PreloadForce);
    whole.step(&Inputs::default(), 0.0, 3600.0)?;
    for second in 0..3600 {
        seconds.step(&Inputs::default(), f64::from(second), 1.0)?;
    }
    let case = "An hour at rest, in one communication step and in 3600";
    let hard = || "rounding adds up, and steps cost where nothing moves".to_owned();
    let steps = whole.integer(IntegerOutput::SolverSteps) + seconds.integer(IntegerOutput::SolverSteps);
    Ok(vec![
        Check {
            case,
            hard: hard(),
            property: "the force stays the preload force",
            measured: (force(&whole) - preload).abs().max((force(&seconds) - preload).abs()),
            allowed: 0.0,
            unit: "N",
        },
        Check {
            case,
            hard: hard(),
            property: "no integration step is taken",
            measured: f64::from(steps),
            allowed: 0.0,
            unit: "",
        },
    ])
}

fn crushed(_: bool) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    let moved = |displacement: f64| Inputs {
        support_displacement: displacement,
        ..Inputs::default()
    };
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let allowed = scene.solver.effective_tolerance() * contact.model().force_scale;
    let preload = force(&contact);
    let mut least = f64::INFINITY;
    let mut to = |contact: &mut Simulation, displacement: f64, duration: f64| {
        let time = contact.time();
        contact.step(&moved(displacement), time, duration)?;
        least = least.min(contact.real(RealOutput::StepMinimumForce));
        Ok::<_, anyhow::Error>(force(contact))
    };
    to(&mut contact, 1e-3, 1e-4)?;
    let crushed = to(&mut contact, 1e-3, 0.05)?;
    let expected = Simulation::new(&scene, &moved(1e-3), 0.0)?.real(RealOutput::PreloadForce);
    to(&mut contact, -3e-4, 1e-3)?;
    to(&mut contact, -3e-4, 1.0)?;
    to(&mut contact, 0.0, 1e-3)?;
    let back = to(&mut contact, 0.0, 0.05)?;
    let hard = || "blows of the support at 10 and 0.3 m/s, and a second without contact".to_owned();
    let case = "Support that crushes by 1 mm in 0.1 ms, withdraws for a second and comes back";
    Ok(vec![
        Check {
            case,
            hard: hard(),
            property: "the force comes to that of statics at 1 mm more overtravel",
            measured: (crushed - expected).abs(),
            allowed: scene.solver.effective_tolerance() * expected,
            unit: "N",
        },
        Check {
            case,
            hard: hard(),
            property: "the force comes back to the preload force",
            measured: (back - preload).abs(),
            allowed,
            unit: "N",
        },
        Check {
            case,
            hard: hard(),
            property: "the contact never pulls",
            measured: -least.min(0.0),
            allowed: 0.0,
            unit: "N",
        },
    ])
}

fn accumulating(_: bool) -> Result<Vec<Check>> {
    let (mass, weight) = (1e-4, 100.0);
    let model = compose(&[oscillator(mass, 0.0)], hertz(9.3e9, 1e-6), 1e-6, 1e-6, mass * weight);
    let mut rig = Rig::new(model);
    let inputs = Inputs {
        base_acceleration: weight,
        ..Inputs::default()
    };
    rig.run_to(&inputs, 0.05)?;
    Ok(vec![Check {
        case: "A mass bouncing to rest under its weight, in one communication step",
        hard: "ever more impacts in ever less time: event after event without end".to_owned(),
        property: "at the end the force is the weight",
        measured: (rig.state.force - mass * weight).abs(),
        allowed: 1e-6 * mass * weight,
        unit: "N",
    }])
}

/// The contact linearised and bonded, shaken: F = F_0 + Re(-i A R(omega) exp(i omega t)) once the start has died away.
fn linear(_: bool) -> Result<Vec<Check>> {
    let mut worst = 0.0_f64;
    for (tolerance, modes) in [(1e-1, 1), (1e-2, 0), (1e-6, 0), (1e-11, 40)] {
        let mut scene = Scene::default();
        scene.effects.excitation = ExcitationKind::Sine;
        scene.effects.contact_law = ContactLawKind::Bonded;
        // Extremes are looked for inside steps; without them a step is exact.
        scene.effects.extremes = false;
        scene.effects.chatter = false;
        scene.solver.tolerance = tolerance;
        scene.solver.modes = modes;
        for time in [1.0, 1.0001, 1.000_35, 2.0] {
            let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
            contact.step(&Inputs::default(), 0.0, time)?;
            let omega = TAU * scene.excitation.frequency;
            let (amplitude, phase) = harmonic::response(contact.model(), omega).force.to_polar();
            let swing = scene.excitation.amplitude * amplitude * (omega * time + phase - FRAC_PI_2).cos();
            let exact = contact.real(RealOutput::PreloadForce) + swing;
            worst = worst.max((force(&contact) - exact).abs() / contact.model().force_scale);
        }
    }
    Ok(vec![Check {
        case: "Linear contact, 1 to 2 s in one communication step, tolerance 0.1 to 1e-11, 1 to 40 modes",
        hard: "a thousand periods in a step, one mode or forty".to_owned(),
        property: "the force is that of the frequency domain (of the preload force)",
        measured: worst,
        // The phase of 2 s at 1 kHz is rounded to 2 pi 2000 times the spacing of numbers, and so is the force.
        allowed: 1e4 * PI * f64::EPSILON,
        unit: "",
    }])
}

fn nanoseconds(quick: bool) -> Result<Vec<Check>> {
    let parts = if quick { 5_000 } else { 50_000 };
    let mut whole = Simulation::new(&Scene::default(), &Inputs::default(), 0.0)?;
    let mut fine = whole.clone();
    let allowed = 2.0 * Solver::DEFAULT_TOLERANCE * whole.model().force_scale;
    let (mut worst, mut time) = (0.0_f64, 0.0);
    // Opens, flies, and closes again.
    for (acceleration, duration) in [(-50_000.0, 10e-6), (50_000.0, 40e-6)] {
        let inputs = Inputs {
            base_acceleration: acceleration,
            ..Inputs::default()
        };
        whole.step(&inputs, time, duration)?;
        let size = duration / f64::from(parts) * 2.0;
        for part in 0..parts / 2 {
            fine.step(&inputs, time + f64::from(part) * size, size)?;
        }
        worst = worst.max((force(&whole) - force(&fine)).abs());
        time += duration;
    }
    Ok(vec![Check {
        case: "5000 g for 50 µs in two communication steps, and in steps around a nanosecond",
        hard: "steps of 10⁻⁹ s: differences of nearly equal numbers everywhere".to_owned(),
        property: "the same force",
        measured: worst,
        allowed,
        unit: "N",
    }])
}

fn long_steps(_: bool) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    let mut seconds = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let mut fine = seconds.clone();
    for step in 0..4000 {
        fine.step(&Inputs::default(), f64::from(step) * 1e-5, 1e-5)?;
    }
    let mut worst = 0.0_f64;
    for second in 0..3 {
        seconds.step(&Inputs::default(), f64::from(second), 1.0)?;
        worst = worst.max((force(&seconds) - force(&fine)).abs());
    }
    Ok(vec![Check {
        case: "98 m/s² at 1 kHz in communication steps of a second, against 10 µs",
        hard: "a thousand periods in a step; errors of steps add up to drift".to_owned(),
        property: "after whole periods the same force, however long it has run",
        measured: worst,
        allowed: 2.0 * Solver::DEFAULT_TOLERANCE * fine.model().force_scale,
        unit: "N",
    }])
}

fn buckling(_: bool) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::Prescribed;
    let beam = scene.beam;
    let bending_stiffness = beam.youngs_modulus * beam.width * beam.thickness.powi(3) / 12.0;
    let exact = PI * PI * bending_stiffness / (4.0 * beam.length.powi(2));
    let refused = |force: f64| {
        let scene = Scene {
            beam: relay_contact::scene::Beam {
                axial_force: force,
                ..beam
            },
            ..scene
        };
        match Model::new(&scene, 0.0) {
            Err(SceneError::Buckled { limit, .. }) => Ok(Some(limit)),
            Err(error) => Err(error),
            Ok(_) => Ok(None),
        }
    };
    let named = refused(1.000_001 * exact)?.context("a spring beyond buckling is not refused")?;
    let below = refused(0.999_999 * exact)?;
    let hard = || "the contact may open, and the spring alone buckles".to_owned();
    Ok(vec![
        Check {
            case: "Axial force a millionth above the buckling load",
            hard: hard(),
            property: "refused, and the limit named is π² E I / (4 L²) (part of it)",
            measured: (named / exact - 1.0).abs(),
            // A dozen roundings.
            allowed: 12.0 * f64::EPSILON,
            unit: "",
        },
        Check {
            case: "Axial force a millionth below the buckling load",
            hard: "the spring has almost no stiffness left".to_owned(),
            property: "simulated (times refused)",
            measured: f64::from(u8::from(below.is_some())),
            allowed: 0.0,
            unit: "",
        },
    ])
}
