//! Which call is allowed when: driven by the table itself.

use std::ptr;

use relay_contact::fmi2::states::{Function, State, TABLE};
use relay_contact::fmi2::*;
use relay_contact::variables::GUID;

use crate::harness::{Fmu, Log, instantiate, vr};

/// An instance in the state.
fn in_state(state: State) -> Fmu {
    let fmu = match state {
        State::Instantiated => Fmu::new(),
        State::InitializationMode => Fmu::initializing(),
        State::StepComplete | State::Terminated | State::Error => Fmu::initialized(),
    };
    match state {
        State::Terminated => assert_eq!(unsafe { fmi2Terminate(fmu.component) }, fmi2OK),
        State::Error => {
            assert_eq!(fmu.step(0.0, -1.0), fmi2Error);
            fmu.expect_message(fmi2Error, &["communicationStepSize"]);
        }
        _ => {}
    }
    fmu
}

/// Calls the function with arguments that are right.
fn call(function: Function, c: fmi2Component) -> fmi2Status {
    let input = vr("base.acceleration");
    let (force, modes) = (vr("contact.force"), vr("solver.modes"));
    let none: *const () = ptr::null();
    let (mut real, mut integer, mut status, mut text, mut size) = (0.0, 0, fmi2OK, ptr::null(), 0);
    let mut state = ptr::null_mut();
    let (order, value, number) = (1, 0.0, 0);
    unsafe {
        match function.name {
            "fmi2SetDebugLogging" => fmi2SetDebugLogging(c, fmi2True, 0, none.cast()),
            "fmi2SetupExperiment" => fmi2SetupExperiment(c, fmi2True, 1e-6, 0.0, fmi2True, 1.0),
            "fmi2EnterInitializationMode" => fmi2EnterInitializationMode(c),
            "fmi2ExitInitializationMode" => fmi2ExitInitializationMode(c),
            "fmi2Terminate" => fmi2Terminate(c),
            "fmi2Reset" => fmi2Reset(c),
            "fmi2GetReal" => fmi2GetReal(c, &raw const input, 1, &raw mut real),
            "fmi2GetInteger" => fmi2GetInteger(c, &raw const modes, 1, &raw mut integer),
            "fmi2GetBoolean" => fmi2GetBoolean(c, none.cast(), 0, ptr::null_mut()),
            "fmi2GetString" => fmi2GetString(c, none.cast(), 0, ptr::null_mut()),
            "fmi2SetReal" => fmi2SetReal(c, &raw const input, 1, &raw const value),
            "fmi2SetInteger" => fmi2SetInteger(c, none.cast(), 0, none.cast()),
            "fmi2SetBoolean" => fmi2SetBoolean(c, none.cast(), 0, none.cast()),
            "fmi2SetString" => fmi2SetString(c, none.cast(), 0, none.cast()),
            "fmi2GetFMUstate" => {
                let status = fmi2GetFMUstate(c, &raw mut state);
                fmi2FreeFMUstate(c, &raw mut state);
                status
            }
            "fmi2SetFMUstate" => fmi2SetFMUstate(c, state),
            "fmi2FreeFMUstate" => fmi2FreeFMUstate(c, &raw mut state),
            "fmi2SerializedFMUstateSize" => fmi2SerializedFMUstateSize(c, state, &raw mut size),
            "fmi2SerializeFMUstate" => fmi2SerializeFMUstate(c, state, ptr::null_mut(), 0),
            "fmi2DeSerializeFMUstate" => fmi2DeSerializeFMUstate(c, none.cast(), 0, &raw mut state),
            "fmi2GetDirectionalDerivative" => {
                fmi2GetDirectionalDerivative(c, none.cast(), 0, none.cast(), 0, none.cast(), ptr::null_mut())
            }
            "fmi2SetRealInputDerivatives" => {
                fmi2SetRealInputDerivatives(c, &raw const input, 1, &raw const order, &raw const value)
            }
            "fmi2GetRealOutputDerivatives" => {
                fmi2GetRealOutputDerivatives(c, &raw const force, 1, &raw const order, &raw mut real)
            }
            "fmi2DoStep" => fmi2DoStep(c, 0.0, 1e-5, fmi2True),
            "fmi2CancelStep" => fmi2CancelStep(c),
            "fmi2GetStatus" => fmi2GetStatus(c, fmi2DoStepStatus, &raw mut status),
            "fmi2GetRealStatus" => fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &raw mut real),
            "fmi2GetIntegerStatus" => fmi2GetIntegerStatus(c, number, &raw mut integer),
            "fmi2GetBooleanStatus" => fmi2GetBooleanStatus(c, fmi2Terminated, &raw mut integer),
            "fmi2GetStringStatus" => fmi2GetStringStatus(c, fmi2PendingStatus, &raw mut text),
            other => panic!("{other} is in the table and not called here"),
        }
    }
}

/// What the function answers where it is allowed.
fn allowed_answer(function: Function) -> fmi2Status {
    match function.name {
        "fmi2GetStatus" | "fmi2GetIntegerStatus" | "fmi2GetStringStatus" => fmi2Discard,
        "fmi2SetFMUstate"
        | "fmi2SerializedFMUstateSize"
        | "fmi2SerializeFMUstate"
        | "fmi2DeSerializeFMUstate"
        | "fmi2GetDirectionalDerivative" => fmi2Error,
        _ => fmi2OK,
    }
}

#[test]
fn each_call_is_allowed_in_the_states_of_the_table_and_in_no_other() {
    for function in TABLE {
        for &state in State::ALL {
            let fmu = in_state(state);
            let status = call(function, fmu.component);
            let at = format!("{} in the state {}", function.name, state.name());
            if function.allowed.contains(&state) {
                assert_eq!(status, allowed_answer(function), "{at}");
                assert!(
                    !fmu.messages()
                        .iter()
                        .any(|message| message.text.contains("not allowed in")),
                    "{at}"
                );
            } else {
                assert_eq!(status, fmi2Error, "{at}");
                fmu.expect_message(fmi2Error, &[function.name, "not allowed in the state", state.name()]);
                assert_eq!(
                    fmu.set_real("base.acceleration", 1.0),
                    fmi2Error,
                    "{at}: the instance goes on"
                );
                assert_eq!(fmu.reset(), fmi2OK, "{at}: no reset");
            }
        }
    }
}

/// The table of the standard, section 4.2.4, for the states this component has, written down a second time by rows.
#[test]
fn the_table_allows_what_the_standard_allows() {
    use State::{Error, InitializationMode, Instantiated, StepComplete, Terminated};
    let standard: &[(&[&str], &[State])] = &[
        (&["fmi2SetDebugLogging", "fmi2Reset"], State::ALL),
        (&["fmi2SetupExperiment", "fmi2EnterInitializationMode"], &[Instantiated]),
        (&["fmi2ExitInitializationMode"], &[InitializationMode]),
        (&["fmi2Terminate", "fmi2DoStep"], &[StepComplete]),
        (
            &["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString"],
            &[InitializationMode, StepComplete, Terminated, Error],
        ),
        (
            &[
                "fmi2SetReal",
                "fmi2SetInteger",
                "fmi2SetBoolean",
                "fmi2SetString",
                "fmi2SetRealInputDerivatives",
            ],
            &[Instantiated, InitializationMode, StepComplete],
        ),
        (&["fmi2GetRealOutputDerivatives"], &[StepComplete, Terminated, Error]),
        (
            &[
                "fmi2GetStatus",
                "fmi2GetRealStatus",
                "fmi2GetIntegerStatus",
                "fmi2GetBooleanStatus",
                "fmi2GetStringStatus",
            ],
            &[StepComplete, Terminated],
        ),
    ];
    for (names, states) in standard {
        for name in *names {
            let row = TABLE.iter().find(|function| function.name == *name).unwrap();
            for state in *states {
                assert!(row.allowed.contains(state), "{name} in the state {}", state.name());
            }
        }
    }
}

#[test]
fn the_table_and_the_four_functions_beside_it_are_the_34_of_the_standard() {
    let mut names: Vec<_> = TABLE.iter().map(|function| function.name).collect();
    names.extend([
        "fmi2GetTypesPlatform",
        "fmi2GetVersion",
        "fmi2Instantiate",
        "fmi2FreeInstance",
    ]);
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 34);
    let header = std::fs::read_to_string(concat!(env!("RELAY_CONTACT_INCLUDE"), "/relay_contact.h")).unwrap();
    for name in names {
        assert!(header.contains(&format!("{name}(")), "{name} is not in the header");
    }
}

#[test]
fn versions_are_those_of_fmi_2() {
    let text = |text| unsafe { std::ffi::CStr::from_ptr(text) };
    assert_eq!(text(unsafe { fmi2GetVersion() }), c"2.0");
    assert_eq!(text(unsafe { fmi2GetTypesPlatform() }), c"default");
}

#[test]
fn a_wrong_guid_type_or_name_makes_no_instance_and_says_why() {
    type Case<'a> = (Option<&'a str>, fmi2Type, Option<&'a str>, &'a [&'a str]);
    let cases: [Case; 6] = [
        (
            Some("relay"),
            fmi2CoSimulation,
            Some("{1234}"),
            &["fmuGUID = {1234}", GUID],
        ),
        (Some("relay"), fmi2CoSimulation, None, &["fmuGUID"]),
        (
            Some("relay"),
            fmi2ModelExchange,
            Some(GUID),
            &["fmuType = 0", "fmi2CoSimulation"],
        ),
        (Some("relay"), 77, Some(GUID), &["fmuType = 77"]),
        (Some(""), fmi2CoSimulation, Some(GUID), &["instanceName"]),
        (None, fmi2CoSimulation, Some(GUID), &["instanceName"]),
    ];
    for (name, kind, guid, parts) in cases {
        let log = Log::default();
        assert!(instantiate(name, kind, guid, &log, fmi2False).is_null());
        let messages = log.into_inner().unwrap();
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].category, "logStatusError");
        for part in parts {
            assert!(messages[0].text.contains(part), "{part}: {messages:?}");
        }
    }
}

#[test]
fn reset_brings_back_start_values_and_the_first_state() {
    let fmu = Fmu::new();
    let start = fmu.real("beam.length");
    assert_eq!(fmu.set_real("beam.length", 0.02), fmi2OK);
    assert_eq!(fmu.set_real("base.acceleration", 9.81), fmi2OK);
    assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
    assert_eq!(
        unsafe { fmi2SetupExperiment(fmu.component, 0, 0.0, 5.0, 1, 6.0) },
        fmi2OK
    );
    assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(fmu.step(5.0, 1e-4), fmi2OK);
    assert_eq!(fmu.reset(), fmi2OK);
    assert_eq!(fmu.real("beam.length"), start);
    assert_eq!(fmu.real("base.acceleration"), 0.0);
    assert_eq!(fmu.integer("effects.excitation"), 1);
    // Without fmi2SetupExperiment the second run starts at zero, without a stop.
    assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(unsafe { fmi2ExitInitializationMode(fmu.component) }, fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
    assert_eq!(fmu.last_successful_time(), (fmi2OK, 1e-4));
}

#[test]
fn instances_do_not_share_anything() {
    let (one, two) = (Fmu::initialized(), Fmu::new());
    assert_eq!(two.set_real("beam.length", 0.02), fmi2OK);
    assert_ne!(one.real("beam.length"), 0.02);
    assert_eq!(one.step(0.0, -1.0), fmi2Error);
    assert_eq!(two.set_real("beam.length", 0.03), fmi2OK);
    assert!(two.messages().is_empty());
}

#[test]
fn an_unsupported_capability_is_an_error_that_leaves_the_instance_alive() {
    let fmu = Fmu::initialized();
    let (none, mut nothing) = (ptr::null(), 0.0);
    let status =
        unsafe { fmi2GetDirectionalDerivative(fmu.component, none, 0, none, 0, ptr::null(), &raw mut nothing) };
    assert_eq!(status, fmi2Error);
    fmu.expect_message(
        fmi2Error,
        &[
            "fmi2GetDirectionalDerivative",
            "not supported",
            "providesDirectionalDerivative",
        ],
    );
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
}
