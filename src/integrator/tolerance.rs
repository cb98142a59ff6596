//! The errors allowed, all from `solver.tolerance` and the force scale.

use crate::integrator::constants::{AT_EVENT, LOOSEST, NEWTON, SHARE};

/// The errors allowed, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// In the contact force: `solver.tolerance` times the force scale, as steps are taken with it.
    pub(crate) force: f64,
    /// Added by a step.
    pub(crate) step: f64,
    /// Left by Newton's method in a nodal force.
    pub(crate) newton: f64,
    /// Added by a step that ends where a contact opens, and force that counts as zero where an event is located: a blow makes it a
    /// hundred times larger.
    pub(crate) at_event: f64,
}

impl Tolerance {
    /// Of a relative tolerance and a force scale (N).
    pub(crate) fn new(relative: f64, force_scale: f64) -> Self {
        let force = relative.min(LOOSEST) * force_scale;
        let step = SHARE * force;
        Self {
            force,
            step,
            newton: NEWTON * step,
            at_event: AT_EVENT * step,
        }
    }
}
