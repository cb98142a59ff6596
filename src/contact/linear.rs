//! The contact law linearised about the preload; it opens when the force would become tensile, or is bonded.
//!
//! `F = max(0, F_0 + k_j0 (d - d_0) + beta_c k_j0 d')`, which the modal and frequency-domain analyses of Machines 2025,
//! 13(1), 52 use; bonded: the same without `max`.

use crate::contact::Branches;
use crate::math::nodal::Nodal;

/// Constants of the linear law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// k_j0, N/m.
    pub stiffness: f64,
    /// Damping time beta_c, s.
    pub damping: f64,
    /// Indentation at which the force of a contact at rest is zero, d_0 - F_0 / k_j0, m.
    pub offset: f64,
    /// Whether the contact bears tension.
    pub bonded: bool,
}

impl Linear {
    /// Force over stiffness, m: positive while the contact is closed, which it always is when bonded.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        if self.bonded { f64::INFINITY } else { self.branch_engagement(d, rate) }
    }

    /// The force, also where tensile, at several indentations (m) and velocities (m/s).
    #[inline(always)]
    pub(crate) fn closed_branches<const S: usize>(&self, d: &Nodal<S>, rate: &Nodal<S>) -> Branches<S> {
        let mut forces = *d;
        for (force, rate) in forces.iter_mut().zip(rate) {
            *force = self.stiffness * self.branch_engagement(*force, *rate);
        }
        Branches { forces, stiffness: [self.stiffness; S], damping: [self.damping * self.stiffness; S] }
    }

    /// Mean elastic force between two indentations (m), N.
    pub fn mean_force(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b) - self.offset, a.max(b) - self.offset);
        if self.bonded || low > 0.0 {
            self.stiffness * f64::midpoint(low, high)
        } else if high > 0.0 {
            0.5 * self.stiffness * high * (high / (high - low))
        } else {
            0.0
        }
    }

    /// Elastic energy at `d0 + deviation` above its tangent at `d0` (m), J; never negative.
    pub fn energy_above_tangent(&self, d0: f64, deviation: f64) -> f64 {
        let (start, end) = (d0 - self.offset, d0 - self.offset + deviation);
        if self.bonded || start > 0.0 && end > 0.0 {
            0.5 * self.stiffness * deviation * deviation
        } else if start > 0.0 {
            self.stiffness * start * (0.5 * start - end)
        } else {
            0.5 * self.stiffness * end.max(0.0).powi(2)
        }
    }

    /// Mean stiffness between two indentations (m), N/m.
    pub fn mean_stiffness(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b) - self.offset, a.max(b) - self.offset);
        if self.bonded || low > 0.0 {
            self.stiffness
        } else if high > 0.0 {
            self.stiffness * (high / (high - low))
        } else {
            0.0
        }
    }

    fn branch_engagement(&self, d: f64, rate: f64) -> f64 {
        d - self.offset + self.damping * rate
    }
}
