//! The calibration of the integrator: the error stays below the tolerance asked, and a digit costs few steps. How much below,
//! beside other integrators, is measured by the package `benches`.
//!
//! The error is the largest deviation of `contact.force` at the communication points from a reference, over the larger of the
//! force scale and the largest force so far, as `solver.tolerance` promises. The reference has more modes and much shorter steps than the tightest run; a second reference with other modes and steps
//! shows its own error. Costs are counts of integration steps, which are the same on every machine.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealOutput};
use testing::scenes::{force_scale, shaken, supported};

/// A scene and how it is driven.
struct Case {
    name: &'static str,
    scene: Scene,
    /// Lengths of the communication steps, s.
    steps: Vec<f64>,
    /// `support.displacement` as a function of time, m; moves the contact from step to step.
    support: fn(f64) -> f64,
}

/// Forces at the communication points, the force scale and the integration steps.
struct Run {
    forces: Vec<f64>,
    scale: f64,
    steps: i32,
}

impl Case {
    fn run(&self, tolerance: f64, modes: i32, maximum_step: f64) -> Run {
        let mut scene = self.scene.clone();
        scene.solver.tolerance = tolerance;
        scene.solver.modes = modes;
        scene.solver.maximum_step = maximum_step;
        let mut inputs = supported((self.support)(0.0), 0.0);
        let mut simulation = Simulation::new(&scene, &inputs, 0.0).unwrap();
        let mut forces = Vec::new();
        let mut time = 0.0;
        for &step in &self.steps {
            inputs.support_displacement = (self.support)(time + step);
            simulation.step(&inputs, time, step).unwrap();
            time += step;
            forces.push(simulation.real(RealOutput::ContactForce));
        }
        Run {
            forces,
            scale: force_scale(&scene),
            steps: simulation.integer(IntegerOutput::SolverSteps),
        }
    }
}

impl Run {
    fn error(&self, reference: &Self) -> f64 {
        let mut scale = reference.scale;
        let pairs = self.forces.iter().zip(&reference.forces);
        pairs.fold(0.0, |most, (own, exact)| {
            scale = scale.max(*exact);
            f64::max(most, (own - exact).abs() / scale)
        })
    }
}

/// Lengths from 0.1 us to 0.1 ms that add up to about `total` (s), the same on every run: the fractional parts of
/// multiples of the golden ratio.
fn irregular(total: f64) -> Vec<f64> {
    let mut lengths = Vec::new();
    let mut sum = 0.0;
    for k in 1_u16.. {
        let part = (f64::from(k) * 0.618_033_988_749_894_9).fract();
        let length = 1e-7 * 1000_f64.powf(part);
        sum += length;
        if sum > total {
            break;
        }
        lengths.push(length);
    }
    lengths
}

fn still(_: f64) -> f64 {
    0.0
}

/// From 30 um of gap to the overtravel of the specimen and some more, within 1.5 ms.
fn closing(time: f64) -> f64 {
    2.6e-4 * (time / 1.5e-3).min(1.0)
}

fn case(name: &'static str, scene: Scene, steps: Vec<f64>, support: fn(f64) -> f64) -> Case {
    Case {
        name,
        scene,
        steps,
        support,
    }
}

/// The contact stays closed.
fn closed() -> Vec<Case> {
    vec![
        case("98 m/s2 at 1000 Hz", shaken(98.0, 1000.0), vec![1e-5; 500], still),
        case("98 m/s2 at 250 Hz", shaken(98.0, 250.0), vec![2e-5; 500], still),
        case("98 m/s2 at 2000 Hz", shaken(98.0, 2000.0), vec![1e-5; 500], still),
        case(
            "98 m/s2 in one step per ms",
            shaken(98.0, 1000.0),
            vec![1e-3; 10],
            still,
        ),
        case("irregular steps", shaken(98.0, 1000.0), irregular(5e-3), still),
    ]
}

/// The contact opens and closes with blows; looked at closely after the first.
fn blows() -> Vec<Case> {
    let mut open = Scene::default();
    open.contact.overtravel = -3e-5;
    let mut chatter = vec![5e-6; 217];
    chatter.resize(chatter.len() + 40, 2.5e-7);
    chatter.resize(chatter.len() + 381, 5e-6);
    vec![
        case("chatter at 400 m/s2", shaken(400.0, 1000.0), chatter, still),
        case("closing by the support", open, vec![1e-5; 300], closing),
    ]
}

const TOLERANCES: [f64; 9] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// Fails where an error exceeds its tolerance.
fn check(cases: &[Case]) {
    let mut failures = Vec::new();
    for case in cases {
        let reference = case.run(1e-11, 34, 5e-7);
        let own = case.run(1e-11, 30, 1.1e-6).error(&reference);
        assert!(own < 1e-8, "{}", case.name);
        // What the reference itself does not know is not asked: microseconds after a blow of some newtons, 1e-9.
        for tolerance in TOLERANCES.into_iter().filter(|tolerance| *tolerance > 5.0 * own) {
            let error = case.run(tolerance, 0, 0.0).error(&reference);
            if error > tolerance {
                failures.push(format!("{}: asked {tolerance:e}, delivered {error:.2e}", case.name));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn the_error_of_a_closed_contact_stays_below_the_tolerance_asked() {
    check(&closed());
}

#[test]
fn the_error_of_a_bouncing_contact_stays_below_the_tolerance_asked() {
    check(&blows());
}

#[test]
fn a_digit_costs_less_than_half_as_much_again() {
    let mut failures = Vec::new();
    for case in closed().into_iter().chain(blows()) {
        let steps = |tolerance: f64| f64::from(case.run(tolerance, 0, 0.0).steps);
        let per_digit = (steps(1e-10) / steps(1e-2)).powf(1.0 / 8.0);
        if per_digit >= 1.5 {
            failures.push(format!("{}: {per_digit}", case.name));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
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
