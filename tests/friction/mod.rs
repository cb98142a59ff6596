//! Friction between the contacts: closed forms, its absence, and hard cases.

mod closed_forms;
mod unstable_slip;

use relay_contact::inputs::Inputs;
use relay_contact::scene::{Contact, Scene};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{FrictionKind, IntegerOutput, RealOutput};
use testing::scenes::{force_scale, forces, largest_difference, shaken, supported};

/// The scene with friction.
pub fn rubbing(mut scene: Scene) -> Scene {
    scene.effects.friction = FrictionKind::Coulomb;
    scene
}

/// Tangential over normal stiffness of the contact (Mindlin; MODEL equations written out).
fn stiffness_ratio(contact: &Contact) -> f64 {
    let both = [contact.moving, contact.fixed];
    let shear: f64 =
        both.iter().map(|of| (2.0 - of.poisson_ratio) / (of.youngs_modulus / (2.0 * (1.0 + of.poisson_ratio)))).sum();
    let normal: f64 = both.iter().map(|of| (1.0 - of.poisson_ratio * of.poisson_ratio) / of.youngs_modulus).sum();
    8.0 / shear / (2.0 / normal)
}

/// At the limit of no friction, and where the contact point lies on the neutral axis, the contact moves as without.
#[test]
fn a_contact_without_coefficient_or_height_moves_as_without_friction() {
    for amplitude in [98.0, 400.0] {
        let plain = shaken(amplitude, 1000.0);
        let tolerance = plain.solver.effective_tolerance();
        let expected = forces(&plain, 7e-6, 600);
        let largest = expected.iter().copied().fold(force_scale(&plain), f64::max);
        for (coefficient, height) in [(0.0, 1e-3), (0.2, 0.0)] {
            let mut scene = rubbing(plain.clone());
            (scene.friction.coefficient, scene.tip.contact_height) = (coefficient, height);
            let found = forces(&scene, 7e-6, 600);
            let wrong = largest_difference(&found, &expected) / largest;
            // Each is right to the tolerance.
            assert!(wrong < 2.0 * tolerance, "{amplitude} m/s2, mu {coefficient}, {height} m: {wrong:e}");
        }
    }
}

/// Extreme coefficients and heights, an opening at the limit, blows, and a contact released and closed by its support: all
/// run, within few steps, the friction force keeps to its limit, and no energy is made. Forces, slip and energy are compared with
/// another solution in `tests/python/test_friction.py`.
#[test]
fn friction_never_exceeds_its_limit_in_hard_cases() {
    for coefficient in [0.0, 0.2, 10.0] {
        for height in [0.0, 1e-3, 1e-2] {
            for (amplitude, damping) in [(30.0, 8e-5), (400.0, 8e-5), (1000.0, 1e-6), (400.0, 0.0)] {
                for initial in [-1.0, 0.0, 1.0] {
                    let mut scene = rubbing(shaken(amplitude, 700.0));
                    (scene.friction.coefficient, scene.tip.contact_height) = (coefficient, height);
                    (scene.friction.initial, scene.contact.damping) = (initial, damping);
                    scene.solver.tolerance = 1e-4;
                    scene.effects.energy = true;
                    let case = format!("mu {coefficient}, {height} m, {amplitude} m/s2, {damping} s, {initial}");
                    let mut simulation = match Simulation::new(&scene, &Inputs::default(), 0.0) {
                        Ok(simulation) => simulation,
                        Err(error) => {
                            assert!(coefficient * height * -initial > 0.0103, "{case}: {error}");
                            continue;
                        }
                    };
                    let (mut scale, mut distance, mut dissipated) = (force_scale(&scene), 0.0, 0.0);
                    for k in 0..100 {
                        let time = 3e-5 * f64::from(k);
                        // The support lifts and comes back.
                        let lifted = if k > 50 { 1e-5 * (0.1 * f64::from(k)).sin() } else { 0.0 };
                        simulation
                            .step(&supported(-lifted, 0.0), time, 3e-5)
                            .unwrap_or_else(|error| panic!("{case}: {error}"));
                        let force = simulation.real(RealOutput::ContactForce);
                        let along = simulation.real(RealOutput::ContactTangentialForce);
                        let greatest = force_scale(&scene).max(simulation.real(RealOutput::StepMaximumForce));
                        assert!(force.is_finite() && along.is_finite(), "{case}");
                        assert!(
                            along.abs() <= coefficient * force + 2e-4 * greatest * (1.0 + coefficient),
                            "{case}: {along} at {force} N, {time} s"
                        );
                        let now =
                            [RealOutput::ContactSlipDistance, RealOutput::FrictionEnergy].map(|of| simulation.real(of));
                        assert!(now[0] >= distance && now[1] >= dissipated, "{case}: {now:?} at {time} s");
                        ([distance, dissipated], scale) = (now, scale.max(greatest));
                    }
                    // A force wrong by the tolerance along the way of the contact.
                    let balance = simulation.real(RealOutput::EnergyBalance);
                    let allowed = scene.solver.tolerance * scale * (distance + 1e-6);
                    assert!(balance.abs() < allowed, "{case}: {balance:e} J of {allowed:e} J");
                    let steps = simulation.integer(IntegerOutput::SolverSteps)
                        + simulation.integer(IntegerOutput::SolverRejectedSteps);
                    assert!(steps < 20_000, "{case}: {steps} steps");
                }
            }
        }
    }
}
