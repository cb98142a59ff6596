//! The generated base acceleration. [`waveforms`]: limits of their closed forms, and the standards (the closed forms themselves:
//! `tests/python/test_effects_excitation.py`); [`noise`]: the random one; [`response`]: what they do to the contact.

mod noise;
mod response;
mod waveforms;

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
