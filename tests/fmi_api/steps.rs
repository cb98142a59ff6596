//! Communication steps, times and the tolerance of the experiment.

use std::f64::consts::TAU;

use relay_contact::fmi2::*;
use relay_contact::variables::PusherKind;
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

/// The force at each of `count` communication points, whose time and length an importer reckons.
fn forces(count: u32, importer: impl Fn(u32) -> (f64, f64)) -> (Instance, Vec<f64>) {
    let fmu = experiment(None, 0.0);
    let force = |n| {
        let (time, size) = importer(n);
        assert_eq!(fmu.step(time, size), fmi2OK, "step {n}: {:?}", fmu.messages());
        fmu.real("contact.force")
    };
    let forces = (0..count).map(force).collect();
    (fmu, forces)
}

#[test]
fn a_point_off_by_a_small_part_of_the_step_is_a_warning_at_the_first_time() {
    let mut time = 0.0_f32;
    let sums: Vec<_> = (0..1000)
        .map(|_| {
            let sum = time;
            time += 1e-5;
            f64::from(sum)
        })
        .collect();
    let (_, exact) = forces(1000, |n| (f64::from(n) * 1e-5, 1e-5));
    // Where the last step ends, and how far the instants are off, s. Each run may be wrong by the tolerance, and the force
    // of 0.05 N at 1 kHz changes by 2 pi f times it within the time.
    let check = |importer: &dyn Fn(u32) -> (f64, f64), end: f64, off: f64| {
        let (fmu, found) = forces(1000, importer);
        let parts = ["fmi2DoStep: currentCommunicationPoint = ", "the time of the instance was"];
        fmu.expect_message(fmi2Warning, &parts);
        let reached = fmu.last_successful_time().1;
        assert!((reached - end).abs() <= f64::EPSILON * end, "{reached} s, not {end} s");
        let allowed = 2.0 * 1e-6 * 0.152 + 0.1 * TAU * 1000.0 * off;
        for (n, (found, exact)) in found.iter().zip(&exact).enumerate() {
            assert!((found - exact).abs() <= allowed, "step {n}: {found} N, {exact} N");
        }
    };
    let last = sums[999];
    check(&|n| (sums[n as usize], 1e-5), last + 1e-5, (last - 999e-5).abs());
    // The length of the step in single precision, and points that are multiples of the exact one.
    let size = f64::from(1e-5_f32);
    check(&|n| (f64::from(n) * 1e-5, size), 999e-5 + size, 1e-5 - size);
    // Off by 1e-12 s once, at 1e-5 s.
    let point = |n| f64::from(n) * 1e-5 + if n == 1 { 1e-12 } else { 0.0 };
    check(&|n| (point(n), 1e-5), 1e-2, 1e-12);
}

#[test]
fn a_motion_that_cannot_be_integrated_is_an_error_with_time_and_cause() {
    let fmu = experiment(None, 0.0);
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
    let fmu = experiment(None, 0.0);
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
