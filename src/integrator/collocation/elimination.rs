//! Gauss-Jordan elimination of the few equations of a step: a block of unknowns for each link, a value at each node.

#![expect(clippy::indexing_slicing, reason = "every index runs over the fixed size of the arrays")]

use bytemuck::Zeroable;

use crate::integrator::constants::SMALL_PIVOT;
use crate::math::nodal::{Nodal, add, others, scaled, unit};
use crate::math::simd::{Arithmetic, Separate};

/// A value at the nodes for each unknown link.
pub(super) type Stacked<const S: usize, const L: usize> = [Nodal<S>; L];

/// A square matrix by columns, of which the first `count` blocks are in use; once factorised, the multipliers of the
/// elimination.
#[derive(Clone, Debug, Zeroable)]
pub(super) struct Equations<const S: usize, const L: usize> {
    pub(super) columns: [[Stacked<S, L>; S]; L],
    /// Rows exchanged with each other, block by block.
    exchanges: [[usize; S]; L],
    pub(super) count: usize,
}

/// How many of `L` blocks are in use; of one or two it is known beforehand.
#[inline(always)]
pub(super) fn in_use<const L: usize>(count: usize) -> usize {
    if L <= 2 { L } else { count.min(L) }
}

impl<const S: usize, const L: usize> Equations<S, L> {
    /// Of `count` blocks, all zero.
    #[inline(always)]
    pub(super) fn new(count: usize) -> Self {
        Self { columns: [[[[0.0; S]; L]; S]; L], exchanges: [[0; S]; L], count }
    }

    /// Factorises by columns, so that inner loops run down columns; the solution for `right` takes its place. Rows are
    /// exchanged within a block only, and only for a small pivot, which occurs in violent steps. `None` if that is zero.
    #[inline(always)]
    pub(super) fn factorise<A: Arithmetic>(&mut self, right: &mut Stacked<S, L>) -> Option<()> {
        let Self { columns, exchanges, count } = self;
        for b in 0..in_use::<L>(*count) {
            for p in 0..S {
                exchanges[b][p] =
                    if columns[b][p][b][p].abs() < SMALL_PIVOT { exchange(columns, right, (b, p))? } else { p };
                let multiplier = &mut columns[b][p];
                let pivot = multiplier[b][p];
                set_zero(&mut multiplier[b], p);
                add::<S, Separate>(&mut multiplier[b], -1.0, unit(p));
                for block in multiplier.iter_mut().take(in_use::<L>(*count)) {
                    *block = scaled(block, -1.0 / pivot);
                }
                let multiplier = columns[b][p];
                // Loops, as a chained iterator may not be inlined and would then be compiled for the generic processor.
                for column in &mut columns[b][p + 1..] {
                    eliminate::<S, L, A>(column, (b, p), &multiplier, *count);
                }
                for block in &mut columns[b + 1..] {
                    for column in block {
                        eliminate::<S, L, A>(column, (b, p), &multiplier, *count);
                    }
                }
                eliminate::<S, L, A>(right, (b, p), &multiplier, *count);
            }
        }
        Some(())
    }

    /// Solves the equations that have been factorised.
    #[inline(always)]
    pub(super) fn solve<A: Arithmetic>(&self, right: &mut Stacked<S, L>) {
        for b in 0..in_use::<L>(self.count) {
            for p in 0..S {
                let other = self.exchanges[b][p];
                if other != p {
                    right[b].swap(p, other);
                }
                eliminate::<S, L, A>(right, (b, p), &self.columns[b][p], self.count);
            }
        }
    }
}

/// Exchanges row `p` of block `b` with that of the largest pivot in the block, and returns which it is.
#[cold]
#[inline(never)]
fn exchange<const S: usize, const L: usize>(
    columns: &mut [[Stacked<S, L>; S]; L],
    right: &mut Stacked<S, L>,
    (b, p): (usize, usize),
) -> Option<usize> {
    let pivot = |i: &usize| columns[b][p][b][*i].abs();
    let largest = (p..S).max_by(|i, j| pivot(i).total_cmp(&pivot(j)))?;
    for column in &mut columns[b][p..] {
        column[b].swap(p, largest);
    }
    for column in columns[b + 1..].as_flattened_mut() {
        column[b].swap(p, largest);
    }
    right[b].swap(p, largest);
    Some(largest)
}

/// Makes zero of the value at a node, exactly, without storing a single number into what is read as a vector next.
#[inline(always)]
fn set_zero<const S: usize>(values: &mut Nodal<S>, node: usize) {
    for (value, kept) in values.iter_mut().zip(others::<S>(node)) {
        *value *= kept;
    }
}

/// Eliminates row `p` of block `b` of a column from all other rows, and divides it by the pivot, whose inverse the multiplier has
/// there.
#[inline(always)]
fn eliminate<const S: usize, const L: usize, A: Arithmetic>(
    column: &mut Stacked<S, L>,
    (b, p): (usize, usize),
    multiplier: &Stacked<S, L>,
    count: usize,
) {
    let share = column[b][p];
    set_zero(&mut column[b], p);
    for c in 0..in_use::<L>(count) {
        for k in 0..S {
            column[c][k] = A::mul_add(multiplier[c][k], share, column[c][k]);
        }
    }
}

/// Solves `A x = b` for several `b`, `A` by columns. `None` if the matrix is singular.
#[inline(always)]
pub(super) fn solve<const S: usize, const R: usize, A: Arithmetic>(
    columns: [Nodal<S>; S],
    mut right: [Nodal<S>; R],
) -> Option<[Nodal<S>; R]> {
    let mut equations = Equations::<S, 1>::new(1);
    equations.columns = [columns.map(|column| [column])];
    equations.factorise::<A>(&mut [[0.0; S]])?;
    for values in &mut right {
        let mut stacked = [*values];
        equations.solve::<A>(&mut stacked);
        [*values] = stacked;
    }
    right.iter().flatten().all(|x| x.is_finite()).then_some(right)
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

    #[test]
    fn a_stiff_pivot_costs_no_digits() {
        // By columns: 1e12 x + y = 1, x + y = 3, as a hard contact has it; the exact x is small, and has all its digits.
        let matrix = [[1e12, 1.0], [1.0, 1.0]];
        let [[x, y]] = solve::<2, 1, Separate>(matrix, [[1.0, 3.0]]).unwrap();
        let exact = -2.0 / (1e12 - 1.0);
        // Four roundings.
        assert!((x / exact - 1.0).abs() < 4.0 * f64::EPSILON, "{x} {exact}");
        assert!((y / (3.0 - exact) - 1.0).abs() < 4.0 * f64::EPSILON, "{y}");
    }

    #[test]
    fn blocks_are_one_system() {
        // Three blocks of two, with couplings of both signs: the solution times the matrix is the right-hand side.
        let mut equations = Equations::<2, 3>::new(3);
        let mut seed = 1.0_f64;
        let mut next = || {
            seed = (seed * 1.7 + 0.31) % 1.0;
            seed - 0.5
        };
        for (b, block) in equations.columns.iter_mut().enumerate() {
            for (p, column) in block.iter_mut().enumerate() {
                column.iter_mut().flatten().for_each(|entry| *entry = next());
                column[b][p] += 2.0;
            }
        }
        let matrix = equations.columns;
        let right = [[1.0, -2.0], [0.5, 3.0], [-1.0, 0.25]];
        let (mut first, mut again) = (right, right);
        equations.factorise::<Separate>(&mut first).unwrap();
        equations.solve::<Separate>(&mut again);
        for (b, block) in right.iter().enumerate() {
            for (p, value) in block.iter().enumerate() {
                let product = |x: &[[f64; 2]; 3]| -> f64 {
                    let columns = matrix.as_flattened().iter().zip(x.as_flattened());
                    columns.map(|(column, x)| column[b][p] * x).sum()
                };
                for x in [&first, &again] {
                    // Each of six products rounds, and the pivots are near 2.
                    assert!((product(x) - value).abs() < 1e-14, "{b} {p}");
                }
            }
        }
    }
}
