//! Whether there is memory for what is large. Rust's allocations end the process where there is none, so it is asked first.

use std::hint::black_box;

use crate::error::SceneError;

/// Refuses what takes so many bytes in one piece where the system does not give them. They are returned at once: nobody else should
/// take them meanwhile.
pub(crate) fn check(bytes: usize) -> Result<(), SceneError> {
    let mut room = Vec::<u8>::new();
    let given = room.try_reserve_exact(bytes);
    // An allocation that is not used would be optimised away.
    black_box(&room);
    given.map_err(|_| SceneError::Memory(bytes))
}
