//! Shared by tests, benches and the report. Not part of the component.
//!
//! ```text
//! rig       a model with its state and energy, also one built from modes without a beam
//! relays    random plausible relays, run and compared
//! kinds     kinds of them: laws, effects and inputs that not every relay has
//! parts     relays with more than one spring and contact
//! springs   springs of files, and random ones of segments for them
//! scenes    scenes for tests, with reference values computed without the library
//! log       the messages of an instance
//! allocator counts allocations
//! instance  fmi2Instantiate with any arguments, and an instance of the library linked into the program
//! ```
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with valid arguments, or with wrong ones on purpose
#![allow(clippy::not_unsafe_ptr_arg_deref)] // the component finds out what is a saved state of it
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)] // used only by tests
#![allow(clippy::wildcard_imports)] // of the standard's types and statuses

use std::fmt::Display;

pub mod allocator;
pub mod instance;
pub mod kinds;
pub mod log;
pub mod parts;
pub mod promise;
pub mod relays;
pub mod rig;
pub mod scenes;
pub mod springs;

/// The larger deviation; what is not a number is kept, which `f64::max` passes over.
pub fn worst(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

/// Asserts that a number is another one to what is allowed.
#[track_caller]
pub fn near(of: impl Display, found: f64, expected: f64, allowed: f64) {
    let off = (found - expected).abs();
    assert!(off <= allowed, "{of}: {found} instead of {expected}, off by {off:e} of {allowed:e}");
}

/// The same, relative to the number expected.
#[track_caller]
pub fn close(of: impl Display, found: f64, expected: f64, allowed: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off <= allowed, "{of}: {found} instead of {expected}, off by {off:e} of {allowed:e}");
}
