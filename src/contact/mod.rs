//! The law between indentation and contact force.

pub mod friction;
pub mod law;
pub mod linear;
pub mod power;

/// Force on the closed branch of a law, with its partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Force, N.
    pub force: f64,
    /// dF/dd, N/m.
    pub stiffness: f64,
    /// dF/dd', N s/m.
    pub damping: f64,
}
