//! Base acceleration and motion of the fixed contacts over a communication step, from the inputs.

use crate::inputs::Inputs;
use crate::state::State;
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
    /// Velocity of the second fixed contact relative to the first, m/s.
    pub second_rate: f64,
}

impl Drive {
    /// Over `size` seconds from `time` (s), in which the fixed contacts move by these ways (m), the second relative to
    /// the first.
    pub fn new(inputs: &Inputs, time: f64, size: f64, [way, second_way]: [f64; 2]) -> Self {
        Self {
            acceleration: inputs.base_acceleration,
            jerk: inputs.base_acceleration_rate,
            since: time,
            support_rate: way / size,
            second_rate: second_way / size,
        }
    }

    /// Base acceleration at an instant (s), m/s2.
    #[inline(always)]
    pub fn acceleration(&self, time: f64) -> f64 {
        self.acceleration + self.jerk * (time - self.since)
    }

    /// In the view of the contact that the state is of.
    #[must_use]
    pub(crate) fn seen(&self, state: &State) -> Self {
        if state.mirrored { self.mirrored() } else { *self }
    }

    /// As the second contact sees it ([`State::mirror`]), and back.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            acceleration: -self.acceleration,
            jerk: -self.jerk,
            support_rate: self.second_rate - self.support_rate,
            ..*self
        }
    }

    /// Whether the base acceleration is constant and the fixed contacts at rest.
    pub fn is_constant(&self) -> bool {
        self.jerk == 0.0 && self.support_rate == 0.0 && self.second_rate == 0.0
    }

    /// Whether both are constant and equal to those of the last communication step.
    pub fn continues(&self, last: &Self) -> bool {
        self.is_constant() && last.is_constant() && self.acceleration == last.acceleration
    }
}
