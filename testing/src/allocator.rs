//! An allocator that counts, for tests alone in their process: `#[global_allocator]`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr;

/// The system's allocator, which counts for each thread, and may refuse what is large.
#[derive(Debug)]
pub struct Counting;

thread_local! {
    static CALLS: Cell<usize> = const { Cell::new(0) };
    static HELD: Cell<isize> = const { Cell::new(0) };
    static LARGEST: Cell<usize> = const { Cell::new(usize::MAX) };
}

impl Counting {
    /// Number of allocations and deallocations of this thread.
    pub fn calls() -> usize {
        CALLS.get()
    }

    /// Number of allocations less that of deallocations of this thread.
    pub fn held() -> isize {
        HELD.get()
    }

    /// Refuses this thread more than so many bytes at a time from now on.
    pub fn refuse_above(bytes: usize) {
        LARGEST.set(bytes);
    }

    fn count(change: isize) {
        CALLS.set(CALLS.get() + 1);
        HELD.set(HELD.get() + change);
    }
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > LARGEST.get() {
            return ptr::null_mut();
        }
        Self::count(1);
        // SAFETY: passed on to the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        Self::count(-1);
        // SAFETY: passed on to the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}
