//! Response of a root of a mode that is fast against the step to loads that are polynomials of the root of time: the derivatives of
//! such loads, which serve for polynomials of time, are infinite at the start.

use crate::integrator::collocation::shapes::{MAX_SHAPES, Shapes, Table};
use crate::math::nodal::Nodal;
use crate::math::simd::Arithmetic;

/// Rate times time up to which moments are summed from below; beyond it they follow from the series of descending powers, whose least
/// term is below rounding from there on.
const NEAR: f64 = 36.0;

/// The convolution of each load shape up to each node (`times`, parts of the step) with `exp(-rate t)`, by step lengths.
#[inline(always)]
pub(super) fn convolved<const S: usize, A: Arithmetic>(rate: f64, times: &Nodal<S>, shapes: &Shapes<S>) -> Table<S> {
    let mut powers = [[0.0; S]; MAX_SHAPES];
    for (node, time) in times.iter().enumerate() {
        for (power, moment) in powers.iter_mut().zip(moments(rate, *time)) {
            power.iter_mut().skip(node).take(1).for_each(|entry| *entry = moment);
        }
    }
    Table::of_powers::<A>(shapes.start_derivatives, &powers)
}

/// The convolutions of `t^(m/2)`, m = 0, 1, ..., with `exp(-rate t)` up to a time. Integrated by parts they follow from each other,
/// `rate M_m = t^(m/2) - m/2 M_(m-2)`: upwards where the time is long, downwards where it is short.
#[expect(clippy::indexing_slicing, reason = "moments that there are")]
fn moments(rate: f64, time: f64) -> [f64; MAX_SHAPES] {
    let z = rate * time;
    let mut moments = [0.0; MAX_SHAPES];
    let root = time.sqrt();
    let mut powers = [1.0; MAX_SHAPES + 2];
    for m in 1..powers.len() {
        powers[m] = powers[m - 1] * root;
    }
    if z < 2.0 {
        for m in (0..MAX_SHAPES).rev() {
            let above = moments.get(m + 2).copied();
            let half = 0.5 * (m + 2) as f64;
            moments[m] =
                above.map_or_else(|| powers[m + 2] * summed(z, m), |above| (powers[m + 2] - rate * above) / half);
        }
    } else {
        moments[0] = -(-z).exp_m1() / rate;
        moments[1] = if z < NEAR { powers[3] * summed(z, 1) } else { descending(rate, time) };
        for m in 2..MAX_SHAPES {
            moments[m] = (powers[m] - 0.5 * m as f64 * moments[m - 2]) / rate;
        }
    }
    moments
}

/// `exp(-z) (1/a + z/(a + 1) + z^2/(2! (a + 2)) + ...)`, `a = m/2 + 1`: all terms are positive.
fn summed(z: f64, m: usize) -> f64 {
    let a = 0.5 * m as f64 + 1.0;
    let (mut power, mut sum, mut n) = (1.0, 0.0, 0.0);
    loop {
        let term = power / (a + n);
        sum += term;
        if term <= f64::EPSILON * f64::EPSILON.sqrt() * sum {
            return (-z).exp() * sum;
        }
        n += 1.0;
        power *= z / n;
    }
}

/// Of the root of time: `sqrt(t)/rate (1 - 1/(2z) - 1/(2z)^2 - 3/(2z)^3 - 15/(2z)^4 - ...)`.
fn descending(rate: f64, time: f64) -> f64 {
    let z = 2.0 * rate * time;
    let (mut term, mut sum, mut k) = (1.0 / z, 1.0, 1.0);
    while term > 0.1 * f64::EPSILON {
        sum -= term;
        let next = term * (2.0 * k - 1.0) / z;
        if next >= term {
            break;
        }
        (term, k) = (next, k + 1.0);
    }
    time.sqrt() / rate * sum
}
