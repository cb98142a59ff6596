//! Integrals and derivatives of the load shapes of a step: the Lagrange polynomials of its nodes, and for the error
//! estimate the polynomial of one degree more that vanishes at the nodes and is 1 at the start.

use bytemuck::Zeroable;

use crate::math::nodal::{LONG, Nodal, add, dot, end};
use crate::math::series::TERMS;
use crate::math::simd::Arithmetic;

/// Largest number of load shapes: one for each node, one for the error estimate.
pub const MAX_SHAPES: usize = LONG + 1;

/// What the polynomials of a step are polynomials of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Time.
    Time,
    /// The root of the time since the start: after a closing the dissipative part of the force starts like it.
    Root,
}

impl Variable {
    /// The parts of the step at places in it, 0 to 1.
    pub fn times<const N: usize>(self, places: &[f64; N]) -> [f64; N] {
        places.map(|place| match self {
            Self::Time => place,
            Self::Root => place * place,
        })
    }

    /// The place of a part of the step.
    pub fn place(self, part: f64) -> f64 {
        match self {
            Self::Time => part,
            Self::Root => part.sqrt(),
        }
    }
}

/// A value at every node for every load shape.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Table<const S: usize> {
    /// Of the Lagrange polynomials, one after the other.
    pub nodal: [Nodal<S>; S],
    /// Of the polynomial that vanishes at the nodes.
    pub error: Nodal<S>,
}

/// A value for every load shape at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Row<const S: usize> {
    /// See [`Table::nodal`].
    pub nodal: Nodal<S>,
    /// See [`Table::error`].
    pub error: f64,
}

/// Values, integrals and derivatives of the load shapes, in units of the step length.
#[derive(Clone, Debug)]
pub struct Shapes<const S: usize> {
    /// What they are polynomials of.
    pub variable: Variable,
    /// `x^n / n!` at the nodes, n = 0, 1, ...
    pub powers: [Nodal<S>; TERMS + 1],
    /// Root times step length up to which its n-th power over n! is negligible (`math::series`), n = 1, 2, ...
    pub negligible: [f64; TERMS - 1],
    /// n-fold integrals from the start, n = 1, 2, ...
    pub integrals: [Table<S>; TERMS],
    /// Integrals of the Lagrange polynomials up to the end of the step.
    pub end_integrals: [Nodal<S>; TERMS],
    /// m-th derivatives, m = 0, ..., S.
    pub derivatives: &'static [Table<S>],
    /// Derivatives of the Lagrange polynomials at the end of the step.
    pub end_derivatives: &'static [Nodal<S>],
    /// Derivatives at the start of the step.
    pub start_derivatives: &'static [Row<S>],
}

/// Integrals and derivatives of several loads, in units of the step length.
#[derive(Clone, Copy, Debug)]
pub struct Loads<const N: usize> {
    /// n-fold integrals from the start up to the end of the step, n = 1, 2, ...
    pub integrals: [[f64; N]; TERMS],
    /// m-th derivatives at the start and at the end, m = 0, 1, ...
    pub derivatives: [[[f64; N]; 2]; MAX_SHAPES],
}

impl<const N: usize> Loads<N> {
    /// No loads.
    pub(super) const ZERO: Self = Self { integrals: [[0.0; N]; TERMS], derivatives: [[[0.0; N]; 2]; MAX_SHAPES] };
}

impl<const S: usize> Table<S> {
    /// All zero.
    pub const ZERO: Self = Self { nodal: [[0.0; S]; S], error: [0.0; S] };

    /// Adds `factor` times another table.
    #[inline(always)]
    pub fn add<A: Arithmetic>(&mut self, factor: f64, values: &Self) {
        for (sum, values) in self.nodal.iter_mut().zip(&values.nodal) {
            add::<S, A>(sum, factor, values);
        }
        add::<S, A>(&mut self.error, factor, &values.error);
    }

    /// From what becomes of each power (0, 1, ...) at the nodes, and the derivatives of the shapes at the start.
    #[inline(always)]
    pub(super) fn of_powers<A: Arithmetic>(start: &[Row<S>], powers: &[Nodal<S>; MAX_SHAPES]) -> Self {
        let mut table = Self::ZERO;
        let mut factorial = 1.0;
        for (m, (powers, row)) in powers.iter().zip(start).enumerate() {
            factorial *= m.max(1) as f64;
            let terms = powers.map(|power| power / factorial);
            for (column, derivative) in table.columns_mut().zip(row.nodal.iter().chain([&row.error])) {
                add::<S, A>(column, *derivative, &terms);
            }
        }
        table
    }

    fn columns_mut(&mut self) -> impl Iterator<Item = &mut Nodal<S>> {
        self.nodal.iter_mut().chain([&mut self.error])
    }

    /// The Lagrange polynomials at the last node.
    pub(super) fn end(&self) -> Nodal<S> {
        self.nodal.map(|column| end(&column))
    }
}

impl<const S: usize> Shapes<S> {
    /// Sets one of the loads to the nodal polynomial through these values.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a load that there is")]
    pub fn set<const N: usize, A: Arithmetic>(&self, loads: &mut Loads<N>, n: usize, values: &Nodal<S>) {
        for (integral, row) in loads.integrals.iter_mut().zip(&self.end_integrals) {
            integral[n] = dot::<S, A>(row, values);
        }
        let rows = self.start_derivatives.iter().zip(self.end_derivatives);
        for ([at_start, at_end], (start, end)) in loads.derivatives.iter_mut().zip(rows) {
            (at_start[n], at_end[n]) = (dot::<S, A>(&start.nodal, values), dot::<S, A>(end, values));
        }
    }
}
