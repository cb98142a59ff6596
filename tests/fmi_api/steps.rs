//! Communication steps, times and the tolerance of the experiment.

use relay_contact::fmi2::*;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

use crate::harness::Fmu;

/// After `fmi2SetupExperiment` with these numbers and initialisation.
fn experiment(tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Fmu {
    let fmu = Fmu::new();
    let status = unsafe {
        fmi2SetupExperiment(
            fmu.component,
            tolerance.is_some().into(),
            tolerance.unwrap_or(0.0),
            start,
            stop.is_some().into(),
            stop.unwrap_or(0.0),
        )
    };
    assert_eq!(status, fmi2OK);
    assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
    assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
    fmu
}

#[test]
fn a_run_through_c_is_the_simulation_bit_by_bit() {
    let fmu = experiment(Some(1e-7), 0.0, None);
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.tolerance = 1e-7;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    for n in 0..200 {
        let time = f64::from(n) * 1e-5;
        assert_eq!(fmu.step(time, 1e-5), fmi2OK);
        simulation.step(&Inputs::default(), time, 1e-5).unwrap();
        assert_eq!(
            fmu.real("contact.force").to_bits(),
            simulation.real(RealOutput::ContactForce).to_bits()
        );
    }
    assert_eq!(fmu.last_successful_time(), (fmi2OK, simulation.time()));
}

#[test]
fn the_tolerance_of_the_experiment_counts_where_the_scene_has_none() {
    let run = |tolerance, own: f64| {
        let fmu = Fmu::new();
        assert_eq!(
            unsafe { fmi2SetupExperiment(fmu.component, 1, tolerance, 0.0, 0, 0.0) },
            fmi2OK
        );
        assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
        assert_eq!(fmu.set_real("solver.tolerance", own), fmi2OK);
        assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
        assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
        assert_eq!(fmu.real("solver.tolerance"), own);
        assert_eq!(fmu.step(0.0, 1e-3), fmi2OK);
        fmu.integer("solver.steps")
    };
    let (coarse, fine) = (run(1e-3, 0.0), run(1e-8, 0.0));
    assert!(fine > coarse, "{coarse} steps at 1e-3, {fine} at 1e-8");
    assert_eq!(run(1e-3, 1e-8), fine);
    // Above the largest tolerance allowed: the largest.
    assert_eq!(run(10.0, 0.0), run(0.1, 0.0));
}

#[test]
fn a_tolerance_that_says_nothing_is_left_aside_with_a_warning() {
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let fmu = Fmu::new();
        let status = unsafe { fmi2SetupExperiment(fmu.component, 1, tolerance, 2.0, 0, 0.0) };
        assert_eq!(status, fmi2Warning);
        fmu.expect_message(
            fmi2Warning,
            &["fmi2SetupExperiment", &format!("tolerance = {tolerance}")],
        );
        // The rest of the call counts.
        assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
        assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
        assert_eq!(fmu.step(2.0, 1e-5), fmi2OK);
    }
}

#[test]
fn start_and_stop_that_make_no_experiment_are_refused() {
    let cases = [
        (f64::NAN, None, "startTime = NaN"),
        (f64::INFINITY, None, "startTime = inf"),
        (1.0, Some(0.5), "stopTime = 0.5"),
        (0.0, Some(f64::NAN), "stopTime = NaN"),
    ];
    for (start, stop, part) in cases {
        let fmu = Fmu::new();
        let (defined, stop) = (stop.is_some().into(), stop.unwrap_or(0.0));
        assert_eq!(
            unsafe { fmi2SetupExperiment(fmu.component, 0, 0.0, start, defined, stop) },
            fmi2Error
        );
        fmu.expect_message(fmi2Error, &["fmi2SetupExperiment", part, "allowed"]);
    }
}

#[test]
fn the_communication_point_may_differ_by_rounding_only() {
    // At 1000 s numbers are 1.1e-13 s apart: a few of those pass, a thousandth of a step does not.
    let start = 1000.0;
    for (shift, expected) in [
        (0.0, fmi2OK),
        (3e-13, fmi2OK),
        (-3e-13, fmi2OK),
        (1e-8, fmi2Error),
        (-1e-8, fmi2Error),
    ] {
        let fmu = experiment(None, start, None);
        assert_eq!(fmu.step(start, 1e-5), fmi2OK);
        assert_eq!(fmu.step(start + 1e-5 + shift, 1e-5), expected, "shifted by {shift} s");
    }
    // An absolute tolerance of 1e-5 s would pass this one: a hundred steps of 0.1 us too late.
    let fmu = experiment(None, 0.0, None);
    assert_eq!(fmu.step(0.0, 1e-7), fmi2OK);
    assert_eq!(fmu.step(1e-5, 1e-7), fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &["fmi2DoStep", "currentCommunicationPoint = 0.00001", "stands at"],
    );
}

#[test]
fn importers_may_add_up_their_steps_or_multiply() {
    let size = 1e-4;
    let (sum, product) = (experiment(None, 0.0, Some(0.1)), experiment(None, 0.0, Some(0.1)));
    let mut time = 0.0;
    for n in 0..1000 {
        assert_eq!(sum.step(time, size), fmi2OK, "sum at {time}");
        assert_eq!(product.step(f64::from(n) * size, size), fmi2OK, "product at {n}");
        time += size;
    }
    // Both stand at the stop time; one more step is one too many.
    assert_eq!(sum.step(time, size), fmi2Error);
    sum.expect_message(fmi2Error, &["stop time 0.1 s"]);
}

#[test]
fn a_step_needs_a_positive_finite_length_and_a_finite_time() {
    for size in [0.0, -1e-5, f64::NAN, f64::INFINITY, 1e-300] {
        let fmu = experiment(None, 1.0, None);
        assert_eq!(fmu.step(1.0, size), fmi2Error, "{size}");
        fmu.expect_message(fmi2Error, &["fmi2DoStep", "communicationStepSize"]);
    }
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let fmu = experiment(None, 1.0, None);
        assert_eq!(fmu.step(time, 1e-5), fmi2Error, "{time}");
        fmu.expect_message(fmi2Error, &["fmi2DoStep", "currentCommunicationPoint"]);
    }
}

#[test]
fn the_last_successful_time_is_known_after_a_step_that_failed() {
    let fmu = experiment(None, 0.0, None);
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
    assert_eq!(fmu.step(0.5, 1e-5), fmi2Error);
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-5));
    // Values can be read for debugging, the simulation cannot go on.
    assert!(fmu.real("contact.force").is_finite());
    assert_eq!(fmu.step(1e-5, 1e-5), fmi2Error);
}

#[test]
fn a_motion_that_cannot_be_integrated_is_an_error_with_time_and_cause() {
    let fmu = experiment(None, 0.0, None);
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
    // Each is allowed, and both together ask for more than light can.
    assert_eq!(fmu.set_real("support.displacement", 0.1), fmi2OK);
    assert_eq!(fmu.step(1e-5, 1e-12), fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &[
            "fmi2DoStep: integration stopped at t = 1e-5 s: ",
            "support.displacement",
            "speed of light",
        ],
    );
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-5));
    assert!(fmu.real("contact.force").is_finite());
    assert_eq!(fmu.reset(), fmi2OK);
}
