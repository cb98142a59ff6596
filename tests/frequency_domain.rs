//! The frequency domain against the transient of the linear contact. `benchmarks/linear_scene.rs` compares that with the superposition
//! of the modes of beam and contact spring together.

use std::f64::consts::TAU;

use nalgebra::Complex;
use relay_contact::reference::{self, ElectricalContact, Model};
use relay_contact::scene::Scene;
use relay_contact::variables::{ContactLawKind, RealOutput, ResistanceKind};
use testing::scenes::course_from;

use crate::benchmarks::linear_scene::damped;

/// Damping of beam and contact: alpha (1/s), beta and beta_c (s).
const DAMPINGS: [(&str, (f64, f64, f64)); 5] = [
    ("stiffness", (0.0, 8.063e-5, 8.063e-5)),
    ("mass", (5125.0, 0.0, 0.0)),
    ("both", (2000.0, 4e-5, 4e-5)),
    ("more in the contact", (0.0, 4e-5, 3e-4)),
    ("mass, and in the contact", (3000.0, 0.0, 8.063e-5)),
];

const FREQUENCIES: [f64; 6] = [50.0, 500.0, 1000.0, 1354.5, 2000.0, 4400.0];

fn shaken(law: ContactLawKind, damping: (f64, f64, f64), frequency: f64) -> Scene {
    let mut scene = damped(law, 0, damping);
    scene.excitation.frequency = frequency;
    scene
}

/// Complex amplitude of the outputs at the generator's frequency, per acceleration, after everything else has died out.
fn settled<const N: usize>(scene: &Scene, outputs: [RealOutput; N]) -> [Complex<f64>; N] {
    const SAMPLES: u32 = 32;
    let period = 1.0 / scene.excitation.frequency;
    // The first mode decays with at least 1500 1/s, the slow motions of the damped contact faster: below 1e-13.
    let start = (0.02 / period).ceil() * period;
    let (rows, _) = course_from(scene, start, period / f64::from(SAMPLES), SAMPLES, outputs);
    let mut sums = [Complex::new(0.0, 0.0); N];
    for (k, row) in (1..=SAMPLES).zip(rows) {
        // The acceleration is a sine: the real part of -i exp(i omega t).
        let turn = Complex::from_polar(1.0, -TAU * f64::from(k) / f64::from(SAMPLES)) * Complex::i();
        for (sum, value) in sums.iter_mut().zip(row) {
            *sum += turn * value;
        }
    }
    sums.map(|sum| sum * (2.0 / f64::from(SAMPLES) / scene.excitation.amplitude))
}

#[test]
fn the_transient_of_the_linear_contact_settles_to_it() {
    for (name, damping) in DAMPINGS {
        for frequency in FREQUENCIES {
            for law in [ContactLawKind::Bonded, ContactLawKind::Linearised] {
                // In exact steps, and in steps with a polynomial of the force.
                for (maximum_step, tolerance) in [(0.0, 1e-6), (0.05 / frequency, 1e-11)] {
                    let mut scene = shaken(law, damping, frequency);
                    scene.solver.maximum_step = maximum_step;
                    scene.solver.tolerance = tolerance;
                    let model = Model::new(&scene, 0.0).unwrap();
                    let expected = reference::response(&model, TAU * frequency);
                    let [force, displacement] =
                        settled(&scene, [RealOutput::ContactForce, RealOutput::TipDisplacement]);
                    let pairs = [(force, expected.force), (displacement, expected.displacement)];
                    let error = pairs.map(|(value, expected)| (value - expected).norm() / expected.norm());
                    // The displacement of nanometres is read beside a deflection of 0.2 mm, whose rounding is 3e-20 m.
                    assert!(error.iter().all(|error| *error < 1e-8), "{name}, {frequency} Hz, {law:?}: {error:?}");
                }
            }
        }
    }
}

/// A large one is far from linear in the force: an amplitude of a third of the preload force makes the resistance swing by 47 % upwards
/// and 24 % downwards (power law).
#[test]
fn a_small_swing_of_the_resistance_is_that_of_the_force() {
    for kind in [ResistanceKind::PowerLaw, ResistanceKind::Holm] {
        let mut scene = shaken(ContactLawKind::Bonded, DAMPINGS[0].1, 1000.0);
        scene.effects.resistance = kind;
        scene.resistance.film = 0.01;
        scene.excitation.amplitude = 0.1;
        let model = Model::new(&scene, 0.0).unwrap();
        let force = scene.excitation.amplitude * reference::response(&model, TAU * 1000.0).force.norm();
        let electrical = ElectricalContact::new(&scene, &model.law).unwrap();
        let at_rest = model.preload.force;
        let slope = electrical.conductance_slope(at_rest) * electrical.conductance(at_rest).powi(-2);
        let [resistance] = settled(&scene, [RealOutput::ContactResistance]);
        let error = (resistance.norm() * scene.excitation.amplitude / (slope * force) - 1.0).abs();
        // Of the second power of the relative amplitude of the force.
        let ratio = force / at_rest;
        assert!(error < ratio * ratio, "{kind:?}: {error:e}, {ratio:e}");
    }
}
