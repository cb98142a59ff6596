//! The transient integrator.
//!
//! The beam is linear and only its tip is loaded, so the modes are propagated exactly and the whole nonlinearity is one
//! scalar function of one scalar, the tip. Over a step the contact force is a polynomial through Radau nodes
//! ([`collocation`]); each mode's exact response to it ([`shapes`], [`response`], [`coefficients`]) gives the indentation at the nodes,
//! and Newton's method on the nodal forces alone closes the loop ([`nodal`]). Steps adapt to an estimate of the
//! force's error ([`advance`], on a grid: [`progress`], in room made once: [`workspace`]) and end where the contact opens
//! ([`release`]) or closes ([`touchdown`]). The kernel is compiled for the processor ([`machine`]). Where the collocation cannot
//! go on, a step with a constant force does ([`fallback`]); where nothing dissipates, the energy is kept ([`energy`]).
//! Communication points may lie inside a step ([`dense`]), and a contact at rest takes none ([`rest`]).
//!
//! Where the contact is linear and stays closed, a communication step is one exact step ([`linear`]) in the eigenvectors of beam
//! and contact ([`oscillator`], [`secular`], [`zeros`]).

pub mod advance;
pub mod coefficients;
pub mod collocation;
pub mod dense;
pub mod energy;
pub mod fallback;
pub mod free_motion;
pub mod linear;
pub mod machine;
pub mod mode_over_step;
pub mod newton;
pub mod nodal;
pub mod oscillator;
pub mod progress;
pub mod release;
pub mod response;
pub mod rest;
pub mod secular;
pub mod shapes;
pub mod switching;
pub mod touchdown;
pub mod vector;
pub mod workspace;
pub mod zeros;
