//! The C functions of FMI 2.0 for co-simulation: a thin shell over [`crate::simulation::Simulation`].
//! All functions take pointers from C. Their common contract: a component comes from [`fmi2Instantiate`] and has not
//! been freed; a string is null-terminated; an array has the number of elements given in the call. Null and misaligned
//! pointers are rejected, and so is a component in use by another call.
//!
//! The only unsafe code of the library lives in this folder.
#![allow(unsafe_code)]
// Names as in the standard; the contract for callers is given once above.
#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals, clippy::missing_safety_doc)]

mod co_simulation;
mod common;
mod course;
mod entry;
mod environment;
mod failure;
mod fmu_state;
mod instance;
mod logger;
mod report;
mod resources;
mod saved;
mod serial;
mod states;
mod types;
mod values;

pub use co_simulation::*;
pub use common::*;
pub use course::*;
pub use fmu_state::*;
pub use logger::Category;
pub use types::*;
pub use values::*;
