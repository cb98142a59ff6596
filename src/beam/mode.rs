//! The damped modes of the springs without contact, and their motion.

use bytemuck::Zeroable;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::math::simd::LANES;

/// Largest number of modes; a multiple of four, the width of the vectors in a step.
pub const MAX_MODES: usize = 128;

/// A value for each mode; those beyond the modes in use are zero.
pub type Modal = [f64; MAX_MODES];

/// The values of a group of modes.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "the room for the modes is a whole number of lanes")]
pub(crate) fn lanes(values: &Modal, group: usize) -> &[f64; LANES] {
    &values.as_chunks::<LANES>().0[group]
}

/// Coefficients in the last functions of a space of shapes, sqrt(J).
pub type Last = [f64; LANES];

/// Springs that a relay may have: the moving one, that of the fixed contact, and tongues against each other.
pub const SPRINGS: usize = 3;

/// Damping in proportion to mass and stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// alpha, 1/s.
    pub alpha: f64,
    /// beta, s.
    pub beta: f64,
}

impl Rayleigh {
    /// Damping of a mode (Machines 2025, 13(1), 52, eq. (22)), 1/s.
    pub fn of(self, omega_squared: f64) -> f64 {
        self.alpha + self.beta * omega_squared
    }
}

/// One damped mode of a spring without contact, of modal mass 1 kg.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mode {
    /// omega_i^2, 1/s2.
    pub omega_squared: f64,
    /// c_i, 1/s: [`Rayleigh`]'s, or as a file or the armature has it.
    pub damping: f64,
    /// Displacement T_i that opens the contact, 1/sqrt(kg): of the tip, or of a fixed contact with the opposite sign.
    pub tip: f64,
    /// Load per base acceleration g_i, sqrt(kg).
    pub participation: f64,
    /// Rotation of the spring at the contact T_i', 1/(m sqrt(kg)).
    pub rotation: f64,
    /// Displacement of the fixed contact, 1/sqrt(kg); 0 of the moving spring.
    pub fixed: f64,
    /// Displacement that closes the gap between pusher and spring, 1/sqrt(kg).
    pub pusher: f64,
    /// Displacement that opens a parallel contact, 1/sqrt(kg).
    pub parallel: f64,
    /// Displacement of the armature towards the contact, 1/sqrt(kg); 0 of a spring.
    pub armature: f64,
}

impl Mode {
    /// Static displacement of the tip per force on it, m/N.
    pub fn compliance(&self) -> f64 {
        self.tip * self.tip / self.omega_squared
    }
}

/// Displacement and velocity of a mode, as deviation from the preload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, Zeroable)]
pub struct ModeState {
    /// Modal displacement, m sqrt(kg).
    pub q: f64,
    /// Modal velocity, m sqrt(kg) / s.
    pub v: f64,
}

/// States of all modes; those in use come first, the rest are zero.
pub type ModeStates = [ModeState; MAX_MODES];

/// Lowest angular frequency of modes with springs on them, each of a stiffness (N/m) and a participation in each mode, rad/s.
pub(crate) fn lowest_frequency(modes: &[Mode], springs: impl Iterator<Item = (f64, Modal)>) -> Option<f64> {
    let squares = modes.iter().map(|mode| mode.omega_squared);
    let mut rigidity = DMatrix::from_diagonal(&DVector::from_iterator(modes.len(), squares));
    for (stiffness, shape) in springs {
        let shape = DVector::from_iterator(modes.len(), shape.into_iter().take(modes.len()));
        rigidity.ger(stiffness, &shape, &shape, 1.0);
    }
    // From the inverse, whose largest eigenvalue has full relative accuracy.
    let flexibility = rigidity.cholesky()?.inverse();
    Some(1.0 / flexibility.symmetric_eigenvalues().max().sqrt())
}
