//! The laws of the contacts: of the force along the normal, and of friction.

pub mod friction;
pub mod law;
