//! What stands behind a simulation, for reference solutions, other integrators on the same equations, and tests of the
//! integrator on problems that are no springs. Nobody who only simulates needs it.

pub use crate::beam::characteristic::frequencies;
pub use crate::beam::galerkin::Space;
pub use crate::beam::mode::{MAX_MODES, Mode, ModeState, Rayleigh};
pub use crate::beam::section::Section;
pub use crate::beam::spring::{Basis, Spring};
pub use crate::beam::statics::{Statics, axial_force_from_deflection};
pub use crate::contact::law::{Branch, Law, Opening, reduced_modulus};
pub use crate::electrical::ElectricalContact;
pub use crate::excitation::generator::Generator;
pub use crate::harmonic::{opening_threshold, response};
pub use crate::math::legendre::gauss;
pub use crate::math::roots::bracketed;
pub use crate::model::Model;
pub use crate::preload::{Initial, Preload};
pub use crate::state::State;
