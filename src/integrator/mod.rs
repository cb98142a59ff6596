//! The transient integrator.
//!
//! The beam is linear and only its tip is loaded, so the modes are propagated exactly and the whole nonlinearity is one
//! scalar function of one scalar, the tip. A communication step goes down through these files:
//!
//! - [`dense`]: a communication step, also where its end lies inside a step of the integrator; [`workspace`]: the room
//!   for it, made once.
//! - [`advance`]: integration steps one after the other; [`attempt`]: on trial, taken or rejected by an estimate of the
//!   error of the force; [`grid`]: the grid they end on; [`budget`]: how many there may be; [`rest`]: a contact at
//!   rest takes none.
//! - [`switching`]: steps end where the contact opens ([`release`]) or closes ([`touchdown`]), and begin anew;
//!   [`events`] keeps a list.
//! - [`watch`]: extremes of the force within steps, and where it passes that of an interruption.
//! - [`fallback`]: a step with a constant force, where the collocation cannot go on.
//! - [`energy`]: where nothing dissipates, the energy is kept. [`ledger`]: what a step loses or makes of it.
//!
//! One step, in which the contact force is a polynomial through Radau nodes ([`collocation`]):
//!
//! - [`nodal`]: the forces at the nodes, the motion they give, the estimate of the error; [`newton`]: Newton's method
//!   on the nodal forces alone.
//! - [`coefficients`]: everything of it that depends on its length alone, kept for lengths that come again.
//! - [`mode_over_step`]: a mode's exact response to the polynomial ([`free_motion`] without load); [`shapes`]:
//!   integrals and derivatives of the polynomials; [`response`]: the responses of many modes added up.
//! - [`machine`]: the kernel is compiled for the processor; [`vector`]: the arithmetic in it.
//!
//! Where the axial force follows the deflection:
//!
//! - [`axial`]: the step with loads on every mode that follow from the motion.
//!
//! Where the contact is linear and stays closed, a communication step is one exact step:
//!
//! - [`linear`]: the step, in the eigenvectors of beam and contact; [`oscillator`]: each pair of eigenvalues on its
//!   own; [`propagator`]: its motion over a step, kept for lengths that come again.
//! - [`secular`]: eigenvalues and eigenvectors; [`zeros`]: the eigenvalues where beam and contact are damped
//!   differently.

pub mod attempt;
pub mod collocation;
pub mod communication_step;
pub mod discrete_gradient;
pub mod energy;
pub mod events;
pub mod exact_step;
pub mod extremes;
pub mod grid;
pub mod integration;
pub mod motion;
pub mod rest;
pub mod step_control;
pub mod workspace;
