//! The generated base acceleration. [`waveforms`]: against closed forms; [`noise`]: the random one; [`response`]: what
//! they do to the contact.

mod noise;
mod response;
mod waveforms;

use std::f64::consts::{PI, TAU};

use relay_contact::inputs::Inputs;
use relay_contact::reference::Generator;
use relay_contact::scene::{Excitation, Scene};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, IntegerOutput, RealOutput};

/// Standard acceleration of gravity, m/s2.
const G: f64 = 9.806_65;

/// A scene with the generator, 98 m/s2, from `start` on, with what differs from the start values.
fn excited(kind: ExcitationKind, start: f64, change: impl FnOnce(&mut Excitation)) -> Scene {
    let mut scene = Scene::default();
    scene.effects.excitation = kind;
    scene.excitation.start_time = start;
    change(&mut scene.excitation);
    scene
}

fn sweep(start: f64, frequency: f64, end_frequency: f64, duration: f64) -> Scene {
    excited(ExcitationKind::LogSweep, start, |sweep| {
        (sweep.frequency, sweep.end_frequency, sweep.duration) = (frequency, end_frequency, duration);
    })
}

fn half_sine(start: f64, amplitude: f64, duration: f64) -> Scene {
    excited(ExcitationKind::HalfSine, start, |shock| (shock.amplitude, shock.duration) = (amplitude, duration))
}

fn random(start: f64, frequency: f64, end_frequency: f64, density: f64) -> Scene {
    excited(ExcitationKind::Random, start, |noise| {
        (noise.frequency, noise.end_frequency, noise.spectral_density) = (frequency, end_frequency, density);
    })
}

fn with(mut scene: Scene, change: impl FnOnce(&mut Excitation)) -> Scene {
    change(&mut scene.excitation);
    scene
}

/// Force, and the counted steps, after communication steps to these instants from 0 on.
fn forces(scene: &Scene, times: &[f64], inputs: impl Fn(f64, f64) -> Inputs) -> (Vec<f64>, i32) {
    let mut simulation = Simulation::new(scene, &inputs(0.0, 1.0), 0.0).unwrap();
    let mut forces = Vec::new();
    let mut last = 0.0;
    for &time in times {
        simulation.step(&inputs(last, time), last, time - last).unwrap();
        forces.push(simulation.real(RealOutput::ContactForce));
        last = time;
    }
    (forces, simulation.integer(IntegerOutput::SolverSteps))
}

fn undriven(_: f64, _: f64) -> Inputs {
    Inputs::default()
}

fn equal_steps(size: f64, count: u32) -> Vec<f64> {
    (1..=count).map(|k| f64::from(k) * size).collect()
}

/// The acceleration from its definition, as far as it goes without a sum of sines.
fn closed_form(scene: &Scene, time: f64) -> f64 {
    let e = &scene.excitation;
    let tau = time - e.start_time;
    let within = |frequency: f64| {
        if e.displacement_limit > 0.0 {
            let limit = (TAU * frequency).powi(2) * e.displacement_limit;
            e.amplitude.signum() * e.amplitude.abs().min(limit)
        } else {
            e.amplitude
        }
    };
    if tau < 0.0 {
        return 0.0;
    }
    match scene.effects.excitation {
        ExcitationKind::Sine => {
            let reached = if tau < e.rise_time { 0.5 - 0.5 * (PI * tau / e.rise_time).cos() } else { 1.0 };
            reached * within(e.frequency) * (TAU * e.frequency * tau + e.phase).sin()
        }
        ExcitationKind::HalfSine if tau <= e.duration => e.amplitude * (PI * tau / e.duration).sin(),
        ExcitationKind::LogSweep if tau < e.duration => {
            let r = e.end_frequency / e.frequency;
            let grown = r.powf(tau / e.duration);
            let angle = TAU * e.frequency * e.duration / r.ln() * (grown - 1.0);
            within(e.frequency * grown) * (angle + e.phase).sin()
        }
        ExcitationKind::Random => Generator::new(scene).acceleration(time),
        _ => 0.0,
    }
}

/// Scenes of every waveform that start at 0.3 ms and are over, where they end, at 2.3 ms.
fn every_waveform() -> Vec<(&'static str, Scene)> {
    let start = 3e-4;
    vec![
        ("sine", excited(ExcitationKind::Sine, start, |sine| sine.phase = 0.7)),
        ("limited sine", excited(ExcitationKind::Sine, start, |sine| sine.displacement_limit = 1e-6)),
        ("rising sine", excited(ExcitationKind::Sine, start, |sine| (sine.rise_time, sine.phase) = (1.7e-3, 0.7))),
        ("half sine", half_sine(start, 300.0, 2e-3)),
        ("sweep up", with(sweep(start, 300.0, 3000.0, 2e-3), |sweep| sweep.phase = -0.4)),
        ("sweep down", with(sweep(start, 3000.0, 300.0, 2e-3), |sweep| sweep.phase = 0.4)),
        ("sweep over the crossover", with(sweep(start, 300.0, 3000.0, 2e-3), |sweep| sweep.displacement_limit = 3e-6)),
        ("random", random(start, 100.0, 2500.0, 4.0)),
        ("pulling half sine", half_sine(start, -300.0, 2e-3)),
        (
            "pulling limited sine",
            excited(ExcitationKind::Sine, start, |sine| (sine.amplitude, sine.displacement_limit) = (-98.0, 1e-6)),
        ),
        (
            "pulling sweep over the crossover",
            with(sweep(start, 300.0, 3000.0, 2e-3), |sweep| {
                (sweep.amplitude, sweep.displacement_limit) = (-98.0, 3e-6);
            }),
        ),
    ]
}
