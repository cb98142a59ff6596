//! The component for all platforms in one archive.

pub mod platform;
pub mod trial;
