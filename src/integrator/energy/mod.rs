//! Energy: the numerical balance as an output, and its conservation in undamped scenes.

pub mod balance;
pub mod conservation;
