//! Communication steps, times and the tolerance of the experiment.

use relay_contact::fmi2::*;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};
use testing::instance::Instance;

/// After `fmi2SetupExperiment` with these numbers and initialisation.
fn experiment(tolerance: Option<f64>, start: f64) -> Instance {
    let fmu = Instance::new();
    assert_eq!(fmu.setup(tolerance, start, None), fmi2OK);
    assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
    fmu.initialize();
    fmu
}

#[test]
fn a_run_through_c_is_the_simulation_bit_by_bit() {
    let fmu = experiment(Some(1e-7), 0.0);
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
        let fmu = Instance::new();
        assert_eq!(fmu.setup(Some(tolerance), 0.0, None), fmi2OK);
        assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
        assert_eq!(fmu.set_real("solver.tolerance", own), fmi2OK);
        fmu.initialize();
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
        let fmu = experiment(None, start);
        assert_eq!(fmu.step(start, 1e-5), fmi2OK);
        assert_eq!(fmu.step(start + 1e-5 + shift, 1e-5), expected, "shifted by {shift} s");
    }
    // An absolute tolerance of 1e-5 s would pass this one: a hundred steps of 0.1 us too late.
    let fmu = experiment(None, 0.0);
    assert_eq!(fmu.step(0.0, 1e-7), fmi2OK);
    assert_eq!(fmu.step(1e-5, 1e-7), fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &[
            "fmi2DoStep",
            "currentCommunicationPoint = 1e-5",
            "the time of the instance is",
        ],
    );
}

#[test]
fn a_motion_that_cannot_be_integrated_is_an_error_with_time_and_cause() {
    let fmu = experiment(None, 0.0);
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

#[test]
fn a_communication_step_of_any_length_answers() {
    // Eleven days at rest are nothing; shaken, they are more work than a step may take.
    let fmu = Instance::initialized();
    assert_eq!(fmu.step(0.0, 1e6), fmi2OK);
    let fmu = experiment(None, 0.0);
    assert_eq!(fmu.step(0.0, 1e-3), fmi2OK);
    assert_eq!(fmu.step(1e-3, 1e6), fmi2Error);
    let messages = fmu.messages();
    let text = messages
        .first()
        .map(|message| message.text.as_str())
        .unwrap_or_default();
    let reached = text.split_once("t = ").and_then(|(_, rest)| rest.split_once(" s: "));
    let (reached, advice) = reached.unwrap_or_else(|| panic!("{messages:?}"));
    // A second of the scene takes some ten milliseconds, so that it comes to minutes.
    let reached: f64 = reached.parse().unwrap();
    assert!((10.0..1e4).contains(&reached), "{text}");
    assert!(advice.contains("use shorter communication steps"), "{text}");
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-3));
    assert_eq!(fmu.reset(), fmi2OK);
}
