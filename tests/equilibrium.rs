//! The static equilibrium of every combination of parts: it is where the motion comes to rest, whichever way the inputs took. The
//! motion knows springs by their modes and the equilibrium by their static compliances.

use std::f64::consts::PI;

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Model, Spring};
use relay_contact::scene::Scene;
use relay_contact::scene::spring::Shape;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, FrictionKind, PusherKind, RealOutput};
use testing::near;
use testing::springs;

/// Where support (m) and pusher (m) end, and the constant acceleration there (m/s2).
type End = (f64, f64, f64);

const OUTPUTS: [RealOutput; 7] = [
    RealOutput::ContactForce,
    RealOutput::ParallelForce,
    RealOutput::PusherForce,
    RealOutput::ContactTangentialForce,
    RealOutput::TipDisplacement,
    RealOutput::FixedDisplacement,
    RealOutput::ArmatureDisplacement,
];

pub fn parallel(scene: &mut Scene) {
    scene.effects.parallel_contact = true;
    scene.parallel.offset = if scene.spring.is_some() { 1e-5 } else { 2e-8 };
}

fn pushed(scene: &mut Scene) {
    scene.effects.pusher = PusherKind::Prescribed;
}

fn second(scene: &mut Scene) {
    scene.effects.second_contact = true;
    scene.effects.extremes = true;
    scene.second.gap = 5e-4;
}

fn relay(scene: &mut Scene) {
    scene.effects.pusher = PusherKind::Armature;
    scene.contact.overtravel = -5e-5;
}

fn forked(scene: &mut Scene) {
    scene.spring = springs::forked(scene, 0.7);
}

/// The moving spring by its modes.
fn by_modes(scene: &mut Scene) {
    let mut alone = scene.clone();
    alone.fixed_spring = None;
    let modes = springs::modes_of(&Model::new(&alone, 0.0).unwrap());
    scene.spring = springs::spring_file("modes.toml", Shape::Modes(modes));
}

pub fn on_spring(scene: &mut Scene) {
    scene.fixed_spring = springs::uniform_spring(scene, 1.0, 1.5);
}

/// Compressed by 0.4 of its buckling load.
fn compressed(scene: &mut Scene) {
    scene.effects.axial_force = AxialForceKind::Prescribed;
    scene.beam.axial_force = 0.4 * Spring::new(scene).statics.buckling_load();
}

/// Bent by half its length against a soft contact: the axial force is 0.4 of the buckling load and follows the tip.
pub fn bent(scene: &mut Scene) {
    scene.effects.axial_force = AxialForceKind::FromDeflection;
    scene.contact.overtravel = 8e-3;
    scene.contact.curvature_radius = 1e-4;
    scene.contact.moving.youngs_modulus = 1e8;
    scene.contact.fixed.youngs_modulus = 1e8;
}

fn rubbing(scene: &mut Scene) {
    scene.effects.friction = FrictionKind::Coulomb;
    scene.friction.coefficient = 0.5;
    scene.tip.contact_height = 2e-3;
}

fn at(share: f64, (support, pusher, acceleration): End) -> Inputs {
    Inputs {
        support_displacement: share * support,
        second_displacement: 1e-4,
        pusher_displacement: share * pusher,
        base_acceleration: share * acceleration,
        ..Inputs::default()
    }
}

/// Outputs once everything has moved there, gently, and come to rest are those of a start there, to a share of their size.
fn agree(scene: &Scene, end: End, allowed: f64) {
    let read = |simulation: &Simulation| OUTPUTS.map(|output| simulation.real(output));
    let (steps, size) = (400, 1e-4);
    let share = |n: u32| 0.5 - 0.5 * (PI * f64::from(n) / f64::from(steps)).cos();
    let mut moving = Simulation::new(scene, &at(0.0, end), 0.0).unwrap();
    // Between both fixed contacts, of which the second is rigid, the spring takes from one gap what it gives the other.
    let gaps = |simulation: &Simulation| {
        let outputs = [RealOutput::StepMinimumGap, RealOutput::ContactIndentation, RealOutput::FixedDisplacement];
        let [gap, indentation, fixed] = outputs.map(|output| simulation.real(output));
        scene.effects.second_contact.then_some(gap - indentation + fixed)
    };
    let between = gaps(&moving);
    for n in 0..steps {
        let rate = at((share(n + 1) - share(n)) / size, end);
        let inputs = Inputs {
            support_displacement_rate: rate.support_displacement,
            pusher_displacement_rate: rate.pusher_displacement,
            base_acceleration_rate: rate.base_acceleration,
            ..at(share(n), end)
        };
        moving.step(&inputs, f64::from(n) * size, size).unwrap();
    }
    for size in [0.2, size] {
        moving.step(&at(1.0, end), moving.time(), size).unwrap();
    }
    if let Some((found, expected)) = gaps(&moving).zip(between) {
        near("gap", found, expected, 1e-11);
    }
    // Gravity is a constant acceleration that belongs to the equilibrium.
    let (support, pusher, gravity) = end;
    let mut heavy = scene.clone();
    heavy.environment.gravity = gravity;
    let there = at(1.0, (support, pusher, 0.0));
    let mut started = Simulation::new(&heavy, &there, 0.0).unwrap();
    let first = read(&started);
    started.step(&there, 0.0, 1e-4).unwrap();
    assert_eq!(read(&started), first, "it stays");
    let [force, other, ..] = first;
    assert!(force > 0.0 && (other > 0.0) == scene.effects.parallel_contact);
    for ((output, found), expected) in OUTPUTS.iter().zip(read(&moving)).zip(first) {
        near(format_args!("{output:?}"), found, expected, allowed * expected.abs());
    }
}

fn scene(overtravel: f64, parts: &[fn(&mut Scene)]) -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    scene.contact.overtravel = overtravel;
    scene.solver.tolerance = 1e-8;
    for part in parts {
        part(&mut scene);
    }
    scene
}

#[test]
fn motion_comes_to_rest_in_the_equilibrium_of_all_parts() {
    let cases: [&[fn(&mut Scene)]; 9] = [
        &[bent],
        &[parallel, pushed],
        &[parallel, on_spring],
        &[forked, parallel, pushed, on_spring, compressed],
        &[second, pushed, compressed],
        &[second, on_spring],
        &[parallel, relay],
        &[parallel, pushed, by_modes],
        &[forked, parallel, pushed, on_spring, by_modes],
    ];
    for parts in cases {
        agree(&scene(1e-4, parts), (3e-5, 1e-4, 50.0), 1e-9);
    }
}

/// As closing slides all the way.
#[test]
fn contacts_that_close_gently_rest_in_the_equilibrium_with_friction() {
    let cases: [&[fn(&mut Scene)]; 5] = [&[], &[pushed], &[on_spring], &[compressed], &[pushed, by_modes]];
    for parts in cases {
        let scene = scene(-1e-5, &[&[rubbing as fn(&mut Scene)], parts].concat());
        agree(&scene, (1.5e-4, 2e-5, 0.0), 2e-3);
    }
}

/// Under its own axial force a spring leaves the contact until nothing holds it, and is refused from there on; one that is pressed onto the
/// contact stands any acceleration.
#[test]
fn a_spring_under_great_accelerations_rests_or_is_refused() {
    let mut scene = scene(-1e-2, &[]);
    scene.effects.axial_force = AxialForceKind::FromPreload;
    scene.solver.modes = 4;
    let mut rests = |gravity: f64, overtravel: f64| {
        (scene.environment.gravity, scene.contact.overtravel) = (gravity, overtravel);
        Model::new(&scene, 0.0).ok().map(|model| (model.preload.force, model.preload.indentation))
    };
    let accelerations = (0..200).map(|k| 9e3 * 1.005_f64.powi(k));
    let (mut force, mut indentation) = (0.0, 0.0);
    let mut alone = Vec::new();
    for acceleration in accelerations {
        let (pressed, _) = rests(acceleration, 1e-4).unwrap();
        assert!(pressed > force, "{acceleration} m/s2: {pressed} N");
        force = pressed;
        let left = rests(-acceleration, -1e-2);
        if let Some((_, left)) = left {
            assert!(left < indentation, "{acceleration} m/s2: {left} m");
            indentation = left;
        }
        alone.push(left.is_some());
    }
    // At 1.06e4 m/s2.
    assert!((30..40).contains(&alone.partition_point(|rests| *rests)) && alone.is_sorted_by(|a, b| a >= b));
}
