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

/// Points computed side by side, as each step of the recursion waits for the one before.
const LANES: usize = 4;

/// P_degree(x) and its derivative at several |x| < 1.
fn values_and_slopes(degree: usize, x: &[f64; LANES]) -> [(f64, f64); LANES] {
    let (mut previous, mut current) = ([0.0; LANES], [1.0; LANES]);
    for n in 0..degree {
        let mut following = current;
        for (((following, x), previous), current) in following.iter_mut().zip(x).zip(&previous).zip(&current) {
            *following = next(n, *x, *previous, *current);
        }
        (previous, current) = (current, following);
    }
    let mut pairs = [(0.0, 0.0); LANES];
    for (((pair, x), previous), current) in pairs.iter_mut().zip(x).zip(&previous).zip(&current) {
        *pair = (*current, degree as f64 * (previous - x * current) / (1.0 - x * x));
    }
    pairs
}

/// Nodes and weights of the Gauss-Legendre quadrature with `count` points on [-1, 1], nodes ascending; exact for
/// polynomials up to degree 2 `count` - 1.
pub fn gauss(count: usize) -> impl Iterator<Item = (f64, f64)> {
    (0..count.div_ceil(LANES)).flat_map(move |group| {
        // Tricomi's estimate of the k-th root from above, then Newton's iteration, which converges quadratically from there.
        let mut roots: [f64; LANES] = std::array::from_fn(|lane| {
            let k = count.saturating_sub(group * LANES + lane + 1) as f64;
            (std::f64::consts::PI * (k + 0.75) / (count as f64 + 0.5)).cos()
        });
        for _ in 0..6 {
            let before = roots;
            for (x, (value, slope)) in roots.iter_mut().zip(values_and_slopes(count, &before)) {
                *x -= value / slope;
            }
            if roots == before {
                break;
            }
        }
        let slopes = values_and_slopes(count, &roots);
        let pairs = roots.into_iter().zip(slopes);
        let pairs = pairs.map(|(x, (_, slope))| (x, 2.0 / ((1.0 - x * x) * slope * slope)));
        pairs.take(count - group * LANES)
    })
}
