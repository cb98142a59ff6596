//! Interruptions: stretches in which the contact resistance is above a threshold.
//!
//! The resistance falls with the contact force, so an interruption is a stretch with a force below that of the threshold.
//! One that stands at the start begins there. It counts once it has lasted the minimum duration, also while it goes on
//! (MIL-PRF-28776, MIL-STD-202 method 310: 10 us).

use serde::{Deserialize, Serialize};

use crate::electrical::ElectricalContact;
use crate::scene::Scene;

/// What counts as an interruption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Contact force below which the contact is interrupted, N; above 0.
    pub force: f64,
    /// Shortest interruption that counts, s.
    minimum_duration: f64,
}

impl Criterion {
    /// Of the scene, if it asks for interruptions and there can be any.
    pub fn new(scene: &Scene, electrical: &ElectricalContact) -> Option<Self> {
        let force = electrical.force_at(scene.chatter.resistance_threshold);
        (scene.effects.chatter && force > 0.0).then_some(Self {
            force,
            minimum_duration: scene.chatter.minimum_duration,
        })
    }
}

/// The interruptions up to an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interruptions {
    /// Since when the contact has been interrupted, s, if it is.
    since: Option<f64>,
    /// Those that have ended and count.
    count: u64,
    /// The longest that has ended, s.
    longest: f64,
    /// Duration of those that have ended and count, s.
    total: f64,
    /// When one last began or ended, s.
    turned: Option<f64>,
}

/// The interruptions up to an instant, one in progress included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// How many count.
    pub count: u64,
    /// The longest, s.
    pub longest: f64,
    /// Duration of those that count, s.
    pub total: f64,
}

impl Interruptions {
    /// Whether the contact is interrupted.
    pub fn in_progress(&self) -> bool {
        self.since.is_some()
    }

    /// The contact becomes interrupted or is so no more, at an instant (s).
    pub fn turn(&mut self, criterion: &Criterion, time: f64) {
        let Summary { count, longest, total } = self.summary(criterion, time);
        *self = Self {
            since: if self.in_progress() { None } else { Some(time) },
            count,
            longest,
            total,
            turned: Some(time),
        };
    }

    /// Whether one began or ended at an instant (s).
    pub fn turned_at(&self, time: f64) -> bool {
        self.turned == Some(time)
    }

    /// Whether every number is one that a simulation can have come to by an instant (s).
    pub fn is_sound(&self, time: f64) -> bool {
        let Self {
            since,
            count: _,
            longest,
            total,
            turned,
        } = self;
        let past = |instant: &Option<f64>| instant.is_none_or(|instant| instant <= time && instant.is_finite());
        past(since) && past(turned) && longest.is_finite() && total.is_finite()
    }

    /// All up to an instant (s).
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
