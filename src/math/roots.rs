//! Roots of scalar functions in a bracket.

/// Root of `f` between `a` and `b`, to the spacing of floating-point numbers. `None` unless `f(a)` and `f(b)` differ in
/// sign, and if `f` returns NaN.
pub fn bracketed(mut f: impl FnMut(f64) -> f64, a: f64, b: f64) -> Option<f64> {
    let ends = ((a, f(a)), (b, f(b)));
    between(f, ends.0, ends.1, 0.0)
}

/// The same with known values at the two points, to within `resolution`. Inverse quadratic interpolation where it is
/// safe, else bisection.
///
/// T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145.
pub fn between(mut f: impl FnMut(f64) -> f64, a: (f64, f64), b: (f64, f64), resolution: f64) -> Option<f64> {
    let ((mut x2, mut f2), (mut x1, mut f1)) = (a, b);
    if f1 == 0.0 {
        return Some(x1);
    }
    if f2 == 0.0 {
        return Some(x2);
    }
    if f1.is_nan() || f2.is_nan() || (f1 > 0.0) == (f2 > 0.0) {
        return None;
    }
    // First a secant step: near events the function is nearly linear.
    let mut fraction = f1 / (f1 - f2);
    // Bisection alone would need 1100 iterations at worst, from the largest number to the smallest.
    for _ in 0..1100 {
        let x = x1 + fraction * (x2 - x1);
        let value = f(x);
        if value.is_nan() {
            return None;
        }
        let (x3, f3);
        if (value > 0.0) == (f1 > 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, value);
        let best = if f1.abs() < f2.abs() { x1 } else { x2 };
        let spacing = (f64::EPSILON * best.abs()).max(resolution) / (x2 - x1).abs();
        if value == 0.0 || spacing > 0.5 || x1 == x2 {
            return Some(best);
        }
        let ratio = (x1 - x2) / (x3 - x2);
        let phi = (f1 - f2) / (f3 - f2);
        fraction = if phi * phi < ratio && (1.0 - phi) * (1.0 - phi) < 1.0 - ratio {
            f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        fraction = fraction.clamp(spacing, 1.0 - spacing);
    }
    Some(x1)
}

/// Root of a smooth function, of which `f` gives value and slope, between two points with known values of opposite signs, to within
/// `resolution`: by Newton's method, by halves where that leaves the bracket.
pub fn newton(f: impl Fn(f64) -> (f64, f64), a: (f64, f64), b: (f64, f64), resolution: f64) -> f64 {
    let ((mut low, at_low), (mut high, at_high)) = (a, b);
    let mut x = low + (high - low) * at_low / (at_low - at_high);
    // By halves alone 64 reach the resolution of numbers.
    for _ in 0..64 {
        let (value, slope) = f(x);
        let end = if (value > 0.0) == (at_low > 0.0) { &mut low } else { &mut high };
        *end = x;
        let (next, middle) = (x - value / slope, 0.5 * (low + high));
        let next = if low <= next && next <= high { next } else { middle };
        let change = next - x;
        x = next;
        // Its square, times the curvature over the slope, is what is still missing.
        if change * change <= 1e-3 * resolution {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::{bracketed, newton};

    #[test]
    fn newton_finds_simple_roots_and_stays_in_the_bracket() {
        let (low, high) = (0.5, 3.0);
        let f = |x: f64| ((x - 2.0).tanh(), 1.0 - (x - 2.0).tanh().powi(2));
        let root = newton(f, (low, f(low).0), (high, f(high).0), 1e-12);
        assert!((root - 2.0).abs() < 1e-12, "{root}");
        // Newton's method leaves for infinity from the ends of this bracket.
        let root = newton(f, (-30.0, f(-30.0).0), (30.0, f(30.0).0), 1e-9);
        assert!((root - 2.0).abs() < 1e-9, "{root}");
    }

    #[test]
    fn roots_are_found_to_rounding_and_only_between_signs() {
        let root = bracketed(|x| x * x - 2.0, 0.0, 2.0).unwrap();
        assert!((root - 2.0_f64.sqrt()).abs() <= 4.0 * f64::EPSILON, "{root}");
        let flat = bracketed(|x| (x - 1e-9).powi(3), -1.0, 3.0).unwrap();
        assert!((flat - 1e-9).abs() < 1e-22, "{flat}");
        assert_eq!(bracketed(|x| x * x + 1.0, -1.0, 1.0), None);
        assert_eq!(bracketed(|_| f64::NAN, -1.0, 1.0), None);
    }
}
