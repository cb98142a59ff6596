//! The errors allowed, all from `solver.tolerance` and the force scale.

use crate::integrator::constants::{AT_EVENT, LOOSEST, NEWTON, SHARE};

/// The errors allowed, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// `solver.tolerance`, as steps are taken with it, 1.
    relative: f64,
    /// In the contact force: that times the force scale.
    pub(crate) force: f64,
    /// Added by a step.
    pub(crate) step: f64,
    /// Left by Newton's method in a nodal force; no less than rounding of those at rest, which may be a thousand times that of the contact.
    pub(crate) newton: f64,
    /// Added by a step that ends where a contact opens, and force that counts as zero where an event is located: a blow makes it a
    /// hundred times larger.
    pub(crate) at_event: f64,
}

impl Tolerance {
    /// Of a relative tolerance and a force scale (N).
    pub(crate) fn new(relative: f64, force_scale: f64) -> Self {
        let relative = relative.min(LOOSEST);
        let force = relative * force_scale;
        let step = SHARE * force;
        Self { relative, force, step, newton: NEWTON * step, at_event: AT_EVENT * step }
    }

    /// In a contact force that is read and goes no further, where forces are as large as this (N).
    pub(crate) fn read(&self, largest: f64) -> f64 {
        self.force.max(self.relative * largest)
    }
}
