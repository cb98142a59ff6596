//! A linear scene against its closed form: a sum of damped oscillators under a sine.
//!
//! With one stiffness damping for beam and contact, the modes of the beam with the contact as a spring are uncoupled, and
//! the response of each from rest is textbook.

use std::f64::consts::TAU;

use crate::common::Rig;
use nalgebra::Complex;
use relay_contact::beam::galerkin::Space;
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::{ContactLawKind, ExcitationKind};

const FREQUENCY: f64 = 1000.0;
const AMPLITUDE: f64 = 98.0;

/// Displacement and velocity at `t` of `x'' + c x' + w^2 x = Im e^(i omega t)` from rest.
fn from_rest(omega_squared: f64, damping: f64, t: f64) -> (f64, f64) {
    let omega = TAU * FREQUENCY;
    let i = Complex::new(0.0, 1.0);
    let steady = 1.0 / Complex::new(omega_squared - omega * omega, omega * damping);
    let (x0, v0) = (steady.im, (i * omega * steady).im);
    // What the steady motion has at the start is taken back by a free one, `a e^(l1 t) + b e^(l2 t)`.
    let root = Complex::new(damping * damping / 4.0 - omega_squared, 0.0).sqrt();
    let (l1, l2) = (-root - damping / 2.0, omega_squared / (-root - damping / 2.0));
    let a = (Complex::from(-v0) + l2 * x0) / (l1 - l2);
    let b = -x0 - a;
    let (e1, e2) = (a * (l1 * t).exp(), b * (l2 * t).exp());
    let now = steady * (i * omega * t).exp();
    (now.im + (e1 + e2).re, (i * omega * now).im + (l1 * e1 + l2 * e2).re)
}

/// The force above the preload force, by the closed form.
fn force(model: &Model, t: f64) -> f64 {
    let preload = &model.preload;
    let beta = model.law.damping();
    Space::new(model.modes.len())
        .modes(&model.section, preload.axial_force, preload.contact_stiffness)
        .unwrap()
        .iter()
        .map(|mode| {
            let (x, v) = from_rest(mode.omega_squared, beta * mode.omega_squared, t);
            preload.contact_stiffness * mode.tip * mode.participation * AMPLITUDE * (x + beta * v)
        })
        .sum()
}

fn scene(law: ContactLawKind) -> Scene {
    let mut scene = Scene::default();
    scene.effects.contact_law = law;
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.frequency = FREQUENCY;
    scene.excitation.amplitude = AMPLITUDE;
    scene.solver.modes = 8;
    scene
}

#[test]
fn within_the_tolerance_of_the_closed_form() {
    for law in [ContactLawKind::Bonded, ContactLawKind::Linearised] {
        for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
            let mut scene = scene(law);
            scene.solver.tolerance = tolerance;
            let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
            let mut worst = 0.0_f64;
            for k in 1..=1000 {
                rig.run_to(&Inputs::default(), f64::from(k) * 1.3e-5).unwrap();
                let exact = rig.model.preload.force + force(&rig.model, rig.state.time);
                worst = worst.max((rig.state.force - exact).abs() / rig.model.force_scale);
            }
            println!(
                "{law:?}: asked {tolerance:e}, delivered {worst:.1e}, {} steps",
                rig.state.steps
            );
            assert!(worst <= tolerance, "{law:?}, {tolerance:e}: {worst:e}");
        }
    }
}

/// The exact solution at any step length, one step per communication step. Rounding: the sum of the modes' displacements
/// loses some two digits, the phase at `t` some more.
#[test]
fn machine_precision_in_single_steps() {
    for size in [1e-7, 1.3e-5, 1e-3, 0.7] {
        let mut rig = Rig::new(Model::new(&scene(ContactLawKind::Bonded), 0.0).unwrap());
        for k in 1..=50 {
            rig.run_to(&Inputs::default(), f64::from(k) * size).unwrap();
            let exact = rig.model.preload.force + force(&rig.model, rig.state.time);
            let error = (rig.state.force - exact).abs() / rig.model.force_scale;
            assert!(error < 1e-12, "{size} s, step {k}: {error:e}");
        }
        assert_eq!(rig.state.steps, 50, "{size} s");
    }
}
