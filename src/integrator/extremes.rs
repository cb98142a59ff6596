//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::integrator::course::Places;
use crate::math::prediction::{Prediction, value_and_slope};
use crate::model::Model;
use serde::{Deserialize, Serialize};

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

    /// Includes the force of a step of the closed contact from `from`, where it is included already, to `to` (relative to
    /// its end, in step lengths): of its polynomial, which turns at these places.
    pub(crate) fn add_course(
        &mut self,
        model: &Model,
        (polynomial, turns): (&Prediction, &Places),
        from: f64,
        to: f64,
    ) {
        for y in turns.between(from, to).chain([to]) {
            let force = model.preload.force + value_and_slope(polynomial, y).0;
            self.add(model.law.without_pull(force));
        }
    }
}
