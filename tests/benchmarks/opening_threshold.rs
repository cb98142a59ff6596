//! Where a vibration first opens the contact.
//!
//! The linearised contact opens when the amplitude of its force reaches the preload force; that amplitude is the linear
//! response of Machines 2025, 13(1), 52, eqs. (16) to (25). The nonlinear force leaves the linear one with the square of the amplitude.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::reference::{self, Model};
use relay_contact::variables::ContactLawKind;
use testing::rig::Rig;
use testing::scenes::shaken;

/// Frequencies (Hz), and damping of beam and contact: alpha (1/s), beta and beta_c (s).
const CASES: [(f64, [f64; 3]); 9] = [
    (250.0, SPECIMEN),
    (700.0, SPECIMEN),
    (1000.0, SPECIMEN),
    (1300.0, SPECIMEN),
    (2000.0, SPECIMEN),
    (1354.5, [5125.0, 0.0, 0.0]),
    (500.0, [2000.0, 4e-5, 4e-5]),
    (2000.0, [0.0, 4e-5, 3e-4]),
    (1000.0, [3000.0, 0.0, 8.063e-5]),
];
const SPECIMEN: [f64; 3] = [0.0, 8.063e-5, 8.063e-5];

fn model(law: ContactLawKind, tolerance: f64, frequency: f64, damping: [f64; 3]) -> Model {
    let mut scene = shaken(98.0, frequency);
    [scene.beam.mass_damping, scene.beam.stiffness_damping, scene.contact.damping] = damping;
    scene.effects.contact_law = law;
    scene.solver.tolerance = tolerance;
    scene.solver.modes = 10;
    Model::new(&scene, 0.0).unwrap()
}

/// The model shaken with the amplitude (m/s2) until nothing is left of the start: the slowest motion decays by more than
/// 1e-13 in 40 ms.
fn periodic(model: Model, amplitude: f64, frequency: f64) -> Rig {
    let mut rig = Rig::shaken(model, amplitude, frequency);
    rig.run_to(&Inputs::default(), (0.04 * frequency).ceil() / frequency).unwrap();
    rig
}

/// Least force of the next period, N: the least sample and its neighbours give the parabola's.
fn least_force(rig: &mut Rig, frequency: f64) -> f64 {
    let start = rig.state.time;
    let forces: Vec<f64> = (1..=400)
        .map(|k| {
            rig.run_to(&Inputs::default(), start + f64::from(k) / (400.0 * frequency)).unwrap();
            rig.state.contact().force
        })
        .collect();
    let parabola = |x: &[f64]| match x {
        [a, b, c] if b <= a && b <= c => b - (c - a).powi(2) / (8.0 * (a - 2.0 * b + c)),
        _ => f64::INFINITY,
    };
    forces.windows(3).map(parabola).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_linearised_contact_opens_at_the_analytic_threshold() {
    for (frequency, damping) in CASES {
        let closed = model(ContactLawKind::Bonded, 1e-8, frequency, damping);
        let threshold = reference::opening_threshold(&closed, TAU * frequency);
        // The force misses zero by 1e-6 of the preload force on either side, a hundred times the error allowed.
        for (factor, opens) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
            let mut rig = periodic(closed.clone(), factor * threshold, frequency);
            // Up to here the contact is held; now it may open.
            rig.unbond();
            let (mut at, start) = (rig.state.time, rig.state.time);
            while rig.state.contact().force <= rig.model.preload.force {
                at += 1e-5;
                rig.run_to(&Inputs::default(), at).unwrap();
                assert!(at < start + 2.0 / frequency);
            }
            rig.state.links[0].last_opening = None;
            rig.run_to(&Inputs::default(), at + 3.0 / frequency).unwrap();
            assert_eq!(rig.state.contact().last_opening > Some(0.0), opens, "{frequency} Hz, {damping:?}, {factor}");
        }
    }
}

#[test]
fn the_nonlinear_force_leaves_the_linear_one_quadratically() {
    let frequency = 1000.0;
    let hertz = model(ContactLawKind::Hertz, 1e-10, frequency, SPECIMEN);
    let response = reference::response(&hertz, TAU * frequency).norm();
    let preload = hertz.preload.force;
    let deviation = |ratio: f64| {
        let mut rig = periodic(hertz.clone(), ratio * preload / response, frequency);
        let nonlinear = 1.0 - least_force(&mut rig, frequency) / preload;
        nonlinear - ratio
    };
    let deviations = [0.02, 0.04, 0.08].map(deviation);
    let orders: Vec<f64> = deviations.windows(2).map(|pair| (pair[1] / pair[0]).log2()).collect();
    // Order two plus a first correction that doubles with the ratio: extrapolated, it is gone.
    let order = 2.0 * orders[0] - orders[1];
    assert!((order - 2.0).abs() < 0.02, "{deviations:?} {orders:?}");
}
