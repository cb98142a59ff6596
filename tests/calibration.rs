//! The calibration of the integrator: the error stays below the tolerance asked, and a digit costs few steps. How much below,
//! beside other integrators, is measured by the package `benches`.
//!
//! The error is the largest deviation of `contact.force` and its extremes from a reference, over the larger of the force scale and the
//! largest force so far, as `solver.tolerance` promises. The reference has more modes and much shorter steps than the tightest run; a
//! second reference with other modes and steps shows its own error. Costs are counts of integration steps, which are the same on every machine.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::IntegerOutput;
use testing::relays::{Course, Relay};
use testing::scenes::{shaken, supported};

/// The contact stays closed; opens and closes with blows; is closed by its support.
fn relays() -> Vec<Relay> {
    let shaken = |name, amplitude, frequency, steps| Relay::of(name, shaken(amplitude, frequency), steps);
    let mut closing = Relay::of("closing by the support", Scene::default(), (1e-5, 300));
    closing.scene.contact.overtravel = -3e-5;
    // From 30 um of gap to the overtravel of the specimen and some more, within 1.5 ms.
    closing.knots = (0..300).map(|k| supported(2.6e-4 * f64::from(k.min(150)) / 150.0, 0.0)).collect();
    vec![
        shaken("98 m/s2 at 1000 Hz", 98.0, 1000.0, (1e-5, 500)),
        shaken("98 m/s2 at 250 Hz", 98.0, 250.0, (2e-5, 500)),
        shaken("98 m/s2 at 2000 Hz", 98.0, 2000.0, (1e-5, 500)),
        shaken("98 m/s2 in one step per ms", 98.0, 1000.0, (1e-3, 10)),
        shaken("chatter at 400 m/s2", 400.0, 1000.0, (2.5e-7, 12_000)),
        closing,
    ]
}

fn run(relay: &Relay, tolerance: f64, modes: i32, maximum_step: f64) -> Course {
    let (course, failure) = relay
        .run(|scene| {
            (scene.solver.tolerance, scene.solver.modes, scene.solver.maximum_step) = (tolerance, modes, maximum_step);
        })
        .unwrap();
    assert_eq!(failure, None, "{}", relay.kind);
    course
}

#[test]
fn the_error_stays_below_the_tolerance_asked() {
    let mut failures = Vec::new();
    for relay in relays() {
        let reference = run(&relay, 1e-11, 34, 5e-7);
        let error = |tolerance, modes, maximum_step| run(&relay, tolerance, modes, maximum_step).error(&reference);
        let own = error(1e-11, 30, 1.1e-6);
        assert!(own < 1e-8, "{}: {own:e}", relay.kind);
        let tolerances = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10].into_iter();
        // What the reference itself does not know is not asked: microseconds after a blow of some newtons, 1e-9.
        for tolerance in tolerances.filter(|tolerance| *tolerance > 5.0 * own) {
            let error = error(tolerance, 0, 0.0);
            if error > tolerance {
                failures.push(format!("{}: asked {tolerance:e}, delivered {error:.2e}", relay.kind));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_digit_costs_less_than_half_as_much_again() {
    for relay in relays() {
        let steps = |tolerance: f64| f64::from(run(&relay, tolerance, 0, 0.0).steps);
        let per_digit = (steps(1e-10) / steps(1e-2)).powf(1.0 / 8.0);
        assert!(per_digit < 1.5, "{}: {per_digit}", relay.kind);
    }
}

/// After a closing a leap by the root of time takes the place of steps that begin with a fraction of a nanosecond: without it there
/// are 27 in each period, rejected ones included.
#[test]
fn a_blow_takes_few_steps() {
    let mut scene = shaken(400.0, 1000.0);
    scene.solver.tolerance = 1e-2;
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    for k in 0..20 {
        contact.step(&Inputs::default(), f64::from(k) * 1e-3, 1e-3).unwrap();
    }
    let of = |output| contact.integer(output);
    let steps = of(IntegerOutput::SolverSteps) + of(IntegerOutput::SolverRejectedSteps);
    assert!(of(IntegerOutput::ChatterCount) > 15 && steps < 20 * 20, "{steps}");
}

/// A rejected step costs as much as one that is taken, and no result shows it.
#[test]
fn few_steps_are_rejected_at_any_tolerance() {
    for (amplitude, frequency) in [(400.0, 1000.0), (700.0, 1700.0), (900.0, 400.0)] {
        for damping in [1.0, 0.1, 0.01] {
            for exponent in [2, 4, 6, 8, 10] {
                let mut scene = shaken(amplitude, frequency);
                scene.beam.stiffness_damping *= damping;
                scene.solver.tolerance = 0.1_f64.powi(exponent);
                let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                contact.step(&Inputs::default(), 0.0, 2e-2).unwrap();
                let of = |output| contact.integer(output);
                let (taken, rejected) = (of(IntegerOutput::SolverSteps), of(IntegerOutput::SolverRejectedSteps));
                assert!(
                    taken > 100 && 4 * rejected < taken,
                    "{amplitude} m/s2, {frequency} Hz, {damping}, 1e-{exponent}: {rejected} beside {taken}"
                );
            }
        }
    }
}
