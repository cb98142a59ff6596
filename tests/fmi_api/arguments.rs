//! Pointers that lead nowhere.

use std::ptr;

use relay_contact::fmi2::*;
use relay_contact::variables::GUID;

use crate::harness::{Fmu, vr};

#[test]
fn a_null_component_is_an_error_and_freeing_it_does_nothing() {
    unsafe {
        assert_eq!(fmi2DoStep(ptr::null_mut(), 0.0, 1.0, 1), fmi2Error);
        assert_eq!(fmi2Reset(ptr::null_mut()), fmi2Error);
        assert_eq!(fmi2GetReal(ptr::null_mut(), ptr::null(), 0, ptr::null_mut()), fmi2Error);
        fmi2FreeInstance(ptr::null_mut());
    }
}

#[test]
fn memory_that_is_no_instance_is_left_alone() {
    let mut memory = [0x5a5a_5a5a_5a5a_5a5a_u64; 64];
    let component: fmi2Component = memory.as_mut_ptr().cast();
    unsafe {
        assert_eq!(fmi2Reset(component), fmi2Error);
        assert_eq!(fmi2Reset(component.byte_add(1)), fmi2Error);
        fmi2FreeInstance(component);
    }
    assert_eq!(memory, [0x5a5a_5a5a_5a5a_5a5a; 64]);
}

#[test]
fn null_arrays_are_errors_unless_empty() {
    let reference = vr("beam.length");
    let mut value = 0.0;
    let check = |call: &dyn Fn(fmi2Component) -> fmi2Status, argument: &str| {
        let fmu = Fmu::new();
        assert_eq!(call(fmu.component), fmi2Error, "{argument}");
        fmu.expect_message(fmi2Error, &[argument, "null"]);
        assert_eq!(fmu.set_real("beam.length", 0.02), fmi2Error);
    };
    let no_text: fmi2String = ptr::null();
    let value = &raw mut value;
    unsafe {
        check(&|c| fmi2GetReal(c, ptr::null(), 1, value), "argument vr");
        check(
            &|c| fmi2GetReal(c, &raw const reference, 1, ptr::null_mut()),
            "argument value",
        );
        check(
            &|c| fmi2GetReal(c, &raw const reference, usize::MAX, value),
            "argument vr",
        );
        check(
            &|c| fmi2GetReal(c, &raw const reference, 1, value.byte_add(1)),
            "argument value",
        );
        check(&|c| fmi2GetInteger(c, ptr::null(), 1, ptr::null_mut()), "argument vr");
        check(&|c| fmi2GetBoolean(c, ptr::null(), 1, ptr::null_mut()), "argument vr");
        check(&|c| fmi2GetString(c, ptr::null(), 1, ptr::null_mut()), "argument vr");
        check(&|c| fmi2SetReal(c, ptr::null(), 1, value), "argument vr");
        check(
            &|c| fmi2SetReal(c, &raw const reference, 1, ptr::null()),
            "argument value",
        );
        check(
            &|c| fmi2SetInteger(c, &raw const reference, 1, ptr::null()),
            "argument value",
        );
        check(
            &|c| fmi2SetBoolean(c, &raw const reference, 1, ptr::null()),
            "argument value",
        );
        check(
            &|c| fmi2SetString(c, &raw const reference, 1, ptr::null()),
            "argument value",
        );
        check(&|c| fmi2SetDebugLogging(c, 1, 1, ptr::null()), "argument categories");
        check(
            &|c| fmi2SetDebugLogging(c, 1, 1, &raw const no_text),
            "argument categories",
        );

        let fmu = Fmu::new();
        assert_eq!(fmi2GetReal(fmu.component, ptr::null(), 0, ptr::null_mut()), fmi2OK);
        assert_eq!(fmi2SetReal(fmu.component, ptr::null(), 0, ptr::null()), fmi2OK);
        let fmu = Fmu::initialized();
        assert_eq!(
            fmi2GetRealStatus(fmu.component, fmi2LastSuccessfulTime, ptr::null_mut()),
            fmi2Error
        );
        fmu.expect_message(fmi2Error, &["fmi2GetRealStatus", "argument value"]);
    }
}

#[test]
fn without_callbacks_there_is_no_instance_without_a_logger_there_is() {
    let guid = std::ffi::CString::new(GUID).unwrap();
    let silent = fmi2CallbackFunctions {
        logger: None,
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: ptr::null_mut(),
    };
    let make = |callbacks| unsafe {
        fmi2Instantiate(
            c"relay".as_ptr(),
            fmi2CoSimulation,
            guid.as_ptr(),
            ptr::null(),
            callbacks,
            0,
            0,
        )
    };
    assert!(make(ptr::null()).is_null());
    let component = make(&raw const silent);
    assert!(!component.is_null());
    unsafe {
        assert_eq!(fmi2DoStep(component, 0.0, 1.0, 1), fmi2Error);
        assert_eq!(fmi2Reset(component), fmi2OK);
        fmi2FreeInstance(component);
    }
}

#[test]
fn a_status_that_does_not_exist_is_discarded() {
    let fmu = Fmu::initialized();
    let mut time = 0.0;
    for kind in [fmi2DoStepStatus, fmi2Terminated, 99] {
        assert_eq!(
            unsafe { fmi2GetRealStatus(fmu.component, kind, &raw mut time) },
            fmi2Discard
        );
        fmu.expect_message(fmi2Discard, &["fmi2GetRealStatus", &format!("status kind {kind}")]);
    }
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
}
