//! What is watched inside steps: extremes of the contact force, and where it passes the force of an interruption.

use crate::math::prediction::value_and_slope;
use serde::{Deserialize, Serialize};

use crate::math::prediction::Prediction;
use crate::math::roots;
use crate::model::Model;

/// Least and greatest contact force over some time, N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// N.
    pub least: f64,
    /// N.
    pub greatest: f64,
}

/// Pieces of a step in which a polynomial is looked at for an extreme.
const PIECES: u32 = 8;

impl Extremes {
    /// Of one force, N.
    pub fn at(force: f64) -> Self {
        Self {
            least: force,
            greatest: force,
        }
    }

    /// A force (N) more.
    pub fn add(&mut self, force: f64) {
        self.least = self.least.min(force);
        self.greatest = self.greatest.max(force);
    }

    /// The forces within a step, from `from` to `to` (in steps before its end): those of the polynomial, or none where the
    /// contact is open.
    pub(crate) fn add_course(&mut self, model: &Model, closed: bool, polynomial: &Prediction, from: f64, to: f64) {
        if !closed {
            self.add(0.0);
            return;
        }
        let value = |y: f64| {
            let force = model.preload.force + value_and_slope(polynomial, y).0;
            model.law.without_pull(force)
        };
        let slope = |y: f64| value_and_slope(polynomial, y).1;
        let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(PIECES);
        self.add(value(from));
        let mut before = (from, slope(from));
        for k in 1..=PIECES {
            let now = (at(k), slope(at(k)));
            // Looked for only where the slope changes sign.
            if (before.1 > 0.0) != (now.1 > 0.0)
                && let Some(y) = roots::between(slope, before, now, 1e-9)
            {
                self.add(value(y));
            }
            before = now;
        }
        self.add(value(to));
    }
}
