//! Base acceleration generated inside the component, and [`drive`]: what comes from the inputs.
//!
//! One file for each idea of a waveform: [`sine`], also one half wave of it; [`sweep`]; [`random`]. A generator runs
//! within its [`window`]; outside of it there is no acceleration.

pub mod drive;
pub mod generator;
pub mod random;
pub mod sine;
pub mod sweep;
pub mod waveform;
pub mod window;
