//! Messages to the importer.

use std::ffi::CStr;
use std::ptr;
use std::sync::atomic::{AtomicU32, Ordering};

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::fmi2::*;
use relay_contact::variables::GUID;

use crate::harness::Fmu;

fn choose(fmu: &Fmu, on: fmi2Boolean, categories: &[&CStr]) -> fmi2Status {
    let pointers: Vec<_> = categories.iter().map(|category| category.as_ptr()).collect();
    unsafe { fmi2SetDebugLogging(fmu.component, on, pointers.len(), pointers.as_ptr()) }
}

/// Number of messages that a discarded value and then an error send.
fn heard(fmu: &Fmu) -> [usize; 2] {
    assert_eq!(fmu.set_real("beam.length", -1.0), fmi2Discard);
    assert_eq!(fmu.set_real("contact.force", 1.0), fmi2Error);
    assert_eq!(fmu.reset(), fmi2OK);
    ["logStatusWarning", "logStatusError"].map(|category| {
        fmu.messages()
            .iter()
            .filter(|message| message.category == category)
            .count()
    })
}

#[test]
fn the_categories_are_those_of_the_description() {
    for category in [LOG_STATUS_ERROR, LOG_STATUS_WARNING] {
        assert!(MODEL_DESCRIPTION.contains(&format!("<Category name=\"{}\"", category.to_str().unwrap())));
    }
    assert_eq!(MODEL_DESCRIPTION.matches("<Category ").count(), 2);
}

#[test]
fn errors_and_warnings_are_logged_unless_their_category_is_switched_off() {
    let (error, warning) = (LOG_STATUS_ERROR, LOG_STATUS_WARNING);
    let cases: [(fmi2Boolean, &[&CStr], [usize; 2]); 7] = [
        (fmi2True, &[], [1, 1]),
        (fmi2False, &[], [1, 1]),
        (fmi2True, &[error], [0, 1]),
        (fmi2True, &[warning], [1, 0]),
        (fmi2False, &[warning], [0, 1]),
        (fmi2False, &[error, warning], [0, 0]),
        (fmi2True, &[error, warning], [1, 1]),
    ];
    assert_eq!(heard(&Fmu::new()), [1, 1]);
    for (on, categories, expected) in cases {
        let fmu = Fmu::new();
        assert_eq!(choose(&fmu, on, categories), fmi2OK);
        assert_eq!(heard(&fmu), expected, "{on} {categories:?}");
    }
}

#[test]
fn an_unknown_category_is_a_warning_that_changes_nothing() {
    let fmu = Fmu::new();
    assert_eq!(choose(&fmu, fmi2False, &[LOG_STATUS_ERROR, c"log%sAll"]), fmi2Warning);
    // As a printf format this reads "log%sAll".
    fmu.expect_message(
        fmi2Warning,
        &[
            "fmi2SetDebugLogging",
            "log%%sAll",
            "logStatusError and logStatusWarning",
        ],
    );
    assert_eq!(heard(&fmu), [1, 1]);
}

#[test]
fn messages_carry_the_name_of_the_instance_and_the_function() {
    let fmu = Fmu::new();
    assert_eq!(fmu.step(0.0, 1.0), fmi2Error);
    let messages = fmu.messages();
    assert_eq!(messages[0].instance, "relay 1");
    assert_eq!(messages[0].status, fmi2Error);
    assert!(messages[0].text.starts_with("fmi2DoStep: "), "{messages:?}");
}

static STATUS_INSIDE: AtomicU32 = AtomicU32::new(fmi2OK);

/// Calls back into the instance it hears from, whose address the environment holds; the standard forbids that.
unsafe extern "C" fn meddle(
    environment: fmi2ComponentEnvironment,
    _: fmi2String,
    _: fmi2Status,
    _: fmi2String,
    _: fmi2String,
) {
    let component = unsafe { *environment.cast::<fmi2Component>() };
    if !component.is_null() {
        STATUS_INSIDE.store(unsafe { fmi2Reset(component) }, Ordering::SeqCst);
        unsafe { fmi2FreeInstance(component) };
    }
}

#[test]
fn a_logger_that_calls_back_is_refused_and_harms_nothing() {
    type Fixed = unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String);
    let mut component: fmi2Component = ptr::null_mut();
    let place = &raw mut component;
    let callbacks = fmi2CallbackFunctions {
        // As in the harness.
        logger: unsafe { std::mem::transmute::<Fixed, fmi2CallbackLogger>(meddle) },
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: place.cast(),
    };
    let guid = std::ffi::CString::new(GUID).unwrap();
    unsafe {
        let made = fmi2Instantiate(
            c"relay".as_ptr(),
            fmi2CoSimulation,
            guid.as_ptr(),
            ptr::null(),
            &raw const callbacks,
            0,
            1,
        );
        place.write(made);
        assert_eq!(fmi2DoStep(made, 0.0, 1.0, 1), fmi2Error);
        assert_eq!(STATUS_INSIDE.load(Ordering::SeqCst), fmi2Error);
        assert_eq!(fmi2Reset(made), fmi2OK);
        fmi2FreeInstance(made);
    }
}
