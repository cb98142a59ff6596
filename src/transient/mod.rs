//! The transient integrator.
//!
//! The beam is linear and only its tip is loaded, so the modes are propagated exactly and the whole nonlinearity is one
//! scalar function of one scalar, the tip. Over a step the contact force is a polynomial through Radau nodes
//! ([`collocation`]); each mode's exact response to it ([`response`], [`coefficients`]) gives the indentation at the nodes,
//! and Newton's method on the nodal forces alone closes the loop ([`nodal`]). Steps adapt to an estimate of the
//! force's error ([`advance`], on a grid: [`progress`], in room made once: [`workspace`]) and
//! end where the contact opens ([`release`]) or closes ([`touchdown`]). Where that fails, a step with a constant force goes on
//! ([`fallback`]).
//! Where nothing dissipates the energy is kept ([`energy`]).

pub mod advance;
pub mod coefficients;
pub mod collocation;
pub mod energy;
pub mod fallback;
pub mod nodal;
pub mod progress;
pub mod release;
pub mod response;
pub mod touchdown;
pub mod workspace;
