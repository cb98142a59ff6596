//! The saved states of an instance: each on the heap until it is freed, at the latest with the instance.

use std::collections::BTreeSet;

use super::failure::Failure;
use super::instance::snapshot::Snapshot;
use super::types::fmi2FMUstate;

/// What a saved state points to. The guard comes first: it distinguishes it from other memory.
#[repr(C)]
pub(super) struct Saved {
    guard: u64,
    pub(super) snapshot: Snapshot,
}

impl Drop for Saved {
    fn drop(&mut self) {
        // Volatile, so that the compiler keeps it although the memory is freed: it tells that the state is.
        // SAFETY: a field of this value.
        unsafe { (&raw mut self.guard).write_volatile(FREED) };
    }
}

const SAVED: u64 = u64::from_be_bytes(*b"relay\0st");
const FREED: u64 = u64::from_be_bytes(*b"relay\0fs");

/// The saved states of an instance. Dropping it frees their memory.
#[derive(Debug, Default)]
pub(super) struct SavedStates(BTreeSet<*mut Saved>);

impl SavedStates {
    /// Moves a snapshot to the heap and returns a pointer for C.
    pub(super) fn hand_out(&mut self, snapshot: Snapshot) -> fmi2FMUstate {
        let state = Box::into_raw(Box::new(Saved { guard: SAVED, snapshot }));
        self.0.insert(state);
        state.cast()
    }

    /// Frees a saved state. The memory of one of another instance, which may be in use now, stays until that is freed.
    ///
    /// # Safety
    /// `state` is null or points to readable memory.
    pub(super) unsafe fn free(&mut self, state: fmi2FMUstate) -> Result<(), Failure> {
        // SAFETY: passed on to the caller.
        let saved = unsafe { saved(state) }?;
        if let Some(own) = self.0.take(&state.cast()) {
            // SAFETY: the memory came from `hand_out`, and its address is not kept any more.
            drop(unsafe { Box::from_raw(own) });
        } else {
            saved.guard = FREED;
        }
        Ok(())
    }
}

impl Drop for SavedStates {
    fn drop(&mut self) {
        while let Some(own) = self.0.pop_first() {
            // SAFETY: as in `free`.
            drop(unsafe { Box::from_raw(own) });
        }
    }
}

/// The saved state behind a pointer.
///
/// # Safety
/// `state` is null or points to readable memory.
pub(super) unsafe fn saved<'a>(state: fmi2FMUstate) -> Result<&'a mut Saved, Failure> {
    let foreign = Failure::ForeignState("FMUstate");
    let state = state.cast::<Saved>();
    if state.is_null() || !state.is_aligned() {
        return Err(foreign);
    }
    // SAFETY: not null and aligned; the caller promises readable memory.
    if unsafe { (&raw const (*state).guard).read() } != SAVED {
        return Err(foreign);
    }
    // SAFETY: the guard says that the memory came from `hand_out`; the caller promises that nobody else uses it.
    Ok(unsafe { &mut *state })
}
