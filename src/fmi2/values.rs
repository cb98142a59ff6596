//! Reading and setting variables.

use std::ffi::CStr;

use libc::size_t;

use super::entry::{array, array_mut, call, text};
use super::failure::Failure;
use super::instance::Instance;
use super::instance::variables::Value;
use super::states::{self, Function};
use super::types::{
    fmi2Boolean, fmi2Component, fmi2False, fmi2Integer, fmi2Real, fmi2Status, fmi2String, fmi2ValueReference,
};

/// Reads one value for each reference.
unsafe fn get<T>(
    c: fmi2Component,
    function: Function,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *mut T,
    read: impl Fn(&mut Instance, u32) -> Result<T, Failure>,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, function, |instance| {
            let (references, values) = (array(vr, nvr, "vr")?, array_mut(value, nvr, "value")?);
            for (&reference, value) in references.iter().zip(values) {
                value.write(read(instance, reference)?);
            }
            Ok(())
        })
    }
}

/// Sets the values of the references, all or none.
unsafe fn set<'a, T: Copy>(
    c: fmi2Component,
    function: Function,
    kind: &'static str,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *const T,
    read: impl Fn(T) -> Result<Value<'a>, Failure>,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, function, |instance| {
            let (references, values) = (array(vr, nvr, "vr")?, array(value, nvr, "value")?);
            instance.set(kind, references, values.iter().map(|value| read(*value)))
        })
    }
}

/// Reads real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *mut fmi2Real,
) -> fmi2Status {
    let read = |instance: &mut Instance, reference| instance.value("Real", reference);
    // SAFETY: the contract of the module.
    unsafe { get(c, states::GET_REAL, vr, nvr, value, read) }
}

/// Reads integer and enumeration variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *mut fmi2Integer,
) -> fmi2Status {
    #[expect(clippy::cast_possible_truncation, reason = "it was an integer")]
    let read = |instance: &mut Instance, reference| Ok(instance.value("Integer", reference)? as fmi2Integer);
    // SAFETY: the contract of the module.
    unsafe { get(c, states::GET_INTEGER, vr, nvr, value, read) }
}

/// Reads Boolean variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    let read = |instance: &mut Instance, reference| Ok((instance.value("Boolean", reference)? != 0.0).into());
    // SAFETY: the contract of the module.
    unsafe { get(c, states::GET_BOOLEAN, vr, nvr, value, read) }
}

/// Reads string variables. The strings stay until this function is called for another value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *mut fmi2String,
) -> fmi2Status {
    let read = |instance: &mut Instance, reference| instance.string(reference).map(CStr::as_ptr);
    // SAFETY: the contract of the module.
    unsafe { get(c, states::GET_STRING, vr, nvr, value, read) }
}

/// Sets real inputs and parameters. A value outside its range gives `fmi2Discard`, and none is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { set(c, states::SET_REAL, "Real", vr, nvr, value, |value| Ok(Value::Number(value))) }
}

/// Sets integer and enumeration parameters. A value that is not allowed gives `fmi2Discard`, and none is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *const fmi2Integer,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { set(c, states::SET_INTEGER, "Integer", vr, nvr, value, |value| Ok(Value::Number(value.into()))) }
}

/// Sets Boolean parameters. Every value except `fmi2False` is true.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *const fmi2Boolean,
) -> fmi2Status {
    let read = |value| Ok(Value::Number(u8::from(value != fmi2False).into()));
    // SAFETY: the contract of the module.
    unsafe { set(c, states::SET_BOOLEAN, "Boolean", vr, nvr, value, read) }
}

/// Sets string parameters. A file that cannot be read or is wrong gives `fmi2Discard`, and none is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    value: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    let read = |value| unsafe { text(value, "value") }.map(Value::Text);
    // SAFETY: the contract of the module.
    unsafe { set(c, states::SET_STRING, "String", vr, nvr, value, read) }
}
