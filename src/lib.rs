//! Relay contact on a cantilever spring under vibration.
#![deny(unsafe_code)]
#![warn(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable,
    clippy::indexing_slicing
)]

pub mod beam;
pub mod contact;
pub mod electrical;
pub mod error;
pub mod excitation;
pub mod fmi2;
pub mod harmonic;
pub mod inputs;
pub mod math;
pub mod model;
pub mod preload;
pub mod scene;
pub mod scene_file;
pub mod simulation;
pub mod transient;
pub mod variables;

/// `modelDescription.xml` with the GUID filled in, as it stands in the packaged component.
pub const MODEL_DESCRIPTION: &str = include_str!(concat!(env!("OUT_DIR"), "/modelDescription.xml"));
