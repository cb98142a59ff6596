//! Extreme springs.

use anyhow::Result;
use relay_contact::scene::Scene;

use crate::case::{Check, cases};
use crate::ride::{Ride, Segment, changed};
use testing::scenes::{press, undamped};

cases! { CASES:
    "Spring without damping", "only the contact dissipates"
        => shaken(|scene| scene.beam.stiffness_damping = 0.0);
    "Spring with damping of 10 ms", "every mode is overdamped"
        => shaken(|scene| scene.beam.stiffness_damping = 1e-2);
    "System without damping, under vibration", "no damping removes energy added by errors"
        => Ride::shaken(undamped()).checks();
    "System without damping, launched at the contact at 4 m/s", "no damping removes energy added by errors"
        => thrown();
    "System without damping, pushed by some 10 nm, tolerance 1e-10",
        "starting from rest, the energy gives no scale for rounding errors"
        => pushed();
    "Spring without rivet", "without its mass the tip follows the high modes most"
        => shaken(|scene| scene.tip.mass = 0.0);
    "Short light spring without damping, pushed within the tolerance",
        "modes above a gigahertz, which need not be resolved: at most 1000 integration steps"
        => pushed_within_tolerance();
    "Axial force at 0.999 of the buckling load", "the open spring has almost no stiffness left"
        => shaken(|scene| press(scene, 0.999));
}

pub(crate) fn shaken(change: impl FnOnce(&mut Scene)) -> Result<Vec<Check>> {
    Ride::shaken(changed(change)).checks()
}

fn thrown() -> Result<Vec<Check>> {
    let ride = Ride { speed: -4.0, ..Ride::new(undamped(), [Segment::accelerated(7.8e-5, 0.0)]) };
    Ok(vec![ride.run(4)?.energy()])
}

fn pushed() -> Result<Vec<Check>> {
    let mut scene = undamped();
    scene.solver.tolerance = 1e-10;
    Ride { steps: 10_000, ..Ride::new(scene, [3e-8, 6e-8, 4e-8].map(|support| Segment::moved(1e-5, support))) }.checks()
}

/// A push so weak that the force change stays within the tolerance and need not be resolved.
fn pushed_within_tolerance() -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.beam.length = 1e-3;
    scene.beam.density = 1.0;
    scene.beam.stiffness_damping = 0.0;
    scene.tip.mass = 0.0;
    Ride { steps: 1000, ..Ride::new(scene, [Segment::accelerated(1e-5, 4.6)]) }.checks()
}
