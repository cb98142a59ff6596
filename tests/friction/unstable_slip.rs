//! Slip that is unstable: two modes that feed each other while the contact slips, in closed form.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};
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
fn squealing(loads: [f64; 2]) -> Scene {
    let mut scene = rubbing(undamped());
    scene.effects.contact_law = ContactLawKind::Rough;
    scene.contact.stiffness = STIFFNESS;
    scene.contact.stiffness_force = FORCE;
    scene.contact.stiffness_exponent = EXPONENT;
    let share = scene.friction.coefficient * scene.tip.contact_height;
    let flexible = MODES.iter().zip(loads).map(|(&(frequency, contact), load)| GivenMode {
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

/// The eigenvalue (1/s) that grows fastest with this stiffness of the contact (N/m): `l^4 + (a + d) l^2 + a d - b c = 0`.
fn closed_form(stiffness: f64, loads: [f64; 2]) -> Complex<f64> {
    let [(first, tip), (second, other)] = MODES;
    let a = (TAU * first).powi(2) + stiffness * loads[0] * tip;
    let d = (TAU * second).powi(2) + stiffness * loads[1] * other;
    let product = stiffness * loads[0] * other * stiffness * loads[1] * tip;
    let root = Complex::new(0.25 * (a - d).powi(2) + product, 0.0).sqrt();
    let squares = [-0.5 * (a + d) + root, -0.5 * (a + d) - root];
    let values = squares.map(Complex::sqrt);
    if values[0].re > values[1].re { values[0] } else { values[1] }
}

fn told(model: &Model) -> Vec<(bool, f64, f64, f64)> {
    let slips = model.remarks().into_iter().filter_map(|remark| match remark {
        Remark::UnstableSlip { away, force, growth, frequency, .. } => Some((away, force, growth, frequency)),
        _ => None,
    });
    slips.collect()
}

#[test]
fn the_growth_told_is_that_of_two_modes_in_closed_form() {
    let model = Model::new(&squealing(LOADS), 0.0).unwrap();
    let [(away, force, growth, frequency)] = told(&model)[..] else {
        panic!("{:?}", model.remarks());
    };
    let expected = closed_form(STIFFNESS * (force / FORCE).powf(EXPONENT), LOADS);
    assert!(away && expected.re > 100.0, "{expected}");
    // The slow third mode takes part in nothing. Eigenvalues are right to rounding, but for what the closeness to the onset
    // magnifies.
    assert!((growth / expected.re - 1.0).abs() < 1e-8);
    assert!((frequency * TAU / expected.im.abs() - 1.0).abs() < 1e-8);
    // Nearest to the preload.
    assert!((force / model.preload.force - 1.0).abs() < 1e-12);
}

#[test]
fn slip_that_is_stable_is_not_told() {
    for scene in [Scene::default(), rubbing(Scene::default()), squealing([11.0, 2.0])] {
        assert_eq!(told(&Model::new(&scene, 0.0).unwrap()), []);
    }
    // Apart by more than the contact couples them.
    let weak = [2.0, -0.1];
    let model = Model::new(&squealing(weak), 0.0).unwrap();
    let preload = model.preload.force;
    for share in [0.0625, 0.25, 1.0, 4.0, 16.0] {
        assert!(closed_form(STIFFNESS * (share * preload / FORCE).powf(EXPONENT), weak).re < 1e-6);
    }
    assert_eq!(told(&model), []);
}

/// A contact that slides on at 10 mm/s, pushed a little.
#[test]
fn a_small_motion_of_a_contact_that_slides_grows_as_told() {
    let mut scene = squealing(LOADS);
    scene.solver.tolerance = 1e-10;
    let model = Model::new(&scene, 0.0).unwrap();
    let force = model.preload.force;
    let expected = closed_form(model.preload.contact_stiffness, LOADS);
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
    assert!(reached < 2e-3 && (growth / expected.re - 1.0).abs() < 2e-3);
}
