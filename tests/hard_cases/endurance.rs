//! Long runs: what is small in a step must not add up.

use crate::common::{Rig, undamped};
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::ExcitationKind;

/// The published run for `periods` of the sine at 1000 communication steps each: the force at whole periods stays what it
/// was once the start has died away.
fn drift(periods: u32) {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
    let mut settled = f64::NAN;
    for period in 0..periods {
        for k in 1..=1000 {
            let time = f64::from(period * 1000 + k) * 1e-6;
            rig.run_to(&Inputs::default(), time).unwrap();
        }
        if period == 40 {
            settled = rig.state.force;
        }
        if period > 40 {
            let error = 2e-6 * rig.model.force_scale;
            assert!(
                (rig.state.force - settled).abs() <= error,
                "period {period}: {} {settled}",
                rig.state.force
            );
        }
    }
    assert!(settled > 0.0);
}

#[test]
fn no_drift_over_1e5_steps() {
    drift(100);
}

#[test]
#[ignore = "long: the command is at the head of main.rs"]
fn endurance_no_drift_over_1e7_steps() {
    drift(10_000);
}

/// The specimen without damping, thrown so that it bounces: energy over `cycles` closings, as mean over the first and the
/// last tenth and as largest deviation, relative to the energy thrown in.
fn bounce(cycles: u64, tolerance: f64) {
    let mut scene = undamped();
    scene.solver.tolerance = tolerance;
    scene.solver.modes = 6;
    let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
    let velocities: Vec<f64> = rig.model.modes.iter().map(|mode| 0.1 * mode.participation).collect();
    rig.launch(&velocities);
    let start = rig.energy();
    let (mut closings, mut last, mut k) = (0, -1.0, 0_u32);
    let (mut highest, mut lowest) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut next = 0;
    while closings < cycles {
        k += 1;
        rig.run_to(&Inputs::default(), f64::from(k) * 1e-5).unwrap();
        if rig.state.last_closing > last {
            last = rig.state.last_closing;
            closings += 1;
        }
        let balance = rig.energy() / start - 1.0;
        highest = highest.max(balance);
        lowest = lowest.min(balance);
        if closings >= next {
            println!(
                "{closings} cycles, {:.3} s, {} steps: {balance:+.1e}",
                rig.state.time, rig.state.steps
            );
            next += cycles / 10;
        }
    }
    println!("balance between {lowest:+.1e} and {highest:+.1e}");
    assert!(
        highest.max(-lowest) <= tolerance,
        "{tolerance:e}: {lowest:+e} to {highest:+e}"
    );
}

#[test]
fn energy_over_1e3_contact_cycles() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        bounce(1000, tolerance);
    }
}

#[test]
#[ignore = "long: the command is at the head of main.rs"]
fn endurance_energy_over_1e6_contact_cycles() {
    bounce(1_000_000, 1e-6);
}
