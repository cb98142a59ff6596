//! Beam with a linear contact: decoupled into oscillators, each propagated exactly over a step of any length.

pub mod dense;
pub mod eigenvalues;
pub mod eigenvectors;
pub mod oscillator;
pub mod problem;
pub mod propagator;
pub mod system;
