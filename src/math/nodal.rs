//! Values at the nodes of a step and arithmetic on them, inlined into kernels compiled for the processor
//! ([`crate::math::simd`]).

use crate::math::simd::{Arithmetic, LANES};

pub const SHORT: usize = 4;

pub const LONG: usize = 8;

pub type Nodal<const S: usize> = [f64; S];

/// Nodal values of which one differs from the others.
struct Singled<const S: usize>;

impl<const S: usize> Singled<S> {
    const ONES: [Nodal<S>; S] = Self::table(1.0, 0.0);
    const ZEROES: [Nodal<S>; S] = Self::table(0.0, 1.0);

    #[expect(clippy::indexing_slicing, reason = "arrays of fixed size")]
    const fn table(one: f64, others: f64) -> [Nodal<S>; S] {
        let mut table = [[others; S]; S];
        let mut node = 0;
        while node < S {
            table[node][node] = one;
            node += 1;
        }
        table
    }
}

/// One at a node of the `S`, zero at all others.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "a node of the step")]
pub fn unit<const S: usize>(node: usize) -> &'static Nodal<S> {
    let units: &'static [Nodal<S>; S] = &Singled::<S>::ONES;
    &units[node]
}

/// Zero at a node of the `S`, one at all others.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "a node of the step")]
pub fn others<const S: usize>(node: usize) -> &'static Nodal<S> {
    let zeroes: &'static [Nodal<S>; S] = &Singled::<S>::ZEROES;
    &zeroes[node]
}

/// The values times `factor`.
#[inline(always)]
pub fn scaled<const S: usize>(values: &Nodal<S>, factor: f64) -> Nodal<S> {
    let mut values = *values;
    for value in &mut values {
        *value *= factor;
    }
    values
}

/// The value at the last node, which is the end of the step.
#[inline(always)]
pub fn end<const S: usize>(values: &Nodal<S>) -> f64 {
    values.last().copied().unwrap_or_default()
}

/// The larger of a number and the `most` so far, which is one: one instruction, where [`f64::max`] looks for both.
#[inline(always)]
fn larger(most: f64, value: f64) -> f64 {
    if value > most { value } else { most }
}

/// The greatest magnitude.
#[inline(always)]
pub fn greatest<const S: usize>(values: &Nodal<S>) -> f64 {
    let mut greatest = [0.0; LANES];
    for values in values.chunks(LANES) {
        for (greatest, value) in greatest.iter_mut().zip(values) {
            *greatest = larger(*greatest, value.abs());
        }
    }
    greatest.into_iter().fold(0.0, larger)
}

/// The highest of the values, and the lowest.
#[inline(always)]
pub fn range<const S: usize>(values: &Nodal<S>) -> (f64, f64) {
    let mut both = [[f64::NEG_INFINITY; LANES]; 2];
    for values in values.chunks(LANES) {
        let [highest, deepest] = &mut both;
        for ((highest, deepest), value) in highest.iter_mut().zip(deepest).zip(values) {
            (*highest, *deepest) = (larger(*highest, *value), larger(*deepest, -value));
        }
    }
    let [highest, deepest] = both.map(|values| values.into_iter().fold(f64::NEG_INFINITY, larger));
    (highest, -deepest)
}

/// Adds `factor` times the values.
#[inline(always)]
pub fn add<const S: usize, A: Arithmetic>(sum: &mut Nodal<S>, factor: f64, values: &Nodal<S>) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum = A::mul_add(factor, *value, *sum);
    }
}

/// Scalar product of two sets of nodal values.
#[inline(always)]
pub fn dot<const S: usize, A: Arithmetic>(a: &Nodal<S>, b: &Nodal<S>) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| A::mul_add(*a, *b, sum))
}

/// Adds the products of the values.
#[inline(always)]
pub fn add_products<const N: usize, A: Arithmetic>(sum: &mut [f64; N], a: &[f64; N], b: &[f64; N]) {
    for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
        *sum = A::mul_add(*a, *b, *sum);
    }
}

/// Adds the columns, each times its load: a matrix-vector product.
#[inline(always)]
pub fn add_columns<const S: usize, A: Arithmetic>(values: &mut Nodal<S>, columns: &[Nodal<S>; S], loads: &Nodal<S>) {
    for (column, load) in columns.iter().zip(loads) {
        add::<S, A>(values, *load, column);
    }
}
