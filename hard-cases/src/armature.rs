//! The whole relay: an armature between core and rest stop, whose pusher presses the spring.

use anyhow::{Result, ensure};
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{PusherKind, RealOutput};
use testing::scenes::accelerated;

use crate::case::{Check, cases, closest};
use crate::ride::{Ride, Segment, conserved};
use testing::rig::Rig;

cases! { CASES:
    "Armature that never comes to rest", "no damping of armature and stops: it bounces on core and spring without end"
        => thrown(without_end(), true);
    "Armature without damping anywhere, thrown off its core",
        "springs, contact, pusher and stops exchange energy that nothing dissipates"
        => undamped();
    "Armature without hold force", "a coil with current that pulls nothing: it rests at its stop, thrown against the spring"
        => closest([1500.0, -1500.0].map(|acceleration| shaken(changed(|scene| scene.armature.hold_force = 0.0), acceleration)));
    "Armature unbalanced the other way", "the base presses the spring closed and takes the armature from its core"
        => shaken(changed(|scene| scene.armature.unbalance = -1.0), 1500.0);
    "Armature on stops of 10⁹ N/m", "blows of 9 µs, 700 times shorter than the flight between them"
        => thrown(changed(|scene| scene.armature.stop_stiffness = 1e9), true);
    "Armature on soft stops", "stops of 10³ N/m, which give way by millimetres"
        => thrown(changed(|scene| scene.armature.stop_stiffness = 1e3), false);
}

/// A relay with an open contact that its armature closes, and which a shock opens.
fn relay() -> Scene {
    let mut scene = Scene::default();
    scene.effects.pusher = PusherKind::Armature;
    scene.contact.overtravel = -5e-5;
    scene.contact.damping = 1e-6;
    scene.armature.unbalance = 1.0;
    // A magnet that draws it back from any place.
    scene.armature.gap_constant = 5e-4;
    scene
}

fn changed(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = relay();
    change(&mut scene);
    scene
}

fn without_end() -> Scene {
    changed(|scene| {
        scene.armature.damping = 0.0;
        scene.armature.stop_restitution = 1.0;
    })
}

/// An acceleration (m/s2) for 1.5 ms, and what follows.
fn segments(acceleration: f64) -> [Segment; 3] {
    [(1.5e-3, acceleration), (1.5e-3, 0.0), (7e-3, 0.0)]
        .map(|(duration, acceleration)| Segment::accelerated(duration, acceleration))
}

fn shaken(scene: Scene, acceleration: f64) -> Result<Vec<Check>> {
    Ride::new(scene, segments(acceleration)).checks_of_large_forces()
}

/// Thrown from its core by a shock; `back` says whether it has to be there again.
fn thrown(scene: Scene, back: bool) -> Result<Vec<Check>> {
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let mut furthest = 0.0_f64;
    for segment in segments(-1500.0) {
        let inputs = accelerated(segment.acceleration, 0.0);
        for _ in 0..100 {
            simulation.step(&inputs, simulation.time(), segment.duration / 100.0)?;
            furthest = furthest.max(simulation.real(RealOutput::ArmatureGap));
        }
    }
    ensure!(furthest > 1e-4, "only {furthest} m from its core");
    let release = simulation.real(RealOutput::ArmatureLastRelease);
    ensure!(release > if back { 1.5e-3 } else { 0.0 }, "released last at {release} s");
    shaken(scene, -1500.0)
}

fn undamped() -> Result<Vec<Check>> {
    let mut scene = without_end();
    scene.beam.stiffness_damping = 0.0;
    scene.contact.damping = 0.0;
    scene.pusher.damping = 0.0;
    let mut rig = Rig::new(Model::new(&scene, 0.0)?);
    rig.throw(0.5);
    conserved(rig, 3000)
}
