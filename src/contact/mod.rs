//! The law between indentation and contact force.

pub mod hertz;
