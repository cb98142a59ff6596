//! Extreme settings of the solver, and extreme communication steps.

use crate::common::Rig;
use crate::ride::{Ride, Segment};
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::{Scene, Solver};
use relay_contact::variables::ExcitationKind;

#[test]
fn the_coarsest_tolerance() {
    let mut scene = Scene::default();
    scene.solver.tolerance = 0.1;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn a_tolerance_below_the_floor() {
    let mut scene = Scene::default();
    scene.solver.tolerance = 1e-12;
    assert_eq!(scene.solver.effective_tolerance(), Solver::TOLERANCE_FLOOR);
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn one_mode() {
    let mut scene = Scene::default();
    scene.solver.modes = 1;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn forty_modes() {
    let mut scene = Scene::default();
    scene.solver.modes = 40;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn communication_steps_of_a_nanosecond() {
    let mut ride = Ride::shaken(Scene::default());
    // The contact opens, flies and closes again.
    let fly = |duration, acceleration| Segment {
        duration,
        acceleration,
        support: 0.0,
    };
    ride.segments = vec![fly(10e-6, -50_000.0), fly(40e-6, 50_000.0)];
    let coarse = ride.keeps_its_properties();
    let nanoseconds = ride.run(25_000).unwrap();
    assert!(nanoseconds.rig.state.last_closing > 0.0);
    let error = 2.0 * Solver::DEFAULT_TOLERANCE * coarse.rig.model.force_scale;
    for (a, b) in coarse.forces.iter().zip(&nanoseconds.forces) {
        assert!((a - b).abs() <= error, "{a} {b}");
    }
}

#[test]
fn communication_steps_of_a_second() {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
    for second in 1..=3 {
        rig.run_to(&Inputs::default(), f64::from(second)).unwrap();
        let mut fine = Rig::new(rig.model.clone());
        for k in 1..=2000 {
            fine.run_to(&Inputs::default(), 1e-5 * f64::from(k)).unwrap();
        }
        // Whole periods, long after the start.
        let error = 2.0 * Solver::DEFAULT_TOLERANCE * rig.model.force_scale;
        assert!((rig.state.force - fine.state.force).abs() <= error);
        assert!(rig.state.steps < 1_000_000);
    }
}

/// The tolerance is relative to the preload force, and below the rounding of the force of a blow.
#[test]
fn a_tolerance_below_the_rounding_of_a_blow() {
    let mut scene = Scene::default();
    scene.beam.width = 1e-4;
    scene.tip.mass = 0.0;
    scene.solver.tolerance = 1e-10;
    let ride = Ride {
        scene,
        speed: -6.5,
        segments: vec![Segment {
            duration: 1e-3,
            acceleration: 0.0,
            support: 0.0,
        }],
        steps: 300_000,
    };
    ride.run(4).unwrap();
}
