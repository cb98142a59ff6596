//! Mathematics that is not about contacts: Legendre polynomials and Gauss nodes, bracketed roots.

pub mod free_motion;
pub mod legendre;
pub mod nodal;
pub mod prediction;
pub mod roots;
pub mod simd;
