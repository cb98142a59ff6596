//! The spring: section, segments or modes; axial force, exact characteristic equation, Galerkin modes and static
//! compliance.

pub mod axial;
pub mod characteristic;
pub mod galerkin;
mod given;
mod mesh;
pub mod mode;
pub mod mode_count;
mod pieces;
pub mod resolution;
mod ritz;
pub mod section;
pub mod spring;
pub mod springs;
pub mod statics;
mod tongues;
