//! Entry and exit of every function: checks that the component is an instance and that the call is allowed now,
//! handles failures and panics. Also the checks of pointers.

use std::cell::UnsafeCell;
use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::sync::atomic::{AtomicU64, Ordering};

use super::environment::with_default;
use super::failure::Failure;
use super::instance::Instance;
use super::states::Function;
use super::types::{fmi2Component, fmi2Error, fmi2OK, fmi2Status, fmi2String};
use crate::error::caught;

/// What a component points to. The guard comes first: it distinguishes an instance from other memory, and rejects a
/// second call during a call, from another thread or from the importer's log callback.
#[repr(C)]
struct Handle {
    guard: AtomicU64,
    instance: UnsafeCell<Instance>,
}

const IDLE: u64 = u64::from_be_bytes(*b"relay\0id");
const BUSY: u64 = u64::from_be_bytes(*b"relay\0bu");
const FREED: u64 = u64::from_be_bytes(*b"relay\0fr");

/// Moves an instance to the heap and returns a pointer for C.
pub(super) fn hand_out(instance: Instance) -> fmi2Component {
    Box::into_raw(Box::new(Handle { guard: AtomicU64::new(IDLE), instance: UnsafeCell::new(instance) })).cast()
}

/// Takes an instance back and drops it. A pointer that is not an instance, or one in use, is ignored.
///
/// # Safety
/// `component` is null or points to readable memory.
pub(super) unsafe fn take_back(component: fmi2Component) {
    // SAFETY: passed on to the caller.
    if let Some(handle) = unsafe { occupy(component, FREED) } {
        // SAFETY: the guard held IDLE, so the memory came from `hand_out` and nobody else uses it.
        let handle = unsafe { Box::from_raw(handle.cast_mut()) };
        // A panic must not reach C, and no instance is left to report it.
        let _ = caught(move || drop(handle));
    }
}

/// The handle behind a component, its guard moved from idle to `next`; `None` unless it is an idle instance.
unsafe fn occupy(component: fmi2Component, next: u64) -> Option<*const Handle> {
    let handle = component.cast_const().cast::<Handle>();
    if handle.is_null() || !handle.is_aligned() {
        return None;
    }
    // SAFETY: not null and aligned; the caller promises readable memory. Only a guard that holds IDLE is written.
    let guard = unsafe { &(*handle).guard };
    // Read first, so that memory that is not an instance is not written to.
    (guard.load(Ordering::Relaxed) == IDLE
        && guard.compare_exchange(IDLE, next, Ordering::Acquire, Ordering::Relaxed).is_ok())
    .then_some(handle)
}

/// Runs one call on an instance: `body` if the state allows it, then logs the outcome and updates the state.
///
/// # Safety
/// `component` is null or points to readable memory.
pub(super) unsafe fn call(
    component: fmi2Component,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
) -> fmi2Status {
    // SAFETY: passed on to the caller.
    let Some(handle) = (unsafe { occupy(component, BUSY) }) else { return fmi2Error };
    // SAFETY: the guard held IDLE, so the memory came from `hand_out`; it holds BUSY now, so nobody else has a reference.
    let (guard, instance) = unsafe { (&(*handle).guard, &mut *(*handle).instance.get()) };
    let status = with_default(|| {
        let result = if function.allowed.contains(&instance.state) {
            caught(|| body(instance)).unwrap_or_else(|panic| {
                // It may be inconsistent.
                instance.simulation = None;
                Err(Failure::Panic(panic))
            })
        } else {
            Err(Failure::CallOrder { function, state: instance.state })
        };
        match result {
            Ok(()) => fmi2OK,
            Err(failure) => instance.fail(function, &failure),
        }
    });
    guard.store(IDLE, Ordering::Release);
    status
}

fn usable<T>(pointer: *const T, length: usize) -> bool {
    !pointer.is_null() && pointer.is_aligned() && length <= isize::MAX.unsigned_abs() / size_of::<T>().max(1)
}

/// An array to read. An empty one may be null.
///
/// # Safety
/// Unless null, `pointer` leads to `length` elements that stay unchanged during the call.
pub(super) unsafe fn array<'a, T>(pointer: *const T, length: usize, name: &'static str) -> Result<&'a [T], Failure> {
    match length {
        0 => Ok(&[]),
        // SAFETY: usable, and the rest is promised by the caller.
        _ if usable(pointer, length) => Ok(unsafe { std::slice::from_raw_parts(pointer, length) }),
        _ => Err(Failure::Pointer(name)),
    }
}

/// An array to write, whose elements need not hold a value yet. An empty one may be null.
///
/// # Safety
/// Unless null, `pointer` leads to `length` elements that nobody else uses during the call.
pub(super) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    length: usize,
    name: &'static str,
) -> Result<&'a mut [MaybeUninit<T>], Failure> {
    match length {
        0 => Ok(&mut []),
        // SAFETY: usable, and the rest is promised by the caller.
        _ if usable(pointer, length) => Ok(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), length) }),
        _ => Err(Failure::Pointer(name)),
    }
}

/// A single element to write.
///
/// # Safety
/// Unless null, `pointer` leads to an element that nobody else uses during the call.
pub(super) unsafe fn place<'a, T>(pointer: *mut T, name: &'static str) -> Result<&'a mut MaybeUninit<T>, Failure> {
    // SAFETY: passed on to the caller.
    match unsafe { array_mut(pointer, 1, name) }? {
        [place] => Ok(place),
        _ => Err(Failure::Pointer(name)),
    }
}

/// A string.
///
/// # Safety
/// Unless null, `text` ends with a zero byte.
pub(super) unsafe fn text<'a>(text: fmi2String, name: &'static str) -> Result<&'a CStr, Failure> {
    if text.is_null() {
        return Err(Failure::Pointer(name));
    }
    // SAFETY: not null, and the rest is promised by the caller.
    Ok(unsafe { CStr::from_ptr(text) })
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use super::super::states::{DO_STEP, GET_REAL, RESET, State};
    use super::super::types::fmi2CallbackFunctions;
    use super::*;
    use crate::fmi2::logger::Logger;
    use crate::fmi2::resources::Identity;

    #[test]
    #[allow(clippy::panic)]
    fn a_panic_becomes_an_error_that_a_reset_heals() {
        // SAFETY: callbacks that are none, and a null pointer.
        let silent: fmi2CallbackFunctions = unsafe { std::mem::zeroed() };
        let logger = Logger::new(&silent, c"relay", false);
        let instance = Instance::new(logger, (None, ptr::null_mut()), None, Identity::default());
        let component = hand_out(instance.unwrap());
        let state = |instance: &mut Instance, expected| {
            assert_eq!(instance.state, expected);
            Ok(())
        };
        // SAFETY: the component was handed out above and is freed at the end.
        unsafe {
            assert_eq!(call(component, RESET, |_| panic!("internal")), fmi2Error);
            assert_eq!(call(component, GET_REAL, |instance| state(instance, State::Error)), fmi2OK);
            assert_eq!(call(component, DO_STEP, |_| Ok(())), fmi2Error);
            let reset = |instance: &mut Instance| {
                instance.reset();
                state(instance, State::Instantiated)
            };
            assert_eq!(call(component, RESET, reset), fmi2OK);
            take_back(component);
        }
    }
}
