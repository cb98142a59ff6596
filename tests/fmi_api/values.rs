//! What values and derivatives of inputs do to the simulation.

use relay_contact::fmi2::*;
use testing::instance::Instance;

#[test]
fn outputs_in_initialization_mode_follow_what_is_set() {
    let fmu = Instance::initializing();
    let before = fmu.real("preload.force");
    assert_eq!(fmu.set_real("contact.overtravel", 3e-4), fmi2OK);
    let after = fmu.real("preload.force");
    assert!(after > before && before > 0.0, "{before} N at 0.2 mm, {after} N at 0.3 mm of overtravel");
    assert_eq!(fmu.exit_initialization_mode(), fmi2OK);
    assert_eq!(fmu.real("preload.force"), after);
}

#[test]
fn parameters_that_do_not_fit_end_initialisation_but_can_be_corrected_until_then() {
    let fmu = Instance::initializing();
    assert_eq!(fmu.set_integer("effects.axialForce", 4), fmi2OK);
    assert_eq!(fmu.set_real("beam.axialForce", 1000.0), fmi2OK);
    assert_eq!(fmu.try_real("contact.force").0, fmi2Error);
    fmu.expect_message(fmi2Error, &["beam.axialForce = 1000 N", "buckles", "correct the parameters"]);
    assert_eq!(fmu.set_real("beam.axialForce", 0.0), fmi2OK);
    assert!(fmu.real("contact.force") > 0.0);
    assert_eq!(fmu.set_real("beam.axialForce", 1000.0), fmi2OK);
    assert_eq!(fmu.exit_initialization_mode(), fmi2Error);
    fmu.expect_message(fmi2Error, &["fmi2ExitInitializationMode", "beam.axialForce = 1000 N", "buckles"]);
    assert_eq!(fmu.step(0.0, 1e-5), fmi2Error);
    assert_eq!(fmu.reset(), fmi2OK);
}

#[test]
fn a_derivative_counts_for_one_step() {
    let fmu = Instance::initialized();
    assert_eq!(fmu.set_rates(["support.displacement"], [1], [1e-3]), fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
    let moved = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    let rates = ["tip.displacement", "contact.indentation"].map(|name| fmu.try_rate(name));
    assert_eq!(rates.map(|(status, _)| status), [fmi2OK; 2]);
    assert!((rates[0].1 + rates[1].1 - 1e-3).abs() < 1e-12, "{rates:?}");
    // The fixed contact is where the derivative led; without one it goes back to its input.
    assert_eq!(fmu.step(1e-4, 1e-4), fmi2OK);
    let back = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    assert!((moved - back - 1e-7).abs() < 1e-18, "{moved} {back}");
    assert_eq!(fmu.real("support.displacement"), 0.0);
}

#[test]
fn higher_derivatives_of_inputs_have_no_effect_and_are_told_of_once() {
    let fmu = Instance::initialized();
    let names = ["support.displacement", "support.displacement", "base.acceleration"];
    for step in 0..3 {
        assert_eq!(fmu.set_rates(names, [1, 2, 3], [1e-3, 5.0, 1e9]), fmi2OK);
        assert_eq!(fmu.step(f64::from(step) * 1e-4, 1e-4), fmi2OK);
        let place = fmu.real("tip.displacement") + fmu.real("contact.indentation");
        assert!((place - 2e-4 - 1e-7).abs() < 1e-18, "{place}");
    }
    fmu.expect_message(fmi2Warning, &["fmi2SetRealInputDerivatives: support.displacement", "order 2"]);
}
