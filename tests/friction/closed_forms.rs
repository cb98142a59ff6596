//! Closed forms: a slider on a spring of its own, under the constant force of another mode; and a contact that sticks.

use std::env;
use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::GivenMode;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::scenes::{at_rest, course, course_from, shaken, undamped};
use testing::springs::{mode, of_modes, spring_file};
use testing::{close, near};

use super::{rubbing, stiffness_ratio};
use crate::spring::reference::{Stretch, frequencies};

/// Mass of the slider, kg, and force on it per base acceleration, kg.
const MASS: f64 = 1e-4;
const LOADED: f64 = 1e-4;

/// A contact pressed by one mode that nothing moves, and moved along the spring by another of this frequency (Hz) and
/// damping ratio: a mass under a force, on a spring, with friction under constant pressure.
fn slider(amplitude: f64, frequency: f64, own: f64, ratio: f64) -> Scene {
    let mut scene = rubbing(shaken(amplitude, frequency));
    scene.friction.initial = 0.0;
    scene.effects.contact_damping = false;
    let lever = 1.0 / MASS.sqrt();
    let compliance = 1e-3;
    let pressing = 300.0;
    let modes = [
        GivenMode {
            damping: Some(1.0),
            rotation: Some(0.0),
            ..mode(pressing, TAU * pressing * f64::sqrt(compliance), 0.0)
        },
        GivenMode {
            damping: Some(ratio),
            rotation: Some(lever / scene.tip.contact_height),
            ..mode(own, 0.0, LOADED * lever)
        },
    ];
    scene.spring = spring_file("slider", of_modes(compliance, modes));
    scene
}

/// Limit of the friction force (N) and tangential stiffness (N/m) of the slider.
fn grip(scene: &Scene) -> (f64, f64) {
    let force = at_rest(scene, RealOutput::PreloadForce);
    let stiffness = at_rest(scene, RealOutput::PreloadContactStiffness) * stiffness_ratio(&scene.contact);
    (scene.friction.coefficient * force, stiffness)
}

const ALONG: [RealOutput; 3] =
    [RealOutput::ContactTangentialForce, RealOutput::ContactSlip, RealOutput::FrictionEnergy];

/// Displacement along the spring, from the slip and what the tangential spring gives.
fn displacements(rows: &[[f64; 3]], stiffness: f64) -> Vec<f64> {
    rows.iter().map(|row| row[1] - row[0] / stiffness).collect()
}

/// A contact moved to and fro by `A` under constant pressure: `4 mu F (A - mu F / k_t)` per cycle.
#[test]
fn hysteresis_of_a_slider_moved_to_and_fro() {
    for amplitude in [900.0, 1400.0, 5000.0] {
        let mut scene = slider(amplitude, 100.0, 2e4, 1.0);
        scene.solver.tolerance = 1e-7;
        let (limit, stiffness) = grip(&scene);
        let per_cycle = 1000;
        let (rows, _) = course(&scene, 1e-2 / f64::from(per_cycle), 4 * per_cycle, ALONG);
        let (before, last) = rows.split_at(3 * per_cycle as usize);
        let moved = displacements(last, stiffness);
        let extreme = |pick: fn(f64, f64) -> f64| moved.iter().copied().reduce(pick).unwrap();
        let reached = 0.5 * (extreme(f64::max) - extreme(f64::min));
        let dissipated = last.last().unwrap()[2] - before.last().unwrap()[2];
        let expected = 4.0 * limit * (reached - limit / stiffness);
        assert!(reached > 1.2 * limit / stiffness);
        // The extremes are read at a thousand instants a cycle: wrong by 5e-6 of A.
        close("dissipated", dissipated, expected, 1e-4);
    }
}

/// J. P. Den Hartog, Trans. ASME 53 (1931) APM-53-9-107: amplitude of an oscillator with Coulomb friction under a harmonic
/// force, where it does not stop.
#[test]
fn amplitude_of_a_coulomb_damped_oscillator() {
    // So soft that the friction force turns, over 2 mu F / k_t, within 5e-5 of a cycle: the closed form knows no k_t.
    const OWN: f64 = 2.0;
    for (ratio, friction) in [(0.8, 0.3), (0.8, 0.6), (1.3, 0.5), (1.25, 0.2)] {
        let probe = slider(1.0, OWN * ratio, OWN, 0.0);
        let (limit, stiffness) = grip(&probe);
        let mut scene = slider(limit / friction / LOADED, OWN * ratio, OWN, 0.0);
        scene.solver.tolerance = 1e-5;
        let per_cycle = 2000;
        let period = 1.0 / (OWN * ratio);
        let (rows, _) = course_from(&scene, 70.0 * period, period / f64::from(per_cycle), 10 * per_cycle, ALONG);
        let moved = displacements(&rows, stiffness);
        let found = moved.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let spring = MASS * (TAU * OWN).powi(2);
        let (v, u) = (1.0 / (1.0 - ratio * ratio), (PI / ratio).sin() / (ratio * (1.0 + (PI / ratio).cos())));
        let expected = limit / friction / spring * (v * v - (friction * u).powi(2)).sqrt();
        // Two thousand instants a cycle miss the extreme by 3e-6 of it.
        close(format_args!("{ratio} {friction}"), found, expected, 3e-4);
    }
}

/// Many slips to and fro: what the friction dissipates is what the drive puts in, no more and no less. A million with
/// `CYCLES=1000000 cargo test --release --test component over_many -- --nocapture`; the figure is in `docs/friction.md`.
#[test]
fn no_energy_is_made_over_many_cycles() {
    let cycles = env::var("CYCLES").map_or(60, |cycles| cycles.parse::<u32>().unwrap());
    let probe = slider(1.0, 80.0, 100.0, 0.0);
    let (limit, stiffness) = grip(&probe);
    let mut scene = slider(limit / 0.5 / LOADED, 80.0, 100.0, 0.0);
    scene.solver.tolerance = 1e-5;
    scene.effects.energy = true;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let period = 1.0 / 80.0;
    let mut distance = 0.0;
    for k in 0..cycles / 10 {
        simulation.step(&Inputs::default(), 10.0 * period * f64::from(k), 10.0 * period).unwrap();
        let slid = simulation.real(RealOutput::ContactSlipDistance);
        assert!(slid > distance);
        distance = slid;
    }
    let dissipated = simulation.real(RealOutput::FrictionEnergy);
    let balance = simulation.real(RealOutput::EnergyBalance);
    println!("{dissipated:e} J over {distance} m, balance {balance:e} J, grip {stiffness:e} N/m");
    // The pressure is constant.
    assert!((dissipated / (limit * distance) - 1.0).abs() < 1e-6);
    assert!(balance.abs() < 1e-5 * dissipated, "{balance:e} of {dissipated:e} J");
}

/// A contact that sticks is a linear spring against the rotation of the tip, `h^2 k_t`.
#[test]
fn what_sticks_is_a_rotational_spring() {
    for height in [1e-4, 1e-3, 5e-3] {
        let mut scene = rubbing(undamped());
        scene.effects.axial_force = relay_contact::variables::AxialForceKind::None;
        (scene.friction.initial, scene.friction.coefficient, scene.tip.contact_height) = (0.0, 1.0, height);
        (scene.solver.tolerance, scene.solver.modes) = (1e-9, 40);
        let model = Model::new(&scene, 0.0).unwrap();
        let normal = model.preload.contact_stiffness;
        let tangential = normal * stiffness_ratio(&scene.contact);
        let modes = &model.modes;
        let count = modes.len();
        let vector = |of: &dyn Fn(usize) -> f64| DVector::from_fn(count, |k, _| of(k));
        let tips = vector(&|k| modes[k].tip);
        let levers = vector(&|k| height * modes[k].rotation);
        let stiffness = DMatrix::from_diagonal(&vector(&|k| modes[k].omega_squared))
            + &tips * tips.transpose() * normal
            + &levers * levers.transpose() * tangential;
        let eigen = stiffness.symmetric_eigen();
        let lowest = eigen.eigenvalues.imin();
        let omega = eigen.eigenvalues[lowest].sqrt();
        let section = model.section;
        let spring = Stretch {
            mass: section.tip_mass,
            support: normal,
            turn: height * height * tangential,
            ..Stretch::uniform(section.length, section.bending_stiffness, section.mass_per_length)
        };
        let exact = frequencies(&[spring], f64::INFINITY, 20.0, 1)[0];
        assert!((omega / exact - 1.0).abs() < 1e-6, "{omega} {exact}");

        // Swung in this shape, so little that the law is linear.
        let shape = eigen.eigenvectors.column(lowest).into_owned();
        let swing = 1e-4 * model.preload.force;
        let factor = -swing / (normal * tips.dot(&shape));
        let mut state = model.initial_state(0.0);
        for (at, part) in state.modes.iter_mut().zip(shape.iter()) {
            at.q = factor * part;
        }
        model.settle(&mut state);
        let force = model.preload.force;
        let mut simulation = Simulation::from_state(model, &state);
        let period = TAU / omega;
        for quarter in 0..41_u32 {
            let size = 0.25 * period;
            simulation.step(&Inputs::default(), f64::from(quarter) * size, size).unwrap();
            let expected = swing * (0.5 * PI * f64::from(quarter + 1)).cos();
            let found = simulation.real(RealOutput::ContactForce) - force;
            // The law bends by the swing over the preload, 1e-4, in the second harmonic.
            near(format_args!("{height} m, quarter {quarter}"), found, expected, 1e-3 * swing);
        }
        assert_eq!(simulation.real(RealOutput::FrictionEnergy), 0.0);
    }
}
