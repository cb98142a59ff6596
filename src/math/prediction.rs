//! Polynomials of a quantity over a step, expanded about its middle: for dense output, and to extrapolate to the next
//! step. About an end, rounding would be a thousand times as large.

use crate::math::nodal::LONG;
use crate::math::simd::{Arithmetic, Separate};

/// Coefficients of a polynomial through the nodes of a step: of powers of [`centred`] time.
pub type Prediction = [f64; LONG + 1];

/// Time relative to the middle of a step, -1 to 1 within it, from time relative to its end in step lengths.
#[inline(always)]
pub fn centred(y: f64) -> f64 {
    2.0 * y + 1.0
}

/// Value, slope and half the curvature of a polynomial at the end of the step, by time in step lengths.
pub fn parabola_at_end(coefficients: &Prediction) -> [f64; 3] {
    let terms = coefficients.iter().rev();
    let [value, slope, half_curvature] = terms.fold([0.0; 3], |[value, slope, half_curvature], coefficient| {
        [value + coefficient, slope + value, half_curvature + slope]
    });
    [value, 2.0 * slope, 4.0 * half_curvature]
}

/// A polynomial by the root of the time since the start of the step as the parabola in time that continues it.
pub fn parabola_in_time(by_root: &Prediction) -> Prediction {
    let [value, by_root, half_curvature] = parabola_at_end(by_root);
    let (slope, half_curvature) = (0.5 * by_root, 0.25 * half_curvature - 0.125 * by_root);
    let mut parabola = [0.0; LONG + 1];
    let middle = [value - 0.5 * slope + 0.25 * half_curvature, 0.5 * (slope - half_curvature), 0.25 * half_curvature];
    parabola.iter_mut().zip(middle).for_each(|(to, from)| *to = from);
    parabola
}

/// A polynomial at `y`, relative to the end of the step in step lengths, and its derivative by `y` (Horner's rule).
pub fn value_and_slope(coefficients: &Prediction, y: f64) -> (f64, f64) {
    let ([value], [slope]) = values_and_slopes::<1, Separate>(coefficients, &[y]);
    (value, slope)
}

/// Its value alone.
pub fn value_at(coefficients: &Prediction, y: f64) -> f64 {
    let z = centred(y);
    let terms = coefficients.iter().rev();
    terms.fold(0.0, |value, coefficient| Separate::mul_add(value, z, *coefficient))
}

/// Value and derivative at several places, side by side.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "there is a value for each place")]
pub fn values_and_slopes<const N: usize, A: Arithmetic>(
    coefficients: &Prediction,
    places: &[f64; N],
) -> ([f64; N], [f64; N]) {
    let z = places.map(centred);
    let (mut values, mut slopes) = ([0.0; N], [0.0; N]);
    for coefficient in coefficients.iter().rev() {
        for i in 0..N {
            slopes[i] = A::mul_add(slopes[i], z[i], values[i]);
            values[i] = A::mul_add(values[i], z[i], *coefficient);
        }
    }
    (values, slopes.map(|slope| 2.0 * slope))
}

/// The derivative by `y` of a polynomial.
pub fn derivative(coefficients: &Prediction) -> Prediction {
    let mut rate = [0.0; LONG + 1];
    for ((rate, coefficient), power) in rate.iter_mut().zip(coefficients.iter().skip(1)).zip(1_u8..) {
        *rate = 2.0 * f64::from(power) * coefficient;
    }
    rate
}
