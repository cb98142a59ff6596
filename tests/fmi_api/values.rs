//! What values do to the simulation.

use relay_contact::fmi2::*;
use testing::instance::Instance;

#[test]
fn outputs_in_initialization_mode_follow_what_is_set() {
    let fmu = Instance::initializing();
    let before = fmu.real("preload.force");
    assert_eq!(fmu.set_real("contact.overtravel", 3e-4), fmi2OK);
    let after = fmu.real("preload.force");
    assert!(
        after > before && before > 0.0,
        "{before} N at 0.2 mm, {after} N at 0.3 mm of overtravel"
    );
    assert_eq!(fmu.exit_initialization_mode(), fmi2OK);
    assert_eq!(fmu.real("preload.force"), after);
}

#[test]
fn parameters_that_do_not_fit_end_initialisation_but_can_be_corrected_until_then() {
    let fmu = Instance::initializing();
    assert_eq!(fmu.set_integer("effects.axialForce", 4), fmi2OK);
    assert_eq!(fmu.set_real("beam.axialForce", 1000.0), fmi2OK);
    assert_eq!(fmu.try_real("contact.force").0, fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &["beam.axialForce = 1000 N", "buckles", "correct the parameters"],
    );
    assert_eq!(fmu.set_real("beam.axialForce", 0.0), fmi2OK);
    assert!(fmu.real("contact.force") > 0.0);
    assert_eq!(fmu.set_real("beam.axialForce", 1000.0), fmi2OK);
    assert_eq!(fmu.exit_initialization_mode(), fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &["fmi2ExitInitializationMode", "beam.axialForce = 1000 N", "buckles"],
    );
    assert_eq!(fmu.step(0.0, 1e-5), fmi2Error);
    assert_eq!(fmu.reset(), fmi2OK);
}
