//! Polynomials of a quantity over a step, by their coefficients about its end: they are read inside the step and predict the
//! next one.

use serde::{Deserialize, Serialize};

use crate::math::nodal::LONG;

/// A polynomial through the nodes of a step, by its coefficients about the end: it predicts the next step.
pub type Prediction = [f64; LONG + 1];

/// Two predictions of the force over the next step, one through all nodes and one through the last few, and which of
/// the two was the better one last time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Predictions {
    pub(crate) steep: Prediction,
    pub(crate) flat: Prediction,
    pub(crate) use_flat: bool,
}

impl Predictions {
    /// The polynomial through the start and all nodes of the step they are from.
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
