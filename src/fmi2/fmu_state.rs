//! Saved states and directional derivatives. Not supported: each call is an error that leaves the instance as it was.
// Arguments that are not looked at keep their names for the header.
#![allow(unused_variables)]

use libc::size_t;

use super::entry::{array, call};
use super::failure::Failure;
use super::instance::Instance;
use super::states::{self, Function};
use super::types::{fmi2Byte, fmi2Component, fmi2FMUstate, fmi2Real, fmi2Status, fmi2ValueReference};

/// Refuses a call for the reason that a capability flag gives.
///
/// # Safety
/// The contract of the module.
unsafe fn unsupported(c: fmi2Component, function: Function, flag: &'static str) -> fmi2Status {
    // SAFETY: passed on to the caller.
    unsafe { call(c, function, |_: &mut Instance| Err(Failure::Unsupported(flag))) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::GET_FMU_STATE, "canGetAndSetFMUstate") }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::SET_FMU_STATE, "canGetAndSetFMUstate") }
}

/// Not supported, but null, which the standard has ignored, is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module.
    let body = |_: &mut Instance| match unsafe { array(FMUstate, 1, "FMUstate") } {
        Ok([state]) if !state.is_null() => Err(Failure::Unsupported("canGetAndSetFMUstate")),
        _ => Ok(()),
    };
    // SAFETY: the contract of the module.
    unsafe { call(c, states::FREE_FMU_STATE, body) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut size_t,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::SERIALIZED_FMU_STATE_SIZE, "canSerializeFMUstate") }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: size_t,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::SERIALIZE_FMU_STATE, "canSerializeFMUstate") }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: size_t,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::DE_SERIALIZE_FMU_STATE, "canSerializeFMUstate") }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    vUnknown_ref: *const fmi2ValueReference,
    nUnknown: size_t,
    vKnown_ref: *const fmi2ValueReference,
    nKnown: size_t,
    dvKnown: *const fmi2Real,
    dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { unsupported(c, states::GET_DIRECTIONAL_DERIVATIVE, "providesDirectionalDerivative") }
}
