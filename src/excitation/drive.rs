//! Base acceleration and motion of the fixed contacts over a communication step, from the inputs.

use crate::inputs::Inputs;
use crate::link::{INPUTS, Ways};
use serde::{Deserialize, Serialize};

/// What importers' rounding makes of an input that goes on along a line, relative to it and to its way, 1.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

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
    /// Displacements of the inputs that move bodies at the start of the communication step, m.
    pub displacements: Ways,
    /// Their velocities, m/s.
    pub velocities: Ways,
    /// Mean current of the coil, relative.
    pub coil: f64,
}

impl Drive {
    /// With inputs that rest at these displacements (m).
    pub fn resting(displacements: Ways) -> Self {
        Self { displacements, ..Self::default() }
    }

    /// The next one, over `size` seconds from `time` (s), in which the inputs move from one displacement (m) to another, at these
    /// rates (m/s) if their importer has given them; `None` where all goes on as before, but for rounding: constant, or along the same
    /// line at the same rate.
    pub fn next(
        &self,
        inputs: &Inputs,
        (time, size): (f64, f64),
        (from, to): (Ways, Ways),
        rates: Ways,
    ) -> Option<Self> {
        let (acceleration, jerk) = (inputs.base_acceleration, inputs.base_acceleration_rate);
        let coil = inputs.coil_relative_current + 0.5 * size * inputs.coil_relative_current_rate;
        let goes_on =
            jerk == self.jerk && is_rounding(acceleration, self.acceleration(time), jerk, time) && coil == self.coil;
        if goes_on && rates == [0.0; INPUTS] && self.velocities == rates && to == self.displacements {
            return None;
        }
        let mut velocities = self.velocities;
        let mut moves_on = true;
        let ways = self.displacements.iter().zip(&rates).zip(from.iter().zip(&to));
        for (velocity, ((start, rate), (from, to))) in velocities.iter_mut().zip(ways) {
            let leads_to = |start: f64, length: f64| is_rounding(*to, start + rate * length, *rate, time);
            if *velocity == *rate && leads_to(*start, time + size - self.since) {
                continue;
            }
            moves_on = false;
            let way = to - from;
            *velocity = if leads_to(*from, size) {
                *rate
            } else if way.abs() <= ROUNDING * to.abs() {
                0.0
            } else {
                way / size
            };
        }
        let next = Self { acceleration, jerk, since: time, new: true, displacements: from, velocities, coil };
        (!(goes_on && moves_on)).then_some(next)
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

    /// Where it takes inputs from these displacements (m) in `length` seconds: not by the rounded time, which a stiff contact would feel.
    #[inline(always)]
    pub fn moved(&self, mut displacements: Ways, length: f64) -> Ways {
        for (displacement, velocity) in displacements.iter_mut().zip(&self.velocities) {
            *displacement += velocity * length;
        }
        displacements
    }

    /// Whether the base acceleration is constant and the fixed contacts at rest.
    pub fn is_constant(&self) -> bool {
        self.jerk == 0.0 && self.velocities.iter().all(|velocity| *velocity == 0.0)
    }
}

/// Whether two values of an input that changes at a rate are the same at an instant (s), but for rounding; of one that is held exactly.
fn is_rounding(a: f64, b: f64, rate: f64, time: f64) -> bool {
    a == b || rate != 0.0 && (a - b).abs() <= ROUNDING * (a.abs() + (rate * time).abs())
}
