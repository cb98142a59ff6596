//! Saved states: copies of the whole instance, any number at a time, also serialized, each until it or the instance it
//! was made by is freed. Directional derivatives are not supported: the call is an error that does not change the
//! instance.
// Unused arguments keep their names for the header.
#![allow(unused_variables)]

use std::ptr;

use libc::size_t;

use super::entry::{array, array_mut, call, place};
use super::failure::Failure;
use super::instance::Instance;
use super::instance::snapshot::Snapshot;
use super::saved::{Saved, saved};
use super::types::{fmi2Byte, fmi2Component, fmi2FMUstate, fmi2Real, fmi2Status, fmi2ValueReference};
use super::{serial, states};
use crate::integrator::motion::Motion;
use crate::memory;

/// What a saved state with its motion takes of memory, and more, bytes.
const ROOM: usize = size_of::<Saved>() + 2 * size_of::<Motion>();

/// Stores a snapshot in the state that `FMUstate` points to or, if that is null, in a new one.
///
/// # Safety
/// Unless null, `FMUstate` leads to null or to a saved state.
unsafe fn keep(instance: &mut Instance, FMUstate: *mut fmi2FMUstate, snapshot: Snapshot) -> Result<(), Failure> {
    // SAFETY: passed on to the caller; the standard has the importer set it to null or to a saved state.
    let state = unsafe { place(FMUstate, "FMUstate")?.assume_init_mut() };
    if state.is_null() {
        *state = instance.saved_states.hand_out(snapshot);
    } else {
        // SAFETY: passed on to the caller.
        unsafe { saved(*state) }?.snapshot = snapshot;
    }
    Ok(())
}

/// Saves the instance, in the state that `FMUstate` points to or, if that is null, in a new one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::GET_FMU_STATE, |instance| {
            memory::check(ROOM).map_err(Failure::Scene)?;
            keep(instance, FMUstate, instance.snapshot())
        })
    }
}

/// Restores a saved state of the instance, which can be used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { call(c, states::SET_FMU_STATE, |instance| instance.restore(&saved(FMUstate)?.snapshot)) }
}

/// Frees a saved state and sets the pointer to null. Null is ignored. Those left are freed with their instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the contract of the module: null or initialised, and the importer's to write to.
    unsafe {
        call(c, states::FREE_FMU_STATE, |instance| {
            if let Ok([state]) = array(FMUstate, 1, "FMUstate")
                && !state.is_null()
            {
                instance.saved_states.free(*state)?;
                FMUstate.write(ptr::null_mut());
            }
            Ok(())
        })
    }
}

/// Size of the serialized state in bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut size_t,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::SERIALIZED_FMU_STATE_SIZE, |_| {
            let (saved, size) = (saved(FMUstate)?, place(size, "size")?);
            size.write(serial::to_bytes(&saved.snapshot)?.len());
            Ok(())
        })
    }
}

/// Serializes the saved state to `serializedState`, whose size must be that of `fmi2SerializedFMUstateSize`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: size_t,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::SERIALIZE_FMU_STATE, |_| {
            let (saved, room) = (saved(FMUstate)?, array_mut(serializedState, size, "serializedState")?);
            let bytes = serial::to_bytes(&saved.snapshot)?;
            let needed = bytes.len();
            if needed != size {
                return Err(Failure::Size { size, needed });
            }
            for (place, byte) in room.iter_mut().zip(bytes) {
                place.write(fmi2Byte::from_ne_bytes([byte]));
            }
            Ok(())
        })
    }
}

/// Restores a saved state from bytes, in the state that `FMUstate` points to or, if that is null, in a new one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: size_t,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::DE_SERIALIZE_FMU_STATE, |instance| {
            let bytes = array(serializedState, size, "serializedState")?;
            memory::check(ROOM).map_err(Failure::Scene)?;
            keep(instance, FMUstate, serial::from_bytes(bytemuck::cast_slice(bytes))?)
        })
    }
}

/// Not supported: an error that does not change the instance. In co-simulation these are the derivatives of outputs
/// with respect to inputs at the same communication point, and no output depends on these, as the dependencies in the
/// description state.
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
    let body = |_: &mut Instance| Err(Failure::Unsupported("providesDirectionalDerivative"));
    // SAFETY: the contract of the module.
    unsafe { call(c, states::GET_DIRECTIONAL_DERIVATIVE, body) }
}
