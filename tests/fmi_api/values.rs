//! Setting and reading variables.

use relay_contact::fmi2::*;
use relay_contact::scene::Scene;
use relay_contact::variables::{Group, VARIABLES};

use crate::harness::{Fmu, vr};

#[test]
fn every_variable_is_read_by_the_function_of_its_type_and_by_no_other() {
    for variable in &VARIABLES {
        let reference = variable.value_reference;
        let (mut real, mut integer, mut boolean) = (f64::NAN, i32::MIN, -1);
        let fmu = [(); 3].map(|()| Fmu::initialized());
        let statuses = unsafe {
            [
                fmi2GetReal(fmu[0].component, &raw const reference, 1, &raw mut real),
                fmi2GetInteger(fmu[1].component, &raw const reference, 1, &raw mut integer),
                fmi2GetBoolean(fmu[2].component, &raw const reference, 1, &raw mut boolean),
            ]
        };
        let expected = match variable.group {
            Group::RealInput(_) | Group::RealParameter(_) | Group::RealOutput(_) => [fmi2OK, fmi2Error, fmi2Error],
            Group::IntegerParameter(_) | Group::EnumerationParameter(_) | Group::IntegerOutput(_) => {
                [fmi2Error, fmi2OK, fmi2Error]
            }
            Group::BooleanParameter(_) | Group::BooleanOutput(_) => [fmi2Error, fmi2Error, fmi2OK],
        };
        assert_eq!(statuses, expected, "{}", variable.name);
        assert!(expected[0] != fmi2OK || real.is_finite(), "{} = {real}", variable.name);
        assert!(
            expected[2] != fmi2OK || [fmi2False, fmi2True].contains(&boolean),
            "{}",
            variable.name
        );
        for (fmu, status) in fmu.iter().zip(statuses) {
            if status == fmi2Error {
                fmu.expect_message(fmi2Error, &[&reference.to_string(), variable.name]);
            }
        }
    }
}

#[test]
fn inputs_and_parameters_have_their_start_values_from_the_beginning() {
    let fmu = Fmu::new();
    for variable in &VARIABLES {
        match variable.group {
            Group::RealInput(_) | Group::RealParameter(_) => assert_eq!(fmu.real(variable.name), variable.start),
            Group::IntegerParameter(_) | Group::EnumerationParameter(_) => {
                assert_eq!(f64::from(fmu.integer(variable.name)), variable.start);
            }
            _ => {}
        }
    }
}

#[test]
fn an_output_has_no_value_before_initialisation() {
    let fmu = Fmu::new();
    assert_eq!(fmu.try_real("contact.force").0, fmi2Error);
    fmu.expect_message(fmi2Error, &["fmi2GetReal", "contact.force", "instantiated"]);
}

#[test]
fn a_refused_value_changes_nothing_of_its_call_and_the_instance_goes_on() {
    let cases: [(&str, f64, &[&str]); 7] = [
        ("beam.width", -1.0, &["beam.width = -1 m", "0.0001 to 1"]),
        ("beam.width", f64::NAN, &["beam.width = NaN"]),
        ("beam.width", f64::INFINITY, &["beam.width = inf"]),
        (
            "contact.moving.poissonRatio",
            0.6,
            &["contact.moving.poissonRatio = 0.6", "-1", "0.5"],
        ),
        (
            "contact.moving.poissonRatio",
            0.5,
            &["contact.moving.poissonRatio = 0.5", "less than 0.5"],
        ),
        ("resistance.open", 0.0, &["resistance.open = 0 Ohm", "1 to"]),
        (
            "base.acceleration",
            f64::NEG_INFINITY,
            &["base.acceleration = -inf m/s2", "-1000000000 to 1000000000"],
        ),
    ];
    for (name, value, parts) in cases {
        let fmu = Fmu::new();
        let before = fmu.real(name);
        assert_eq!(
            fmu.set_reals(&["beam.length", "contact.current", name], &[0.02, 3.0, value]),
            fmi2Discard
        );
        fmu.expect_message(fmi2Discard, parts);
        assert_eq!(fmu.real("beam.length"), Scene::default().beam.length);
        assert_eq!(fmu.real("contact.current"), 0.0);
        assert_eq!(fmu.real(name), before);
        assert_eq!(fmu.set_real("beam.length", 0.02), fmi2OK);
        assert_eq!(fmu.real("beam.length"), 0.02);
    }
}

#[test]
fn a_refused_integer_changes_nothing_of_its_call_and_the_instance_goes_on() {
    let cases: [(&str, i32, &[&str]); 4] = [
        (
            "effects.axialForce",
            9,
            &["effects.axialForce = 9", "FromPreload", "Prescribed"],
        ),
        ("effects.excitation", 0, &["effects.excitation = 0", "Sine"]),
        ("solver.modes", -1, &["solver.modes = -1", "0 to"]),
        ("solver.modes", i32::MAX, &["solver.modes = 2147483647"]),
    ];
    for (name, value, parts) in cases {
        let fmu = Fmu::initializing();
        let references = [vr("effects.excitation"), vr(name)];
        let status = unsafe { fmi2SetInteger(fmu.component, references.as_ptr(), 2, [2, value].as_ptr()) };
        assert_eq!(status, fmi2Discard);
        fmu.expect_message(fmi2Discard, parts);
        assert_eq!(fmu.integer("effects.excitation"), 1);
        assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
        assert_eq!(fmu.integer("effects.excitation"), 2);
    }
}

#[test]
fn a_refused_input_keeps_the_last_one_and_the_simulation_goes_on() {
    let fmu = Fmu::initialized();
    assert_eq!(fmu.set_real("base.acceleration", 10.0), fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
    assert_eq!(fmu.set_real("base.acceleration", f64::NAN), fmi2Discard);
    assert_eq!(fmu.real("base.acceleration"), 10.0);
    assert_eq!(fmu.step(1e-5, 1e-5), fmi2OK);
}

#[test]
fn fixed_parameters_are_fixed_after_initialisation() {
    let fmu = Fmu::initialized();
    assert_eq!(fmu.set_real("beam.length", 0.02), fmi2Error);
    fmu.expect_message(fmi2Error, &["beam.length", "step complete", "fixed parameter"]);
    let fmu = Fmu::initialized();
    assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2Error);
    fmu.expect_message(fmi2Error, &["effects.excitation", "step complete", "fixed parameter"]);
}

#[test]
fn outputs_cannot_be_set() {
    let fmu = Fmu::new();
    assert_eq!(fmu.set_real("contact.force", 1.0), fmi2Error);
    fmu.expect_message(fmi2Error, &["contact.force", "computed"]);
    let fmu = Fmu::new();
    assert_eq!(fmu.set_integer("solver.steps", 1), fmi2Error);
    fmu.expect_message(fmi2Error, &["solver.steps", "computed"]);
    let fmu = Fmu::new();
    let (reference, value) = (vr("contact.closed"), fmi2True);
    assert_eq!(
        unsafe { fmi2SetBoolean(fmu.component, &raw const reference, 1, &raw const value) },
        fmi2Error
    );
    fmu.expect_message(fmi2Error, &["contact.closed", "computed"]);
}

#[test]
fn an_unknown_reference_is_an_error_after_which_only_reset_helps() {
    let fmu = Fmu::new();
    let (reference, value) = (u32::MAX, 1.0);
    assert_eq!(
        unsafe { fmi2SetReal(fmu.component, &raw const reference, 1, &raw const value) },
        fmi2Error
    );
    fmu.expect_message(fmi2Error, &["fmi2SetReal", "4294967295"]);
    assert_eq!(fmu.set_real("beam.length", 0.02), fmi2Error);
    assert_eq!(fmu.reset(), fmi2OK);
    assert_eq!(fmu.set_real("beam.length", 0.02), fmi2OK);
}

#[test]
fn outputs_in_initialization_mode_follow_what_is_set() {
    let fmu = Fmu::initializing();
    let before = fmu.real("preload.force");
    assert_eq!(fmu.set_real("contact.overtravel", 3e-4), fmi2OK);
    let after = fmu.real("preload.force");
    assert!(
        after > before && before > 0.0,
        "{before} N at 0.2 mm, {after} N at 0.3 mm of overtravel"
    );
    assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(fmu.real("preload.force"), after);
}

#[test]
fn parameters_that_do_not_fit_end_initialisation_but_can_be_corrected_until_then() {
    let fmu = Fmu::initializing();
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
    assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &["fmi2ExitInitializationMode", "beam.axialForce = 1000 N", "buckles"],
    );
    assert_eq!(fmu.step(0.0, 1e-5), fmi2Error);
    assert_eq!(fmu.reset(), fmi2OK);
}
