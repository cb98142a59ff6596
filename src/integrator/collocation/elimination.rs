//! Gauss-Jordan elimination of the few equations of a step.

use crate::integrator::constants::SMALL_PIVOT;
use crate::math::nodal::Nodal;
use crate::math::simd::Arithmetic;

/// Solves `A x = b` for several `b`, `A` by columns. `None` if the matrix is singular.
#[inline(always)]
pub(super) fn solve<const N: usize, const R: usize, A: Arithmetic>(
    mut a: [Nodal<N>; N],
    mut right: [Nodal<N>; R],
) -> Option<[Nodal<N>; R]> {
    factorise::<N, R, A>(&mut a, &mut right)?;
    right.iter().flatten().all(|x| x.is_finite()).then_some(right)
}

/// Solves equations for several right-hand sides by Gauss-Jordan elimination by columns, whose inner loops run down columns.
/// What [`substitute`] needs for others remains in place, with the inverse of each pivot; returned are the rows exchanged, only
/// for a small pivot, which occurs in violent steps only.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
#[inline(always)]
pub(super) fn factorise<const N: usize, const R: usize, A: Arithmetic>(
    a: &mut [Nodal<N>; N],
    right: &mut [Nodal<N>; R],
) -> Option<[usize; N]> {
    let mut exchanges: [usize; N] = std::array::from_fn(|p| p);
    for p in 0..N {
        if a[p][p].abs() < SMALL_PIVOT {
            let largest = (p..N).max_by(|i, j| a[p][*i].abs().total_cmp(&a[p][*j].abs()))?;
            exchanges[p] = largest;
            for column in a[p..].iter_mut().chain(&mut *right) {
                column.swap(p, largest);
            }
        }
        let pivot = a[p];
        let inverse = 1.0 / pivot[p];
        // Two loops, as a chained iterator may not be inlined and would then be compiled for the generic processor.
        for column in &mut a[p + 1..] {
            eliminate::<N, A>(column, p, &pivot, inverse);
        }
        for column in &mut *right {
            eliminate::<N, A>(column, p, &pivot, inverse);
        }
        a[p][p] = inverse;
    }
    Some(exchanges)
}

/// Solves the equations that have been factorised.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
#[inline(always)]
pub(super) fn substitute<const N: usize, A: Arithmetic>(
    a: &[Nodal<N>; N],
    exchanges: &[usize; N],
    right: &mut Nodal<N>,
) {
    for p in 0..N {
        right.swap(p, exchanges[p]);
        eliminate::<N, A>(right, p, &a[p], a[p][p]);
    }
}

/// Eliminates row `p` of a column from all other rows, and divides it by the pivot.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
#[inline(always)]
fn eliminate<const N: usize, A: Arithmetic>(column: &mut Nodal<N>, p: usize, pivot: &Nodal<N>, inverse: f64) {
    let share = column[p] * inverse;
    for k in 0..N {
        column[k] = A::mul_add(-pivot[k], share, column[k]);
    }
    column[p] = share;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::Separate;

    #[test]
    fn a_small_pivot_costs_no_digits() {
        // By columns: 1e-10 x + y = 1, x + y = 2; y is 1 to ten digits, and x the rest.
        let matrix = [[1e-10, 1.0], [1.0, 1.0]];
        let [[x, y]] = solve::<2, 1, Separate>(matrix, [[1.0, 2.0]]).unwrap();
        let exact = 1.0 / (1.0 - 1e-10);
        // Without exchange the elimination multiplies rounding by 1e10.
        assert!((x - exact).abs() < 4.0 * f64::EPSILON, "{x} {exact}");
        assert!((y - (2.0 - exact)).abs() < 4.0 * f64::EPSILON, "{y}");
    }
}
