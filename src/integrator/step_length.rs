//! The length of the next step by the error of this one.

use crate::integrator::constants::{AFTER_REJECTION, LEAST_SHRINK, MOST_GROWTH, MOST_SHRINK, SAFETY};

/// Factor on the length after a step of the relative error `ratio`.
pub(crate) fn growth<const S: usize>(ratio: f64) -> f64 {
    if ratio < 1e-7 {
        MOST_GROWTH
    } else {
        (SAFETY * step_factor::<S>(ratio)).clamp(MOST_SHRINK, MOST_GROWTH)
    }
}

/// Factor on the length after a rejection for the relative error `ratio`; the smallest without an error estimate.
pub(crate) fn shrinkage<const S: usize>(ratio: f64) -> f64 {
    if ratio.is_finite() {
        (AFTER_REJECTION * step_factor::<S>(ratio)).clamp(LEAST_SHRINK, MOST_SHRINK)
    } else {
        LEAST_SHRINK
    }
}

/// Factor to the step size at which the relative error `ratio` becomes 1: the error estimate is of order `S + 1`.
fn step_factor<const S: usize>(ratio: f64) -> f64 {
    ratio.powf(-1.0 / (S as f64 + 1.0))
}
