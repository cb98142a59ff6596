//! The C functions of FMI 2.0 for co-simulation: a thin shell over [`crate::simulation::Simulation`].
//!
//! All functions take pointers from C. Their common contract: a component comes from [`fmi2Instantiate`] and was not
//! freed; a string ends with a zero byte; an array holds as many elements as the call says. Null pointers and pointers
//! that do not suit their type are refused, and so is a component that is in use by another call.
//!
//! The only unsafe code of the library lives in this folder.
#![allow(unsafe_code)]
// The names are those of the standard, and so is the contract for callers, given once above.
#![allow(
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals,
    clippy::missing_safety_doc
)]

mod co_simulation;
mod common;
mod entry;
mod failure;
mod fmu_state;
mod instance;
mod logger;
mod report;
mod serial;
pub mod states;
mod types;
mod values;

pub use co_simulation::*;
pub use common::*;
pub use fmu_state::*;
pub use logger::Category;
pub use types::*;
pub use values::*;
