//! Extreme springs.

use crate::common::undamped;
use crate::ride::{Ride, Segment};
use relay_contact::beam::section::Section;
use relay_contact::error::SceneError;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::AxialForceKind;

#[test]
fn a_spring_without_damping() {
    let mut scene = Scene::default();
    scene.beam.stiffness_damping = 0.0;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn a_system_without_damping() {
    Ride::shaken(undamped()).keeps_its_properties();
}

#[test]
fn a_system_without_damping_thrown_at_the_contact() {
    let scene = undamped();
    let segment = Segment {
        duration: 7.8e-5,
        acceleration: 0.0,
        support: 0.0,
    };
    let ride = Ride {
        scene,
        speed: -4.0,
        segments: vec![segment],
        steps: 100_000,
    };
    let outcome = ride.run(4).unwrap();
    assert!(outcome.balances(&scene), "{}", outcome.account(&scene));
}

/// From rest the energy of the motion itself gives no measure for its rounding.
#[test]
fn a_system_without_damping_pushed_slowly() {
    let mut scene = undamped();
    scene.solver.tolerance = 1e-10;
    let segment = |support| Segment {
        duration: 1e-5,
        acceleration: 0.0,
        support,
    };
    let ride = Ride {
        scene,
        speed: 0.0,
        segments: vec![segment(3e-8), segment(6e-8), segment(4e-8)],
        steps: 10_000,
    };
    ride.keeps_its_properties();
}

#[test]
fn a_spring_of_strong_damping() {
    let mut scene = Scene::default();
    scene.beam.stiffness_damping = 1e-2;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn a_spring_without_rivet() {
    let mut scene = Scene::default();
    scene.tip.mass = 0.0;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn an_axial_force_just_below_buckling() {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::Prescribed;
    scene.beam.axial_force = 0.999 * Section::new(&scene).buckling_load();
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn an_axial_force_above_buckling_is_an_error_that_says_so() {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::Prescribed;
    let limit = Section::new(&scene).buckling_load();
    for force in [limit, 1.001 * limit, 2.0 * limit, 100.0 * limit, 1e6] {
        scene.beam.axial_force = force;
        assert_eq!(
            Model::new(&scene, 0.0).err(),
            Some(SceneError::Buckled {
                name: "beam.axialForce",
                value: force,
                limit
            })
        );
    }
}

/// A push so weak that the force stays within the tolerance: there is nothing to resolve, whatever rings above a
/// gigahertz.
#[test]
fn a_push_below_the_tolerance_on_a_short_light_spring_without_damping() {
    let mut scene = Scene::default();
    scene.beam.length = 1e-3;
    scene.beam.density = 1.0;
    scene.beam.stiffness_damping = 0.0;
    scene.tip.mass = 0.0;
    let segment = Segment {
        duration: 1e-5,
        acceleration: 4.6,
        support: 0.0,
    };
    let ride = Ride {
        scene,
        speed: 0.0,
        segments: vec![segment],
        steps: 1000,
    };
    ride.keeps_its_properties();
}
