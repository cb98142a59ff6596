//! Slip that is unstable: two modes that feed each other while the contact slips. What is told of other springs, and of slip that is
//! stable: `tests/python/test_friction.py`.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use relay_contact::error::Remark;
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::GivenMode;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, RealOutput};
use testing::scenes::undamped;
use testing::springs::{mode, of_modes, spring_file};

use super::rubbing;

/// Stiffness (N/m) of the contact at a force (N), and the exponent with which it grows.
const STIFFNESS: f64 = 4e4;
const FORCE: f64 = 0.2;
const EXPONENT: f64 = 0.5;

/// Two modes without damping, their frequency (Hz) and displacement at the contact (1/sqrt(kg)), and their loads per contact
/// force while it slips away from the clamp: that of the second is against its displacement.
const MODES: [(f64, f64); 2] = [(1000.0, 10.0), (1200.0, 10.0)];
const LOADS: [f64; 2] = [11.5, -11.5];

/// A spring of these modes, and a third one along the spring alone, so slow that it slides on.
fn squealing() -> Scene {
    let mut scene = rubbing(undamped());
    scene.effects.contact_law = ContactLawKind::Rough;
    scene.contact.stiffness = STIFFNESS;
    scene.contact.stiffness_force = FORCE;
    scene.contact.stiffness_exponent = EXPONENT;
    let share = scene.friction.coefficient * scene.tip.contact_height;
    let flexible = MODES.iter().zip(LOADS).map(|(&(frequency, contact), load)| GivenMode {
        damping: Some(0.0),
        rotation: Some((contact - load) / share),
        ..mode(frequency, contact, 0.0)
    });
    let slide = GivenMode { damping: Some(0.0), rotation: Some(1.0 / scene.tip.contact_height), ..mode(0.1, 0.0, 0.0) };
    let compliance = MODES.iter().map(|(frequency, contact)| (contact / (TAU * frequency)).powi(2)).sum();
    // Some FORCE on contact and spring; each mode gives way to its load.
    scene.contact.overtravel = FORCE / ((1.0 - EXPONENT) * STIFFNESS);
    scene.spring = spring_file("two modes", of_modes(compliance, flexible.chain([slide])));
    scene
}

/// A contact that slides on at 10 mm/s, pushed a little.
#[test]
fn a_small_motion_of_a_contact_that_slides_grows_as_told() {
    let mut scene = squealing();
    scene.solver.tolerance = 1e-10;
    let model = Model::new(&scene, 0.0).unwrap();
    let force = model.preload.force;
    let [Remark::UnstableSlip { away: true, force: at, growth: told, .. }, Remark::FewModes { .. }] =
        model.remarks()[..]
    else {
        panic!("{:?}", model.remarks());
    };
    assert!((at / force - 1.0).abs() < 1e-12 && told > 100.0);
    let mut state = model.initial_state(0.0);
    let [slide, first, ..] = &mut state.modes;
    let speed = 1e-2;
    slide.v = speed;
    // A part of 2e-6 of the indentation, in the time of a radian.
    first.v = 2e-6 * model.preload.indentation * TAU * MODES[0].0 / MODES[0].1;
    model.settle(&mut state);
    let mut simulation = Simulation::from_state(model, &state);
    let step = 0.25 / MODES[0].0;
    let mut course = Vec::new();
    for k in 0..140 {
        let time = f64::from(k) * step;
        simulation.step(&Inputs::default(), time, step).unwrap();
        course.push(simulation.real(RealOutput::ContactForce) - force);
    }
    // After 15 ms the decaying motion is a fiftieth of the growing one. That alone has x_2 = 2 cos(w s) e^(g s) x_1 - e^(2 g s) x_0.
    let three: Vec<_> = course[60..].windows(3).collect();
    let before = DMatrix::from_fn(three.len(), 2, |row, column| three[row][column]);
    let after = DVector::from_fn(three.len(), |row, _| three[row][2]);
    let fitted = before.svd(true, true).solve(&after, 0.0).unwrap();
    let growth = (-fitted[0]).ln() / (2.0 * step);
    let reached = course.iter().fold(0.0_f64, |most, deviation| most.max(deviation.abs())) / force;
    // The law is bent by what is reached, a part of 2e-3.
    assert!(reached < 2e-3 && (growth / told - 1.0).abs() < 2e-3);
}
