//! The FMI 2.0 functions, called through their C signatures.
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs, or, as the test says, without

mod arguments;
mod derivatives;
mod fmu_state;
mod harness;
mod importers;
mod life_cycle;
#[path = "../../campaign/src/log.rs"]
mod log;
mod logging;
mod steps;
mod values;
