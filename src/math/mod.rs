//! Mathematics that is not about contacts: Legendre polynomials and Gauss nodes, bracketed roots.

pub mod legendre;
pub mod roots;
