//! Legendre polynomials and the Gauss quadrature built on them.

use std::iter;

/// P_(n-1) and P_n at `x` for n = 0, 1, ... (Bonnet's recursion), with P_(-1) = 0.
fn neighbours(x: f64) -> impl Iterator<Item = (f64, f64)> {
    let mut n = 0.0;
    iter::successors(Some((0.0, 1.0)), move |(previous, current)| {
        let next = ((2.0 * n + 1.0) * x * current - n * previous) / (n + 1.0);
        n += 1.0;
        Some((*current, next))
    })
}

/// Values of the Legendre polynomials P_0 ... P_(count-1) at `x` in [-1, 1].
pub fn polynomials(x: f64, count: usize) -> Vec<f64> {
    neighbours(x).take(count).map(|(_, value)| value).collect()
}

/// P_degree(x) and its derivative at |x| < 1.
fn value_and_slope(degree: usize, x: f64) -> (f64, f64) {
    let (previous, current) = neighbours(x).nth(degree).unwrap_or_default();
    (current, degree as f64 * (previous - x * current) / (1.0 - x * x))
}

/// Nodes and weights of the Gauss-Legendre quadrature with `count` points on [-1, 1], nodes ascending; exact for
/// polynomials up to degree 2 `count` - 1.
pub fn gauss(count: usize) -> impl Iterator<Item = (f64, f64)> {
    (0..count).rev().map(move |k| {
        // Tricomi's estimate of the k-th root from above, then Newton's iteration, which converges quadratically from there.
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
        for _ in 0..6 {
            let (value, slope) = value_and_slope(count, x);
            x -= value / slope;
        }
        let (_, slope) = value_and_slope(count, x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}
