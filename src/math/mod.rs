//! Numerical tools without contact mechanics: quadrature, polynomials, root finding, vector arithmetic.

pub mod elementary;
pub mod free_motion;
pub mod legendre;
pub mod nodal;
pub mod prediction;
pub mod roots;
pub mod series;
pub mod simd;
