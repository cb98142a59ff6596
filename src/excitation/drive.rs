//! Base acceleration and motion of the fixed contact over a communication step, from the inputs.

use crate::inputs::Inputs;
use serde::{Deserialize, Serialize};

/// A base acceleration that is constant or grows with time, and a fixed contact that moves with constant velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Base acceleration at the start of the communication step, m/s2.
    acceleration: f64,
    /// Its rate, m/s3.
    pub jerk: f64,
    /// The start of the communication step, s.
    since: f64,
    /// Velocity of the fixed contact, m/s.
    pub support_rate: f64,
}

impl Drive {
    /// Over `size` seconds from `time` (s), in which the fixed contact moves by `way` (m).
    pub fn new(inputs: &Inputs, time: f64, size: f64, way: f64) -> Self {
        Self {
            acceleration: inputs.base_acceleration,
            jerk: inputs.base_acceleration_rate,
            since: time,
            support_rate: way / size,
        }
    }

    /// Base acceleration at an instant (s), m/s2.
    #[inline(always)]
    pub fn acceleration(&self, time: f64) -> f64 {
        self.acceleration + self.jerk * (time - self.since)
    }

    /// Whether the base acceleration is constant and the fixed contact at rest.
    pub fn is_constant(&self) -> bool {
        self.jerk == 0.0 && self.support_rate == 0.0
    }

    /// Whether both are constant and equal to those of the last communication step.
    pub fn continues(&self, last: &Self) -> bool {
        self.is_constant() && last.is_constant() && self.acceleration == last.acceleration
    }
}
