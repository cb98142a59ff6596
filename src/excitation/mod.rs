//! Base acceleration: generated inside the component, and from the inputs ([`drive`]).
//!
//! One file per waveform: [`sine`], also the half sine; [`sweep`]; [`random`]. A generator acts within its [`Window`](waveform::Window).

pub mod drive;
pub mod generator;
pub mod random;
pub mod sine;
pub mod sweep;
pub mod waveform;
