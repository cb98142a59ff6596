//! The component against a second solution that shares nothing with it: finite elements instead of polynomial modes,
//! SUNDIALS ARKODE instead of collocation with exact modes, law, excitation and preload written again from the equations.
//! Common are the parameters of the relay alone.
//!
//! [`elements`]: the beam;   [`equilibrium`]: contact law and preload;   [`solution`]: the motion;   [`comparison`]: relays
//! solved by both;   [`table`]: the results.

pub mod comparison;
pub mod elements;
pub mod equilibrium;
pub mod solution;
pub mod table;
