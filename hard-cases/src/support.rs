//! A fixed contact that moves.

use anyhow::{Context as _, Result, ensure};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, RealOutput};
use testing::scenes::supported;

use crate::case::{Check, cases, closest};
use crate::contact::with_overtravel;
use crate::ride::{Ride, Segment};

cases! { CASES:
    "Fixed contact that closes from contact without force", "the contact closes at the very start"
        => touch_at_the_start();
    "Open for a second, then closing", "a second of free motion, then an impact"
        => open_for_a_second();
    "Fixed contact that closes by 1 mm in 10, 1 and 0.1 ms",
        "five times the overtravel of the specimen, at up to 10 m/s"
        => crushing();
    "Fixed contact that closes by 1 mm in 0.1 ms, retracts for a second and returns",
        "impacts of the fixed contact at 10 and 0.3 m/s, and a second without contact"
        => crushed_and_back();
    "Fixed contact that retracts at 1 mm/s", "the force passes through all orders of magnitude to zero"
        => withdrawing();
    "Overtravels from 10⁻²⁰ m down to the smallest number above zero",
        "forces so small that floating-point numbers lose digits (subnormal)"
        => closest([1e-20, 1e-100, 1e-200, 1e-290, 1e-306, 1e-312, 5e-324].map(|overtravel| {
            Ride::shaken(with_overtravel(overtravel)).checks()
        }));
}

fn touch_at_the_start() -> Result<Vec<Check>> {
    let ride = Ride::new(with_overtravel(0.0), [Segment::moved(1e-3, 1e-4)]);
    let closing = ride.run(1)?.rig.state.contact().last_closing;
    let mut checks = ride.checks()?;
    let closing = closing.context("no closing reported")?;
    checks.push(Check::instants("the contact closes at the start", closing));
    Ok(checks)
}

fn open_for_a_second() -> Result<Vec<Check>> {
    let segments = [(1e-3, -3e-4), (1.0, -3e-4), (1e-3, 0.0), (0.02, 0.0)];
    let segments = segments.map(|(duration, support)| Segment::moved(duration, support));
    let (outcome, mut checks) = Ride::new(Scene::default(), segments).checked()?;
    let preload = outcome.rig.model.preload.force;
    ensure!(outcome.forces.len() == segments.len());
    let off = (outcome.forces[3] - preload).abs();
    checks.extend([
        Check::exact("no force after a second without contact", outcome.forces[1].abs(), "N"),
        Check::tolerance("the force returns to the preload force", off, 1e-6 * preload, "N"),
    ]);
    Ok(checks)
}

fn crushing() -> Result<Vec<Check>> {
    closest([1e-2, 1e-3, 1e-4].map(|duration| {
        let segments = [Segment::moved(duration, 1e-3), Segment::moved(1e-3, 1e-3)];
        Ride { steps: 1_000_000, ..Ride::new(Scene::default(), segments) }.checks()
    }))
}

fn crushed_and_back() -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    let moved = |displacement: f64| supported(displacement, 0.0);
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let tolerance = scene.solver.effective_tolerance();
    let allowed = tolerance * contact.model().force_scale;
    let preload = contact.real(RealOutput::ContactForce);
    let mut least = f64::INFINITY;
    let mut to = |displacement: f64, duration: f64| {
        let time = contact.time();
        contact.step(&moved(displacement), time, duration)?;
        least = least.min(contact.real(RealOutput::StepMinimumForce));
        Ok::<_, anyhow::Error>(contact.real(RealOutput::ContactForce))
    };
    to(1e-3, 1e-4)?;
    let crushed = to(1e-3, 0.05)?;
    let expected = Simulation::new(&scene, &moved(1e-3), 0.0)?.real(RealOutput::PreloadForce);
    to(-3e-4, 1e-3)?;
    to(-3e-4, 1.0)?;
    to(0.0, 1e-3)?;
    let back = to(0.0, 0.05)?;
    let at_statics = "the force reaches the static one of 1 mm more overtravel";
    Ok(vec![
        Check::tolerance(at_statics, (crushed - expected).abs(), tolerance * expected, "N"),
        Check::tolerance("the force returns to the preload force", (back - preload).abs(), allowed, "N"),
        Check::exact("the contact force is never tensile", -least.min(0.0), "N"),
    ])
}

fn withdrawing() -> Result<Vec<Check>> {
    let ride = Ride::new(Scene::default(), [Segment::moved(0.2, -2.01e-4)]);
    let (outcome, mut checks) = ride.checked()?;
    ensure!(outcome.forces.len() == 1);
    let open = outcome.forces[0].abs();
    checks.push(Check::exact("no force once the contact is open", open, "N"));
    Ok(checks)
}
