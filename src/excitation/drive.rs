//! Base acceleration and motion of the fixed contacts over a communication step, from the inputs.

use crate::inputs::Inputs;
use crate::link::Ways;
use serde::{Deserialize, Serialize};

/// A base acceleration that is constant or grows with time, and fixed contacts that move with constant velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Base acceleration at the start of the communication step, m/s2.
    acceleration: f64,
    /// Its rate, m/s3.
    pub jerk: f64,
    /// The start of the communication step, s.
    since: f64,
    /// Whether it is another one than before.
    new: bool,
    /// Velocities of the inputs that move bodies, m/s.
    pub velocities: Ways,
    /// Mean current of the coil, relative.
    pub coil: f64,
}

impl Drive {
    /// Over `size` seconds from `time` (s), in which the inputs move by these ways (m).
    pub fn new(inputs: &Inputs, time: f64, size: f64, ways: Ways) -> Self {
        Self {
            acceleration: inputs.base_acceleration,
            jerk: inputs.base_acceleration_rate,
            since: time,
            new: true,
            velocities: ways.map(|way| way / size),
            coil: inputs.coil_relative_current + 0.5 * size * inputs.coil_relative_current_rate,
        }
    }

    /// Base acceleration at an instant (s), m/s2.
    #[inline(always)]
    pub fn acceleration(&self, time: f64) -> f64 {
        self.acceleration + self.jerk * (time - self.since)
    }

    /// Whether it began less than half a step of `length` seconds before an instant (s).
    #[inline(always)]
    pub(crate) fn has_just_changed(&self, time: f64, length: f64) -> bool {
        self.new && time - self.since < 0.5 * length
    }

    /// Whether the base acceleration is constant and the fixed contacts at rest.
    pub fn is_constant(&self) -> bool {
        self.jerk == 0.0 && self.velocities.iter().all(|velocity| *velocity == 0.0)
    }

    /// Whether both are constant and equal to those of the last communication step.
    pub fn continues(&self, last: &Self) -> bool {
        self.is_constant() && last.is_constant() && self.acceleration == last.acceleration && self.coil == last.coil
    }
}
