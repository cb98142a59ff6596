//! Cost of accuracy: the component compared with general integrators on the same equations, with the same error measure.
//!
//! ```text
//! scenes      what is simulated
//! problem     the modal equations of a scene, in the form general integrators need
//! integrator  their interface: forces on a grid, times of opening and closing, time spent
//! component, cvode, diffsol    the integrators
//! radau       the reference, with its own error estimate
//! study       runs them against the reference, interleaved
//! instances   start, end and memory of an instance; many of them
//! machine     processor and versions
//! ```
#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // used only by its programs

pub mod component;
pub mod cvode;
#[cfg(feature = "diffsol")]
pub mod diffsol;
pub mod instances;
pub mod integrator;
pub mod machine;
pub mod problem;
pub mod radau;
pub mod scenes;
pub mod study;
