//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::integrator::constants::PIECES;
use crate::math::prediction::value_and_slope;
use serde::{Deserialize, Serialize};

use crate::math::prediction::Prediction;
use crate::math::roots;
use crate::model::Model;

/// Least and greatest contact force over an interval of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Least force, N.
    pub least: f64,
    /// Greatest force, N.
    pub greatest: f64,
}

impl Extremes {
    /// Of a single force, N.
    pub fn at(force: f64) -> Self {
        Self {
            least: force,
            greatest: force,
        }
    }

    /// Includes a force (N).
    pub fn add(&mut self, force: f64) {
        self.least = self.least.min(force);
        self.greatest = self.greatest.max(force);
    }

    /// Includes the force within a step from `from` to `to` (relative to its end, in step lengths): that of the
    /// polynomial, or zero while the contact is open.
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
