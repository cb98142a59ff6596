//! Beam and linear contact together as uncoupled oscillators, which are propagated exactly over any length of time.

pub mod eigenvalues;
pub mod eigenvectors;
pub mod oscillator;
pub mod problem;
pub mod propagator;
pub mod system;
