//! Legendre polynomials and the Gauss quadrature built on them.

/// Values of the Legendre polynomials P_0 ... P_(count-1) at `x` in [-1, 1].
pub fn polynomials(x: f64, count: usize) -> Vec<f64> {
    let mut values = Vec::with_capacity(count);
    let (mut previous, mut current) = (0.0, 1.0);
    for degree in 0..count {
        values.push(current);
        (previous, current) = (current, next(degree, x, previous, current));
    }
    values
}

/// P_(n+1) from P_(n-1) and P_n (Bonnet's recursion).
fn next(n: usize, x: f64, previous: f64, current: f64) -> f64 {
    let n = n as f64;
    ((2.0 * n + 1.0) * x * current - n * previous) / (n + 1.0)
}

/// P_degree(x) and its derivative at |x| < 1.
fn value_and_slope(degree: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (0.0, 1.0);
    for n in 0..degree {
        (previous, current) = (current, next(n, x, previous, current));
    }
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
