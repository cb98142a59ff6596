//! The spring: section, axial force, exact characteristic equation, Galerkin modes and static compliance.

pub mod axial;
pub mod characteristic;
pub mod galerkin;
pub mod mode;
pub mod mode_count;
pub mod section;
pub mod statics;
