//! Polynomials of a quantity over a step, expanded about its end: for dense output, and to extrapolate to the next
//! step.

use serde::{Deserialize, Serialize};

use crate::math::nodal::LONG;

/// Coefficients of a polynomial through the nodes of a step, about the step's end, in time relative to its length.
pub type Prediction = [f64; LONG + 1];

/// Two extrapolations of the force to the next step, through all nodes and through the last few, and which of the two
/// was better last time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Predictions {
    pub(crate) steep: Prediction,
    pub(crate) flat: Prediction,
    pub(crate) use_flat: bool,
}

impl Predictions {
    /// The polynomial through the start and all nodes of the last step.
    pub fn through_all(&self) -> &Prediction {
        &self.steep
    }

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.steep.iter().chain(&self.flat).all(|number| number.is_finite())
    }
}

/// A polynomial and its derivative (Horner's rule).
pub fn value_and_slope(coefficients: &Prediction, y: f64) -> (f64, f64) {
    let terms = coefficients.iter().rev();
    terms.fold((0.0, 0.0), |(value, slope), coefficient| {
        (value * y + coefficient, slope * y + value)
    })
}
