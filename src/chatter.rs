//! Interruptions (contact chatter): intervals in which the contact resistance is above a threshold.
//!
//! The resistance decreases with the contact force, so an interruption is an interval with a force below that of the
//! threshold. One present at the start begins there. It counts once it has lasted the minimum duration, even if it is
//! still in progress (MIL-PRF-28776, MIL-STD-202 method 310: 10 us).

use serde::{Deserialize, Serialize};

use crate::electrical::ElectricalContact;
use crate::scene::Scene;

/// Criterion of an interruption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Contact force below which the contact is interrupted, N; above 0.
    pub force: f64,
    /// Shortest interruption that counts, s.
    minimum_duration: f64,
}

impl Criterion {
    /// From the scene; `None` without `effects.chatter`, or if there can be no interruption.
    pub fn new(scene: &Scene, electrical: &ElectricalContact) -> Option<Self> {
        let force = electrical.force_at(scene.chatter.resistance_threshold);
        (scene.effects.chatter && force > 0.0).then_some(Self {
            force,
            minimum_duration: scene.chatter.minimum_duration,
        })
    }
}

/// Interruptions up to an instant: the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interruptions {
    /// Start of the interruption in progress, s.
    since: Option<f64>,
    /// Number of completed interruptions that count.
    count: u64,
    /// Longest completed one, s.
    longest: f64,
    /// Total duration of the completed ones that count, s.
    total: f64,
}

/// Interruptions up to an instant, including one in progress: the outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Number that count.
    pub count: u64,
    /// The longest, s.
    pub longest: f64,
    /// Total duration of those that count, s.
    pub total: f64,
}

impl Interruptions {
    /// Whether the contact is interrupted.
    pub fn in_progress(&self) -> bool {
        self.since.is_some()
    }

    /// Begins or ends an interruption at an instant (s).
    pub fn turn(&mut self, criterion: &Criterion, time: f64) {
        let Summary { count, longest, total } = self.summary(criterion, time);
        *self = Self {
            since: if self.in_progress() { None } else { Some(time) },
            count,
            longest,
            total,
        };
    }

    /// Whether the values are consistent at an instant (s) (check of a deserialised state).
    pub fn is_sound(&self, time: f64) -> bool {
        let Self {
            since,
            count: _,
            longest,
            total,
        } = self;
        let past = since.is_none_or(|instant| instant <= time && instant.is_finite());
        past && longest.is_finite() && total.is_finite()
    }

    /// Summary at an instant (s).
    pub fn summary(&self, criterion: &Criterion, time: f64) -> Summary {
        let lasted = self.since.map_or(0.0, |since| time - since);
        let counts = self.in_progress() && lasted >= criterion.minimum_duration;
        Summary {
            count: self.count + u64::from(counts),
            longest: self.longest.max(lasted),
            total: self.total + if counts { lasted } else { 0.0 },
        }
    }
}
