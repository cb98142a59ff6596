//! Friction between the contacts: closed forms, its absence, the tolerance, energy, and hard cases.

mod closed_forms;
mod unstable_slip;

use relay_contact::inputs::Inputs;
use relay_contact::scene::{Contact, Scene};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{FrictionKind, IntegerOutput, RealOutput};
use testing::scenes::{
    NEAR, Three, check_slope, course, force_scale, forces, largest_difference, range, shaken, supported, threes,
};

/// The scene with friction.
fn rubbing(mut scene: Scene) -> Scene {
    scene.effects.friction = FrictionKind::Coulomb;
    scene
}

/// Tangential over normal stiffness of the contact (Mindlin; MODEL equations written out).
fn stiffness_ratio(contact: &Contact) -> f64 {
    let both = [contact.moving, contact.fixed];
    let shear: f64 = both
        .iter()
        .map(|of| (2.0 - of.poisson_ratio) / (of.youngs_modulus / (2.0 * (1.0 + of.poisson_ratio))))
        .sum();
    let normal: f64 = both
        .iter()
        .map(|of| (1.0 - of.poisson_ratio * of.poisson_ratio) / of.youngs_modulus)
        .sum();
    8.0 / shear / (2.0 / normal)
}

const WATCHED: [RealOutput; 7] = [
    RealOutput::ContactForce,
    RealOutput::ContactTangentialForce,
    RealOutput::ContactSlip,
    RealOutput::ContactSlipDistance,
    RealOutput::FrictionEnergy,
    RealOutput::StepMinimumForce,
    RealOutput::StepMaximumForce,
];

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
            println!("{amplitude} m/s2, mu {coefficient}, {height} m: {wrong:e}");
            // Each is right to the tolerance.
            assert!(wrong < 2.0 * tolerance, "{wrong:e}");
        }
    }
}

/// Force, friction force (both relative to the force scale and the largest force), slip and energy (relative to the largest)
/// against the same scene at a tolerance a hundred times tighter than the tightest asked.
#[test]
fn the_tolerance_is_kept_and_no_energy_is_made() {
    for (amplitude, coefficient, height, damping) in [
        (98.0, 0.2, 1e-3, 8.063e-5),
        (400.0, 0.2, 1e-3, 8.063e-5),
        (400.0, 1.0, 1e-3, 2e-6),
        (150.0, 0.1, 3e-3, 1e-6),
        (60.0, 0.3, 2e-3, 0.0),
    ] {
        let mut scene = rubbing(shaken(amplitude, 1000.0));
        (scene.friction.coefficient, scene.tip.contact_height) = (coefficient, height);
        scene.contact.damping = damping;
        scene.effects.energy = true;
        // The number of modes is another question.
        scene.solver.modes = 20;
        let scale = force_scale(&scene);
        let rows = |tolerance: f64| {
            let mut scene = scene.clone();
            scene.solver.tolerance = tolerance;
            course(&scene, 9e-6, 500, WATCHED)
        };
        let (expected, _) = rows(1e-10);
        for tolerance in [1e-4, 1e-6] {
            let (found, simulation) = rows(tolerance);
            let mut errors = WATCHED.map(|_| 0.0_f64);
            let mut largest = WATCHED.map(|_| scale);
            for (n, error) in errors.iter_mut().enumerate() {
                if (2..5).contains(&n) {
                    largest[n] = expected
                        .iter()
                        .map(|row| row[n].abs())
                        .fold(f64::MIN_POSITIVE, f64::max);
                }
                let mut so_far = largest[n];
                for (row, other) in found.iter().zip(&expected) {
                    if !(2..5).contains(&n) {
                        so_far = so_far.max(other[0]);
                    }
                    *error = error.max((row[n] - other[n]).abs() / so_far);
                }
            }
            let balance = simulation.real(RealOutput::EnergyBalance);
            let path: f64 = found
                .windows(2)
                .map(|pair| (pair[1][2] - pair[0][2]).abs())
                .sum::<f64>()
                + 1e-6;
            println!(
                "{amplitude} m/s2, mu {coefficient}, {height} m, {damping} s at {tolerance:e}: {:?} tolerances, {balance:e} J, steps {} + {}",
                errors.map(|error| error / tolerance),
                simulation.integer(IntegerOutput::SolverSteps),
                simulation.integer(IntegerOutput::SolverRejectedSteps)
            );
            for (n, error) in errors.iter().enumerate() {
                // Slip and energy are integrals of what is right to the tolerance.
                let allowed = if (2..5).contains(&n) { 10.0 } else { 1.0 };
                assert!(*error < allowed * tolerance, "{:?}: {error:e}", WATCHED[n]);
            }
            assert!(balance.abs() < tolerance * scale * path * 100.0, "{balance:e} J");
        }
        // Energy dissipated and distance never fall.
        for pair in expected.windows(2) {
            assert!(pair[1][3] >= pair[0][3] && pair[1][4] >= pair[0][4]);
        }
    }
}

/// A derivative lies between the slopes just before and just after it.
#[test]
fn derivatives_are_the_slopes_of_the_courses() {
    const CONTINUOUS: [RealOutput; 5] = [
        RealOutput::ContactForce,
        RealOutput::ContactTangentialForce,
        RealOutput::ContactSlip,
        RealOutput::ContactSlipDistance,
        RealOutput::FrictionEnergy,
    ];
    for (size, damping) in [(1e-6, 8.063e-5), (1e-5, 8.063e-5), (1e-5, 0.0)] {
        let mut scene = rubbing(shaken(98.0, 1000.0));
        scene.solver.tolerance = 1e-9;
        scene.contact.damping = damping;
        let rows = threes(&scene, &Inputs::default(), CONTINUOUS, size);
        for (n, output) in CONTINUOUS.into_iter().enumerate() {
            let noise = 4.0 * 1e-9 * range(&rows, n).max(if n == 1 { 0.15 } else { 0.0 }) / NEAR;
            let slips = |row: &Three<5>| row.map(|at| at[2].1 != 0.0);
            let mut since = 0.0;
            for (row, next) in rows.iter().zip(&rows[1..]) {
                // The slope of the friction force jumps where it begins or ceases to slip, and the spring answers within
                // microseconds.
                since += size;
                if slips(row) != slips(next) {
                    since = 0.0;
                }
                if since < 2e-5 {
                    continue;
                }
                check_slope(next, n, noise, &format!("{output:?}, {size} s, {damping} s"));
            }
        }
    }
}

/// Extreme coefficients and heights, an opening at the limit, blows, and a contact released and closed by its support: all
/// run, within few steps, and the friction force keeps to its limit.
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
                    let case = format!("mu {coefficient}, {height} m, {amplitude} m/s2, {damping} s, {initial}");
                    let mut simulation = match Simulation::new(&scene, &Inputs::default(), 0.0) {
                        Ok(simulation) => simulation,
                        Err(error) => {
                            assert!(coefficient * height * -initial > 0.0103, "{case}: {error}");
                            continue;
                        }
                    };
                    for k in 0..100 {
                        let time = 3e-5 * f64::from(k);
                        // The support lifts and comes back.
                        let inputs = supported(
                            if k > 50 {
                                -1e-5 * (0.1 * f64::from(k)).sin()
                            } else {
                                0.0
                            },
                            0.0,
                        );
                        simulation
                            .step(&inputs, time, 3e-5)
                            .unwrap_or_else(|error| panic!("{case}: {error}"));
                        let force = simulation.real(RealOutput::ContactForce);
                        let along = simulation.real(RealOutput::ContactTangentialForce);
                        let scale = force_scale(&scene).max(simulation.real(RealOutput::StepMaximumForce));
                        assert!(force.is_finite() && along.is_finite(), "{case}");
                        assert!(
                            along.abs() <= coefficient * force + 2e-4 * scale * (1.0 + coefficient),
                            "{case}: {along} at {force} N, {time} s"
                        );
                    }
                    let steps = simulation.integer(IntegerOutput::SolverSteps)
                        + simulation.integer(IntegerOutput::SolverRejectedSteps);
                    assert!(steps < 20_000, "{case}: {steps} steps");
                }
            }
        }
    }
}
