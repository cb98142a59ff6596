//! Integrals and derivatives of the load shapes of a step: the Lagrange polynomials of its nodes, and for the error
//! estimate the polynomial of one degree more that vanishes at the nodes and is 1 at the start.

use bytemuck::Zeroable;

use crate::math::legendre;
use crate::math::nodal::{LONG, Nodal, add, dot, end};
use crate::math::simd::{Arithmetic, Simd, compiled_for};

/// Most terms of a power series: `7^n / n!` is below rounding from there on. Pinned: ÷ 4,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const TERMS: usize = 48;

/// Terms of a power series below this are left out, 1. A thousandth of rounding. Pinned: × 1e10,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const NEGLIGIBLE: f64 = 1e-19;

/// Points of the quadrature for repeated integrals. Exact for all that are large. Pinned: ÷ 5,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const POINTS: usize = 20;

/// Largest number of load shapes: one for each node, one for the error estimate.
pub const MAX_SHAPES: usize = LONG + 1;

/// What the polynomials of a step are polynomials of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Variable {
    /// Time.
    #[default]
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

    /// Part of the step per place, at a place.
    fn slope(self, place: f64) -> f64 {
        match self {
            Self::Time => 1.0,
            Self::Root => 2.0 * place,
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
    pub powers: Vec<Nodal<S>>,
    /// Root times step length up to which its n-th power over n! is [`NEGLIGIBLE`], n = 1, 2, ...
    pub negligible: Vec<f64>,
    /// n-fold integrals from the start, n = 1, 2, ...
    pub integrals: Vec<Table<S>>,
    /// Integrals of the Lagrange polynomials up to the end of the step.
    pub end_integrals: Vec<Nodal<S>>,
    /// m-th derivatives, m = 0, ..., S.
    pub derivatives: Vec<Table<S>>,
    /// Derivatives of the Lagrange polynomials at the end of the step.
    pub end_derivatives: Vec<Nodal<S>>,
    /// Derivatives at the start of the step.
    pub start_derivatives: Vec<Row<S>>,
}

/// Integrals and derivatives of one load, in units of the step length.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// n-fold integrals from the start up to the end of the step, n = 1, 2, ...
    pub integrals: [f64; TERMS],
    /// m-th derivatives at the start and at the end, m = 0, 1, ...
    pub derivatives: [[f64; 2]; MAX_SHAPES],
}

impl<const S: usize> Table<S> {
    /// All zero.
    pub const ZERO: Self = Self {
        nodal: [[0.0; S]; S],
        error: [0.0; S],
    };

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
    /// The nodal polynomial through these values.
    #[inline(always)]
    pub fn load<A: Arithmetic>(&self, values: &Nodal<S>) -> Load {
        let mut load = Load {
            integrals: [0.0; TERMS],
            derivatives: [[0.0; 2]; MAX_SHAPES],
        };
        for (integral, row) in load.integrals.iter_mut().zip(&self.end_integrals) {
            *integral = dot::<S, A>(row, values);
        }
        let rows = self.start_derivatives.iter().zip(&self.end_derivatives);
        for (derivative, (start, end)) in load.derivatives.iter_mut().zip(rows) {
            *derivative = [dot::<S, A>(&start.nodal, values), dot::<S, A>(end, values)];
        }
        load
    }

    /// From the nodes on [0, 1] by a variable and a function that gives the derivatives (m = 0, ..., S) by it of each shape at a
    /// place.
    pub fn new(nodes: &Nodal<S>, variable: Variable, derivatives_at: impl Fn(f64) -> Vec<[f64; MAX_SHAPES]>) -> Self {
        let mut power = [1.0; S];
        let times = variable.times(nodes);
        let powers = (0..=TERMS).map(|n| {
            let now = power;
            for (power, x) in power.iter_mut().zip(&times) {
                *power *= x / (n + 1) as f64;
            }
            now
        });
        let start = rows(&derivatives_at(0.0));
        let integrals = integrals(nodes, variable);
        let at_nodes = nodes.map(|x| rows(&derivatives_at(x)));
        let derivatives: Vec<_> = (0..=S).map(|m| table(&at_nodes, m)).collect();
        let mut factorial = 1.0;
        let negligible = (1..TERMS).map(|n| {
            factorial *= n as f64;
            (NEGLIGIBLE * factorial).powf(1.0 / n as f64)
        });
        Self {
            variable,
            negligible: negligible.collect(),
            powers: powers.collect(),
            end_integrals: integrals.iter().map(Table::end).collect(),
            integrals,
            end_derivatives: derivatives.iter().map(Table::end).collect(),
            derivatives,
            start_derivatives: start,
        }
    }
}

/// `n`-fold integrals by Cauchy's formula, the integral of `(x - s)^(n-1) / (n-1)!` times the shape, by Gauss
/// quadrature.
fn integrals<const S: usize>(nodes: &Nodal<S>, variable: Variable) -> Vec<Table<S>> {
    compiled_for!(Simd::detect(), A => integrals_by::<S, A>(nodes, variable))
}

#[inline(always)]
fn integrals_by<const S: usize, A: Arithmetic>(nodes: &Nodal<S>, variable: Variable) -> Vec<Table<S>> {
    let mut tables = vec![Table::<S>::ZERO; TERMS];
    let points: Vec<_> = legendre::gauss(POINTS).collect();
    // Of each shape, and of its magnitude.
    let mut sums = vec![[[0.0; MAX_SHAPES]; 2]; TERMS];
    for (i, &x) in nodes.iter().enumerate() {
        sums.fill([[0.0; MAX_SHAPES]; 2]);
        for (point, weight) in &points {
            let s = x * f64::midpoint(1.0, *point);
            let mut values = [[0.0; MAX_SHAPES]; 2];
            let [signed, sizes] = &mut values;
            for ((value, size), shape) in signed.iter_mut().zip(sizes).zip(shape_values(nodes, s)) {
                (*value, *size) = (shape, shape.abs());
            }
            let [end, now] = variable.times(&[x, s]);
            let mut kernel = 0.5 * weight * x * variable.slope(s);
            for (n, sums) in sums.iter_mut().enumerate() {
                for (sums, values) in sums.iter_mut().zip(&values) {
                    add::<MAX_SHAPES, A>(sums, kernel, values);
                }
                kernel *= (end - now) / (n + 1) as f64;
            }
        }
        for (table, [sums, sizes]) in tables.iter_mut().zip(&sums) {
            for ((column, sum), size) in table.columns_mut().zip(sums).zip(sizes) {
                // What is mere rounding is zero.
                let sum = if sum.abs() <= 16.0 * f64::EPSILON * size {
                    0.0
                } else {
                    *sum
                };
                column.iter_mut().skip(i).take(1).for_each(|entry| *entry = sum);
            }
        }
    }
    tables
}

/// The shapes at `s`.
fn shape_values<const S: usize>(nodes: &Nodal<S>, s: f64) -> impl Iterator<Item = f64> {
    let lagrange = nodes.map(|own| {
        let others = nodes.iter().filter(|node| **node != own);
        others.map(|node| (s - node) / (own - node)).product::<f64>()
    });
    let vanishing = nodes.iter().map(|node| 1.0 - s / node).product();
    lagrange.into_iter().chain([vanishing])
}

/// Transposes derivatives given shape by shape into rows of one order each.
fn rows<const S: usize>(shapes: &[[f64; MAX_SHAPES]]) -> Vec<Row<S>> {
    let row = |m: usize| {
        let mut values = shapes.iter().filter_map(|shape| shape.get(m)).copied();
        Row {
            nodal: [0.0; S].map(|_| values.next().unwrap_or_default()),
            error: values.next().unwrap_or_default(),
        }
    };
    (0..=S).map(row).collect()
}

/// The m-th row of every node.
fn table<const S: usize>(at_nodes: &[Vec<Row<S>>; S], m: usize) -> Table<S> {
    let mut table = Table::ZERO;
    for (i, row) in at_nodes.iter().filter_map(|rows| rows.get(m)).enumerate() {
        let values = row.nodal.iter().chain([&row.error]);
        for (column, value) in table.columns_mut().zip(values) {
            column.iter_mut().skip(i).take(1).for_each(|entry| *entry = *value);
        }
    }
    table
}
