//! What a call that is not done says: which argument or variable, its value, and what is allowed.

use std::ptr;

use relay_contact::fmi2::*;
use testing::instance::{Instance, vr};

#[test]
fn an_array_that_is_null_misaligned_or_endless_is_named() {
    let (reference, order, mut value) = (vr("beam.length"), 1, 0.0);
    let (reference, order, value) = (&raw const reference, &raw const order, &raw mut value);
    let null = ptr::null();
    macro_rules! check {
        ($function:ident($($argument:expr),*), $wrong:literal) => {
            let fmu = Instance::initialized();
            let status = unsafe { $function(fmu.component, $($argument),*) };
            fmu.answers(status, fmi2Error, &[stringify!($function), concat!("argument ", $wrong, " "), "null"]);
        };
    }
    check!(fmi2GetReal(null, 1, value), "vr");
    check!(fmi2GetReal(reference, 1, ptr::null_mut()), "value");
    check!(fmi2GetReal(reference, usize::MAX, value), "vr");
    check!(fmi2GetReal(reference, 1, value.byte_add(1)), "value");
    check!(fmi2GetInteger(null, 1, ptr::null_mut()), "vr");
    check!(fmi2GetBoolean(null, 1, ptr::null_mut()), "vr");
    check!(fmi2GetString(null, 1, ptr::null_mut()), "vr");
    check!(fmi2SetReal(null, 1, value), "vr");
    check!(fmi2SetReal(reference, 1, ptr::null()), "value");
    check!(fmi2SetInteger(reference, 1, ptr::null()), "value");
    check!(fmi2SetBoolean(reference, 1, ptr::null()), "value");
    check!(fmi2SetString(reference, 1, ptr::null()), "value");
    check!(fmi2SetDebugLogging(1, 1, ptr::null()), "categories");
    check!(fmi2SetDebugLogging(1, 1, [ptr::null()].as_ptr()), "categories");
    check!(fmi2GetRealStatus(fmi2LastSuccessfulTime, ptr::null_mut()), "value");
    check!(fmi2SetRealInputDerivatives(null, 1, order, value), "vr");
    check!(fmi2SetRealInputDerivatives(reference, 1, ptr::null(), value), "order");
    check!(fmi2SetRealInputDerivatives(reference, 1, order, ptr::null()), "value");
    check!(fmi2GetRealOutputDerivatives(null, 1, order, value), "vr");
    check!(fmi2GetRealOutputDerivatives(reference, 1, ptr::null(), value), "order");
    check!(fmi2GetRealOutputDerivatives(reference, 1, order, ptr::null_mut()), "value");
    check!(fmi2GetFMUstate(ptr::null_mut()), "FMUstate");
}

#[test]
fn a_value_out_of_range_is_named_with_its_unit_and_the_range() {
    // In the words of a scene file, which `tests/scene_file.rs` looks at.
    let reals: [(&str, f64, &[&str]); 3] = [
        ("beam.width", 1e300, &["beam.width = 1e300 m", "0.0001 to 1"]),
        ("beam.width", -5e-324, &["beam.width = -5e-324 m"]),
        ("base.acceleration", f64::NEG_INFINITY, &["base.acceleration = -inf m/s2"]),
    ];
    for (name, value, parts) in reals {
        let fmu = Instance::new();
        fmu.answers(fmu.set_real(name, value), fmi2Discard, parts);
    }
    let fmu = Instance::initializing();
    let (modes, kind) = ("solver.modes", "effects.axialForce");
    let parts = ["effects.axialForce = 9", "FromPreload", "Prescribed"];
    fmu.answers(fmu.set_integer(kind, 9), fmi2Discard, &parts);
    let parts = ["solver.modes = 2147483647", "0 to"];
    fmu.answers(fmu.set_integer(modes, i32::MAX), fmi2Discard, &parts);
}

#[test]
fn a_variable_of_another_type_or_state_is_named_with_the_reason() {
    let fmu = Instance::new();
    let unknown = unsafe { fmi2SetReal(fmu.component, [u32::MAX].as_ptr(), 1, [1.0].as_ptr()) };
    fmu.answers(unknown, fmi2Error, &["fmi2SetReal", "4294967295"]);
    let fmu = Instance::initialized();
    let reference = vr("solver.modes").to_string();
    let of_other_type = fmu.try_real("solver.modes").0;
    fmu.answers(of_other_type, fmi2Error, &["fmi2GetReal", "no Real", "solver.modes is Integer", &reference]);
    let fmu = Instance::new();
    let parts = ["fmi2GetReal", "contact.force", "instantiated"];
    fmu.answers(fmu.try_real("contact.force").0, fmi2Error, &parts);
    // Of that call alone.
    fmu.initialize();

    let set = |fmu: &Instance, name| match name {
        "effects.excitation" | "solver.steps" => fmu.set_integer(name, 2),
        "contact.closed" => fmu.set_boolean(name, true),
        _ => fmu.set_real(name, 0.02),
    };
    for name in ["contact.force", "solver.steps", "contact.closed"] {
        let fmu = Instance::new();
        fmu.answers(set(&fmu, name), fmi2Error, &[name, "computed"]);
    }
    for name in ["beam.length", "effects.excitation"] {
        let fmu = Instance::initialized();
        let parts = [name, "step complete", "fixed parameter"];
        fmu.answers(set(&fmu, name), fmi2Error, &parts);
    }
}

#[test]
fn a_number_of_the_experiment_or_of_a_step_is_named() {
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let fmu = Instance::new();
        let parts = ["fmi2SetupExperiment", &format!("tolerance = {tolerance}: ")];
        assert_eq!(fmu.setup(Some(tolerance), 2.0, None), fmi2OK);
        fmu.expect_message(fmi2Warning, &parts);
    }
    for (start, stop, part) in [
        (f64::NAN, None, "startTime = NaN"),
        (f64::INFINITY, None, "startTime = inf"),
        (1.0, Some(0.5), "stopTime = 0.5"),
        (1e300, Some(1.0), "startTime = 1e300 s or more"),
        (0.0, Some(f64::NAN), "stopTime = NaN"),
    ] {
        let fmu = Instance::new();
        let parts = ["fmi2SetupExperiment", part, "allowed"];
        fmu.answers(fmu.setup(None, start, stop), fmi2Error, &parts);
    }
    for size in [0.0, -1e-5, f64::NAN, f64::INFINITY, 1e-300] {
        let fmu = Instance::new();
        assert_eq!(fmu.setup(None, 1.0, None), fmi2OK);
        fmu.initialize();
        fmu.answers(fmu.step(1.0, size), fmi2Error, &["fmi2DoStep", "communicationStepSize"]);
    }
    for (time, part) in
        [(f64::NAN, ""), (f64::INFINITY, ""), (f64::NEG_INFINITY, ""), (0.5, "the time of the instance is")]
    {
        let fmu = Instance::initialized();
        let parts = ["fmi2DoStep", "currentCommunicationPoint", part];
        fmu.answers(fmu.step(time, 1e-5), fmi2Error, &parts);
    }
    let fmu = Instance::new();
    assert_eq!(fmu.setup(None, 0.0, Some(1e-5)), fmi2OK);
    fmu.initialize();
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
    fmu.answers(fmu.step(1e-5, 1e-5), fmi2Error, &["stop time 1e-5 s"]);
}

#[test]
fn an_unsupported_status_derivative_or_foreign_state_is_named() {
    let fmu = Instance::initialized();
    let mut time = 0.0;
    for kind in [fmi2DoStepStatus, fmi2Terminated, 99] {
        let status = unsafe { fmi2GetRealStatus(fmu.component, kind, &raw mut time) };
        let parts = ["fmi2GetRealStatus", &format!("status kind {kind}")];
        fmu.answers(status, fmi2Discard, &parts);
    }
    let (none, mut nothing) = (ptr::null(), 0.0);
    let status =
        unsafe { fmi2GetDirectionalDerivative(fmu.component, none, 0, none, 0, ptr::null(), &raw mut nothing) };
    let parts = ["fmi2GetDirectionalDerivative", "not supported", "providesDirectionalDerivative"];
    fmu.answers(status, fmi2Error, &parts);
    let mut memory = [0_u64; 8];
    let mut foreign: fmi2FMUstate = memory.as_mut_ptr().cast();
    for wrong in [ptr::null_mut(), foreign] {
        let fmu = Instance::initialized();
        let parts = ["fmi2SetFMUstate", "FMUstate", "not a saved state"];
        fmu.answers(unsafe { fmi2SetFMUstate(fmu.component, wrong) }, fmi2Error, &parts);
    }
    let place = &raw mut foreign;
    let fmu = Instance::initialized();
    fmu.answers(unsafe { fmi2GetFMUstate(fmu.component, place) }, fmi2Error, &["fmi2GetFMUstate", "not a saved state"]);
    assert_eq!(fmu.reset(), fmi2OK);
    fmu.answers(
        unsafe { fmi2FreeFMUstate(fmu.component, place) },
        fmi2Error,
        &["fmi2FreeFMUstate", "not a saved state"],
    );
}
