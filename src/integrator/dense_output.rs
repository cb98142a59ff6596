//! Dense output of a step.

use serde::{Deserialize, Serialize};

use crate::integrator::course::Places;
use crate::math::prediction::Prediction;

/// Dense output of a step: polynomials of the tip. Deviations from the preload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseOutput {
    /// Contact force, N.
    pub force: Prediction,
    /// Indentation, m.
    pub indentation: Prediction,
    /// Its velocity, m/s.
    pub rate: Prediction,
    /// Where the contact force turns, for its extremes.
    pub turns: Places,
    /// Where it passes that of an interruption.
    pub passages: Places,
    /// Friction.
    pub friction: DenseFriction,
}

/// Dense output of friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseFriction {
    /// Slip, m.
    pub slip: Prediction,
    /// Energy dissipated so far, J.
    pub dissipated: Prediction,
}
