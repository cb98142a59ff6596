//! Communication steps and the tolerance of the experiment.

use relay_contact::fmi2::*;
use relay_contact::variables::PusherKind;
use testing::instance::Instance;

/// At the first communication point of a run under a sine.
fn shaken() -> Instance {
    let fmu = Instance::new();
    fmu.shake(98.0);
    fmu.initialize();
    fmu
}

#[test]
fn the_tolerance_of_the_experiment_counts_where_the_scene_has_none() {
    let run = |tolerance, own: f64| {
        let fmu = Instance::new();
        assert_eq!(fmu.setup(Some(tolerance), 0.0, None), fmi2OK);
        fmu.shake(98.0);
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
fn a_motion_that_cannot_be_integrated_is_an_error_with_time_and_cause() {
    let fmu = shaken();
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
    // Each is allowed, and both together ask for more than light can.
    assert_eq!(fmu.set_real("support.displacement", 0.1), fmi2OK);
    assert_eq!(fmu.step(1e-5, 1e-12), fmi2Error);
    let stopped = "fmi2DoStep: integration stopped at t = 1e-5 s: ";
    fmu.expect_message(fmi2Error, &[stopped, "support.displacement would", "speed of light"]);
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-5));
    assert!(fmu.real("contact.force").is_finite());
    assert_eq!(fmu.reset(), fmi2OK);
    assert_eq!(fmu.set_integer("effects.pusher", PusherKind::Prescribed as i32), fmi2OK);
    fmu.initialize();
    assert_eq!(fmu.set_real("pusher.displacement", 0.1), fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-12), fmi2Error);
    fmu.expect_message(fmi2Error, &["pusher.displacement would", "speed of light"]);
}

#[test]
fn a_communication_step_of_any_length_answers() {
    // Eleven days at rest are nothing; shaken, they are more work than a step may take.
    let fmu = Instance::initialized();
    assert_eq!(fmu.step(0.0, 1e6), fmi2OK);
    let fmu = Instance::new();
    fmu.shake(98.0);
    // With all modes what a step may take is spent in half of the time.
    assert_eq!(fmu.set_integer("solver.modes", 128), fmi2OK);
    fmu.initialize();
    assert_eq!(fmu.step(0.0, 1e-3), fmi2OK);
    let outputs = || ["contact.force", "tip.velocity", "step.minimumForce"].map(|name| fmu.real(name).to_bits());
    let before = outputs();
    assert_eq!(fmu.step(1e-3, 1e6), fmi2Error);
    assert_eq!(outputs(), before);
    let messages = fmu.messages();
    let text = messages.first().map(|message| message.text.as_str()).unwrap_or_default();
    let reached = text.split_once("t = ").and_then(|(_, rest)| rest.split_once(" s: "));
    let (reached, advice) = reached.unwrap_or_else(|| panic!("{messages:?}"));
    // A second of the scene takes some ten milliseconds, so that it comes to minutes.
    let reached: f64 = reached.parse().unwrap();
    assert!((10.0..1e4).contains(&reached), "{text}");
    assert!(advice.contains("use shorter communication steps"), "{text}");
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-3));
    assert_eq!(fmu.reset(), fmi2OK);
}
