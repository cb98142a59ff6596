//! The energy balance of the component, `energy.balance`. Unit tests of the integrator check it independently.

use anyhow::Result;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::scenes::accelerated;
use testing::worst;

use crate::case::Check;

/// Communication step, s.
const STEP: f64 = 1e-6;

/// Simulates a scene until `stop` (s) with a base acceleration (m/s2) held over each microsecond.
pub(crate) fn balances(mut scene: Scene, stop: f64, acceleration: impl Fn(f64) -> f64) -> Result<Vec<Check>> {
    scene.effects.energy = true;
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let (mut off, mut path, mut pull) = (0.0, 0.0, 0.0);
    let mut step = 0_u32;
    while f64::from(step) * STEP < stop {
        let time = f64::from(step) * STEP;
        let inputs = accelerated(acceleration(time), 0.0);
        let before = contact.real(RealOutput::ContactIndentation);
        contact.step(&inputs, time, STEP)?;
        path += (contact.real(RealOutput::ContactIndentation) - before).abs();
        off = worst(off, contact.real(RealOutput::EnergyBalance).abs());
        pull = worst(pull, -contact.real(RealOutput::StepMinimumForce));
        step += 1;
    }
    let allowed = scene.solver.effective_tolerance() * contact.model().force_scale * path;
    Ok(vec![
        Check::energy("energy in = stored + dissipated", off, allowed),
        Check::exact("the contact force is never tensile", pull, "N"),
    ])
}

/// The square wave of [`crate::ride::Ride::shaken`].
pub(crate) fn square(time: f64) -> f64 {
    match time {
        time if time >= 1.2e-3 => 0.0,
        time if time.rem_euclid(6e-4) < 3e-4 => 500.0,
        _ => -500.0,
    }
}
