//! The law between indentation and contact force.

pub mod friction;
pub mod law;

use crate::math::nodal::Nodal;

/// Force on the closed branch of a law, with its partial derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Branch {
    /// Force, N.
    pub force: f64,
    /// dF/dd, N/m.
    pub stiffness: f64,
    /// dF/dd', N s/m.
    pub damping: f64,
}

/// The same at several motions, field by field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Branches<const S: usize> {
    pub(crate) forces: Nodal<S>,
    pub(crate) stiffness: Nodal<S>,
    pub(crate) damping: Nodal<S>,
}

impl From<Branches<1>> for Branch {
    #[inline(always)]
    fn from(branches: Branches<1>) -> Self {
        let Branches { forces: [force], stiffness: [stiffness], damping: [damping] } = branches;
        Self { force, stiffness, damping }
    }
}
