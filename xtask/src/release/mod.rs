//! The component for all platforms in one archive.

pub mod check;
pub mod platform;
pub mod sums;
pub mod universal;
