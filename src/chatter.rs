use serde::{Deserialize, Serialize};

use crate::electrical::ElectricalContact;
use crate::scene::Scene;

/// Criterion of interruptions and makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Contact force below which the contact is interrupted, N; above 0.
    pub force: f64,
    /// Shortest interruption that counts, s.
    minimum_duration: f64,
    /// Shortest make that counts, s.
    shortest_make: f64,
}

impl Criterion {
    /// From the scene; `None` without `effects.chatter`, or if there can be no interruption.
    pub fn new(scene: &Scene, electrical: &ElectricalContact) -> Option<Self> {
        let force = electrical.force_at(scene.chatter.resistance_threshold);
        (scene.effects.chatter && force > 0.0).then_some(Self {
            force,
            minimum_duration: scene.chatter.minimum_duration,
            shortest_make: scene.second.minimum_duration,
        })
    }
}

/// Interruptions and makes up to an instant: the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interruptions {
    pub in_progress: bool,
    /// Instant at which it began, or the make between two of them, s; `None`: closed since the start.
    turned: Option<f64>,
    completed: Summary,
    made: Summary,
}

/// Interruptions, or makes, up to an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Number that count.
    pub count: u64,
    /// The longest, s.
    pub longest: f64,
    /// Total duration of those that count, s.
    pub total: f64,
}

impl Summary {
    /// With a further one that has lasted so long (s); it counts if it has lasted the shortest duration (s).
    fn with(self, lasted: f64, shortest: f64) -> Self {
        let counts = lasted >= shortest;
        Self {
            count: self.count + u64::from(counts),
            longest: self.longest.max(lasted),
            total: self.total + if counts { lasted } else { 0.0 },
        }
    }

    fn is_sound(&self) -> bool {
        self.longest.is_finite() && self.total.is_finite()
    }
}

impl Interruptions {
    /// Begins or ends an interruption at an instant (s).
    pub fn turn(&mut self, criterion: &Criterion, time: f64) {
        *self = Self {
            in_progress: !self.in_progress,
            turned: Some(time),
            completed: self.summary(criterion, time),
            made: self.makes(criterion, time),
        };
    }

    /// Whether the values are consistent at an instant (s) (check of a deserialised state).
    pub fn is_sound(&self, time: f64) -> bool {
        let Self { in_progress: _, turned, completed, made } = self;
        turned.is_none_or(|instant| instant <= time && instant.is_finite()) && completed.is_sound() && made.is_sound()
    }

    /// Interruptions at an instant (s), including one in progress.
    pub fn summary(&self, criterion: &Criterion, time: f64) -> Summary {
        let now = self.turned.filter(|_| self.in_progress);
        now.map_or(self.completed, |since| self.completed.with(time - since, criterion.minimum_duration))
    }

    /// Makes at an instant (s), including one in progress.
    pub fn makes(&self, criterion: &Criterion, time: f64) -> Summary {
        let now = self.turned.filter(|_| !self.in_progress);
        now.map_or(self.made, |since| self.made.with(time - since, criterion.shortest_make))
    }
}
