//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::integrator::constants::PIECES;
use crate::math::prediction::value_and_slope;
use serde::{Deserialize, Serialize};

use crate::math::prediction::Prediction;
use crate::math::roots;
use crate::model::Model;

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
        self.least = self.least.min(force);
        self.greatest = self.greatest.max(force);
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

    /// Includes the force within a step from `from` to `to` (relative to its end, in step lengths): that of the
    /// polynomial, or zero while the contact is open.
    pub(crate) fn add_course(&mut self, model: &Model, closed: bool, polynomial: &Prediction, from: f64, to: f64) {
        let range = self.of(model.mirrored);
        if !closed {
            range.add(0.0);
            return;
        }
        each_extreme(polynomial, from, to, |force| {
            range.add(model.law.without_pull(model.preload.force + force));
        });
    }

    /// Includes an indentation of the second contact, m.
    pub(crate) fn approach(&mut self, indentation: f64) {
        self.nearest = self.nearest.max(indentation);
    }
}

/// The values of a polynomial at the ends of a part of a step, and where it turns between them.
pub(crate) fn each_extreme(polynomial: &Prediction, from: f64, to: f64, mut found: impl FnMut(f64)) {
    let value = |y: f64| value_and_slope(polynomial, y).0;
    let slope = |y: f64| value_and_slope(polynomial, y).1;
    let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(PIECES);
    found(value(from));
    let mut before = (from, slope(from));
    for k in 1..=PIECES {
        let now = (at(k), slope(at(k)));
        if (before.1 > 0.0) != (now.1 > 0.0)
            && let Some(y) = roots::between(slope, before, now, 1e-9)
        {
            found(value(y));
        }
        before = now;
    }
    found(value(to));
}
