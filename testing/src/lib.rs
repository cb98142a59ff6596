//! What tests, benches and the report share. Not part of the component.
//!
//! ```text
//! rig       a model under way, also one put together from modes without a beam, with its energy
//! scenes    scenes that tests begin with, and what is known of them without the library
//! log       the messages of an instance
//! instance  fmi2Instantiate with any arguments, and an instance of the library linked into the program
//! ```
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs, or, as the test says, without
#![allow(clippy::missing_panics_doc)] // tests are made of this
#![allow(clippy::wildcard_imports)] // of the standard's types and statuses

pub mod instance;
pub mod log;
pub mod rig;
pub mod scenes;
