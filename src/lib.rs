//! Relay contact on a cantilever spring under vibration: contact force and contact resistance, opening and closing.
//!
//! From `modelDescription.xml` follow the [`variables`]; from a [`scene`] its springs, contacts and preload, and from these the model,
//! which never changes. The integrator takes model, state and inputs over a communication step, a [`simulation`] is read by output,
//! and [`fmi2`] is all of it behind the C interface of FMI 2.0. CONTRIBUTING.md has a map of the modules.
//!
//! ```
//! use relay_contact::inputs::Inputs;
//! use relay_contact::scene::Scene;
//! use relay_contact::simulation::Simulation;
//! use relay_contact::variables::{ExcitationKind, RealOutput};
//!
//! let mut scene = Scene::default();
//! scene.effects.excitation = ExcitationKind::Sine; // 98 m/s2 at 1000 Hz
//! let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
//! contact.step(&Inputs::default(), 0.0, 1e-3)?;
//! assert!(contact.real(RealOutput::ContactForce) > 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source of the physics: Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52, <https://doi.org/10.3390/machines13010052>.
#![deny(unsafe_code)]
// Without `fmi2`, some of what only that calls.
#![cfg_attr(target_family = "wasm", allow(dead_code))]
#![warn(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable,
    clippy::indexing_slicing
)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod armature;
mod assembly;
mod beam;
mod chatter;
mod circuits;
mod closed_loop;
mod conduction;
mod contact;
mod electrical;
pub mod error;
mod excitation;
mod fingerprint;
// No importer loads WebAssembly, which has no C library.
#[cfg(not(target_family = "wasm"))]
pub mod fmi2;
mod force_error;
mod foundation;
mod harmonic;
pub mod inputs;
mod integrator;
mod link;
mod magnet;
pub mod many;
mod math;
mod memory;
mod model;
mod preload;
pub mod reference;
pub mod scene;
mod settle;
mod shared;
pub mod simulation;
mod slip_stability;
mod state;
pub mod variables;

/// `modelDescription.xml` with the GUID filled in, as it stands in the packaged component.
pub const MODEL_DESCRIPTION: &str = include_str!(concat!(env!("OUT_DIR"), "/modelDescription.xml"));

/// The same with all numbers as Reals, choices and Booleans too, for tools that know nothing else or cannot set enumerations.
pub const PLAIN_MODEL_DESCRIPTION: &str = include_str!(concat!(env!("OUT_DIR"), "/plain.xml"));

/// The header for C programs that link the library: its functions, the GUID, and the value references by name.
pub const C_HEADER: &str = include_str!(concat!(env!("OUT_DIR"), "/include/relay_contact.h"));
