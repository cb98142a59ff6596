//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::integrator::course::Places;
use crate::math::prediction::{Prediction, value_and_slope};
use crate::model::Model;
use serde::{Deserialize, Serialize};

/// Least and greatest force of a contact, N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// The least, N.
    pub least: f64,
    /// The greatest, N.
    pub greatest: f64,
}

impl Range {
    fn at(force: f64) -> Self {
        Self {
            least: force,
            greatest: force,
        }
    }

    /// Includes a force (N).
    pub fn add(&mut self, force: f64) {
        // `min` and `max` would hide NaN.
        if force < self.least || force.is_nan() {
            self.least = force;
        }
        if force > self.greatest || force.is_nan() {
            self.greatest = force;
        }
    }
}

/// Extremes over an interval of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Of the force of the first contact.
    pub first: Range,
    /// Of the force of the second contact.
    pub second: Range,
    /// Greatest indentation of the second contact, m.
    pub nearest: f64,
}

impl Extremes {
    /// Of the forces (N) of both contacts and the indentation of the second (m).
    pub fn at([first, second]: [f64; 2], nearest: f64) -> Self {
        Self {
            first: Range::at(first),
            second: Range::at(second),
            nearest,
        }
    }

    /// Those of the force of the second contact, or of the first.
    pub fn of(&mut self, second: bool) -> &mut Range {
        if second { &mut self.second } else { &mut self.first }
    }

    /// All of them.
    pub(crate) fn numbers(&self) -> [f64; 5] {
        let Self { first, second, nearest } = self;
        [first.least, first.greatest, second.least, second.greatest, *nearest]
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
        let range = self.of(model.mirrored);
        for y in turns.between(from, to).chain([to]) {
            let force = model.preload.force + value_and_slope(polynomial, y).0;
            range.add(model.law.without_pull(force));
        }
    }

    /// Includes an indentation of the second contact, m.
    pub(crate) fn approach(&mut self, indentation: f64) {
        self.nearest = self.nearest.max(indentation);
    }
}
