//! The collocation polynomial in time, or in the root of time, for contact force and base acceleration within a step.
//!
//! A step has `S` Radau IIA nodes, the last one at its end, so that the contact force there satisfies the contact law
//! however stiff its damping (Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.5): eight for long
//! steps, four for short ones (communication steps of a microsecond, the time just after an impact).

use crate::integrator::collocation::shapes::{Row, Shapes, Table, Variable};
use crate::integrator::constants::{FAR_AHEAD, NEAR, SLOWEST_DECAY};
use crate::integrator::course::turning_points;
use crate::math::nodal::{LONG, Nodal, SHORT, add, dot, range, scaled};
use crate::math::prediction::{Prediction, centred, parabola_at_end, value_at};
use crate::math::simd::{Arithmetic, Separate, Simd, compiled_for};

// Computed as the library is built: `build/collocation.rs`.
include!(concat!(env!("OUT_DIR"), "/collocation.rs"));

/// The polynomials of a step with `S` nodes.
#[derive(Debug)]
pub struct Collocation<const S: usize> {
    /// Nodes on [0, 1], ascending: parts of the step.
    pub nodes: Nodal<S>,
    /// Of what the polynomials are.
    pub variable: Variable,
    /// The nodes by that variable, 0 to 1.
    pub places: Nodal<S>,
    /// The load shapes: the Lagrange polynomials of the nodes, and the polynomial of degree S that vanishes at the
    /// nodes and is 1 at the start.
    pub shapes: Shapes<S>,
    /// Lagrange polynomials at the start of the step.
    pub at_start: Nodal<S>,
    /// The same without the first node, without the first two, and without the first three.
    at_start_of_fewer: [Nodal<S>; 3],
    /// Mean of the Lagrange polynomials over the step: the weights of the Radau quadrature.
    weights: Nodal<S>,
    /// Highest coefficients of the Lagrange polynomials.
    leading: Nodal<S>,
    /// Mean over a step of what the nodal polynomial misses of a sine, times its amplitude, over the square of what it misses at the
    /// start, 1, where the phase passes 1 rad: error of the Radau quadrature, `S 2^(2 S - 1) (S - 1)!^4 / (2 S - 1)!^3 (h / 2)^(2 S) /
    /// h` per derivative of order `2 S - 1`, and the product of the nodes over `S!` (P. J. Davis, P. Rabinowitz, Methods of Numerical
    /// Integration, 1984, section 2.7): `S / 2 (S - 1)!^2 / (2 S - 1)!`.
    pub quadrature: f64,
    /// Greatest impulse up to a node that the shape of the error estimate makes, per step length.
    pub impulse: f64,
    /// Of the Lagrange polynomials of the start and the nodes that of the start, by powers of [`centred`] time.
    start: &'static Prediction,
    /// Those of the nodes.
    beside_start: &'static [Prediction; S],
    /// The same for the nodes without the start.
    nodal: &'static [Prediction; S],
}

impl<const S: usize> Collocation<S> {
    /// The Lagrange polynomials at a place `x`, 0 to 1 over the step.
    #[inline(always)]
    pub fn lagrange(&self, x: f64) -> Nodal<S> {
        let mut row = self.leading;
        let (mut below, mut above) = (1.0, 1.0);
        for (entry, node) in row.iter_mut().zip(&self.places) {
            *entry *= below;
            below *= x - node;
        }
        for (entry, node) in row.iter_mut().zip(&self.places).rev() {
            *entry *= above;
            above *= x - node;
        }
        row
    }

    /// The nodal polynomial through `values` at a place `x`, 0 to 1 over the step.
    pub fn interpolate(&self, values: &Nodal<S>, x: f64) -> f64 {
        dot::<S, Separate>(&self.lagrange(x), values)
    }

    /// Whether the nodal polynomial through `values`, with the value `start` at the start of the step, may reach zero
    /// in it.
    pub fn comes_near_zero(start: f64, values: &Nodal<S>) -> bool {
        let (highest, lowest) = range(values);
        lowest <= NEAR * highest.max(start)
    }

    /// First place in the step (0 to 1) before `until` where the nodal polynomial through `values` is found below zero: at a node,
    /// or where it turns. It is not searched before the first node, where the polynomial extrapolates.
    pub fn first_dip(&self, values: &Nodal<S>, until: f64) -> Option<f64> {
        let mut nodes = self.places.iter().zip(values);
        let below = nodes.find(|(node, value)| **node < until && **value < 0.0);
        let below = below.map(|(node, _)| *node);
        let until = below.unwrap_or(until);
        let polynomial = combine::<S, Separate>(self.nodal, values, [0.0; LONG + 1]);
        let first = self.places.first().copied().unwrap_or_default();
        let turns = turning_points(Simd::Portable, &polynomial);
        let mut places = turns.iter().map(|y| 1.0 + y).filter(|x| (first..until).contains(x));
        let dip = places.find(|x| value_at(&polynomial, x - 1.0) < 0.0);
        dip.or(below)
    }

    /// What the polynomial through `values` is expected to miss at the start, where the value is `start` and it misses `defect`; and
    /// what the polynomial through the start, too, is expected to miss. Both are extrapolated from polynomials through fewer
    /// values, as a single sample may pass through zero by chance.
    #[inline(always)]
    pub fn next_terms<A: Arithmetic>(&self, start: f64, values: &Nodal<S>, defect: f64) -> (f64, f64) {
        let [one, two, three] = &self.at_start_of_fewer;
        let (one, two) = (start - dot::<S, A>(values, one), start - dot::<S, A>(values, two));
        let three = start - dot::<S, A>(values, three);
        let decay = (one / two).abs().max((one / three).abs().sqrt()).min(SLOWEST_DECAY);
        let expected = one.abs() * decay;
        (defect.abs().max(expected), expected * decay)
    }

    /// Mean over the step of the nodal polynomial through `values`.
    pub fn mean(&self, values: &Nodal<S>) -> f64 {
        dot::<S, Separate>(values, &self.weights)
    }

    /// The polynomial through the values at the start and at the nodes.
    pub fn through(&self, simd: Simd, start: f64, values: &Nodal<S>) -> Prediction {
        compiled_for!(simd, A => combine::<S, A>(self.beside_start, values, scaled(self.start, start)))
    }

    /// First guess of a quantity at the nodes of a step `ratio` times as long as the last one, from its course there. Far
    /// ahead polynomials of high degree lead astray: there it is the parabola that continues the course.
    #[inline(always)]
    pub fn guess<A: Arithmetic>(&self, course: &Prediction, ratio: f64) -> Nodal<S> {
        let at = scaled(&self.nodes, ratio);
        if ratio > FAR_AHEAD {
            let [value, slope, half_curvature] = parabola_at_end(course);
            return at.map(|y| value + y * (slope + y * half_curvature));
        }
        let at = at.map(centred);
        let mut values = [0.0; S];
        for coefficient in course.iter().rev() {
            for (value, y) in values.iter_mut().zip(&at) {
                *value = A::mul_add(*value, *y, *coefficient);
            }
        }
        values
    }
}

/// The interpolation polynomial of the values in a Lagrange basis, added to another polynomial.
#[inline(always)]
fn combine<const S: usize, A: Arithmetic>(
    basis: &[Prediction; S],
    values: &Nodal<S>,
    mut sum: Prediction,
) -> Prediction {
    for (value, polynomial) in values.iter().zip(basis) {
        add::<{ LONG + 1 }, A>(&mut sum, *value, polynomial);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The nodes with one at the end whose quadrature is exact up to the degree `2 S - 2` are those of Radau.
    #[test]
    fn nodes_and_weights_are_those_of_radau() {
        fn check<const S: usize>(collocation: &Collocation<S>) {
            assert!(collocation.nodes.is_sorted() && collocation.nodes.ends_with(&[1.0]));
            for power in 0..2 * S - 1 {
                let values = collocation.nodes.map(|x| x.powi(i32::try_from(power).unwrap()));
                let exact = 1.0 / (power as f64 + 1.0);
                // Roundings of S terms.
                assert!((collocation.mean(&values) - exact).abs() < 1e-15 * S as f64, "{S} {power}");
            }
        }
        check(&SHORT_BY_TIME);
        check(&LONG_BY_TIME);
    }
}
