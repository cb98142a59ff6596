//! Whether there is memory for what is large. Rust's allocations end the process where there is none, so it is asked first.

use std::hint::black_box;

/// Whether the system gives so many bytes in one piece. They are returned at once: nobody else should take them meanwhile.
pub(crate) fn has(bytes: usize) -> bool {
    let mut room = Vec::<u8>::new();
    let given = room.try_reserve_exact(bytes).is_ok();
    // An allocation that is not used would be optimised away.
    black_box(&room);
    given
}
