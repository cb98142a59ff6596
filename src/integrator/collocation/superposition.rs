//! Superposition of modal responses to the load shapes: factors of the shapes' integrals and derivatives, and decaying
//! free motions ([`crate::integrator::collocation::modal_response`]). The factors of many modes are summed before they
//! are multiplied by the shapes.

use bytemuck::Zeroable;

use crate::integrator::collocation::shapes::{MAX_SHAPES, Row, Shapes, Table};
use crate::math::nodal::{Nodal, add, end};
use crate::math::series::TERMS;
use crate::math::simd::Arithmetic;

/// Displacement and velocity, in units of the step length.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Pair<T> {
    /// Displacement.
    pub q: T,
    /// Velocity.
    pub v: T,
}

/// Combinations of the n-fold integrals (n = 1, 2, ...) and the m-th derivatives (m = 0, 1, ...) of the load shapes.
#[derive(Clone, Copy, Debug, Zeroable)]
pub(crate) struct Combination {
    /// Factors of the integrals.
    pub(crate) integrals: Pair<[f64; TERMS]>,
    /// Number of integrals in use.
    pub(crate) terms: usize,
    /// Factors of the derivatives.
    pub(crate) derivatives: Pair<[f64; MAX_SHAPES]>,
}

impl Combination {
    pub(crate) const ZERO: Self = Self {
        integrals: Pair { q: [0.0; TERMS], v: [0.0; TERMS] },
        terms: 0,
        derivatives: Pair { q: [0.0; MAX_SHAPES], v: [0.0; MAX_SHAPES] },
    };
}

/// A free motion that cancels the initial value of a combination.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fading<const S: usize> {
    /// Initial value for each shape.
    pub(crate) start: Row<S>,
    /// Free motion at the nodes per initial value.
    pub(crate) fade: Pair<Nodal<S>>,
}

/// The part of a root that is fast against a step by the root of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fast<const S: usize> {
    /// Its convolution with the shapes at the nodes.
    pub(crate) convolved: Table<S>,
    /// Factors of it that are taken from displacement and velocity.
    pub(crate) factors: Pair<f64>,
}

/// The response of one mode to the load shapes and to an initial velocity.
#[derive(Clone, Copy, Debug)]
pub struct Response<const S: usize> {
    pub(crate) combination: Combination,
    /// None, one for a single fast root, or two for a pair.
    pub(crate) fading: [Option<Fading<S>>; 2],
    pub(crate) fast: Option<Fast<S>>,
    /// Free motion at the nodes per initial velocity.
    pub impulse: Pair<Nodal<S>>,
}

/// Sum of the responses of many modes to the load shapes.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Sum<const S: usize> {
    combination: Combination,
    /// Sum of the free motions at the nodes.
    faded: Pair<Table<S>>,
}

impl<const S: usize> Response<S> {
    /// At the end of the step, per load with each of the nodal shapes.
    #[inline(always)]
    pub fn at_end<A: Arithmetic>(&self, shapes: &Shapes<S>) -> Pair<Nodal<S>> {
        let (mut q, mut v) = ([0.0; S], [0.0; S]);
        let Combination { integrals, terms, derivatives } = &self.combination;
        let factors = integrals.q.iter().zip(&integrals.v).take(*terms);
        for ((for_q, for_v), values) in factors.zip(&shapes.end_integrals) {
            add::<S, A>(&mut q, *for_q, values);
            add::<S, A>(&mut v, *for_v, values);
        }
        if self.fading[0].is_some() {
            let factors = derivatives.q.iter().zip(&derivatives.v);
            for ((for_q, for_v), values) in factors.zip(shapes.end_derivatives) {
                add::<S, A>(&mut q, *for_q, values);
                add::<S, A>(&mut v, *for_v, values);
            }
        }
        for fading in self.fading.iter().flatten() {
            add::<S, A>(&mut q, -end(&fading.fade.q), &fading.start.nodal);
            add::<S, A>(&mut v, -end(&fading.fade.v), &fading.start.nodal);
        }
        if let Some(Fast { convolved, factors }) = &self.fast {
            add::<S, A>(&mut q, -factors.q, &convolved.end());
            add::<S, A>(&mut v, -factors.v, &convolved.end());
        }
        Pair { q, v }
    }
}

impl<const S: usize> Sum<S> {
    /// Adds `weight` times a response.
    #[inline(always)]
    pub fn add<A: Arithmetic>(&mut self, weight: f64, response: &Response<S>) {
        let Combination { integrals, terms, derivatives } = &mut self.combination;
        let from = &response.combination;
        *terms = from.terms.max(*terms);
        let add_up = |to: &mut [f64], from: &[f64], count: usize| {
            for (to, from) in to.iter_mut().zip(from).take(count) {
                *to = A::mul_add(weight, *from, *to);
            }
        };
        add_up(&mut integrals.q, &from.integrals.q, from.terms);
        add_up(&mut integrals.v, &from.integrals.v, from.terms);
        if response.fading[0].is_some() {
            add_up(&mut derivatives.q, &from.derivatives.q, S + 1);
            add_up(&mut derivatives.v, &from.derivatives.v, S + 1);
        }
        for fading in response.fading.iter().flatten() {
            let Pair { q, v } = &fading.fade;
            for ((to_q, to_v), start) in
                self.faded.q.nodal.iter_mut().zip(&mut self.faded.v.nodal).zip(&fading.start.nodal)
            {
                add::<S, A>(to_q, weight * start, q);
                add::<S, A>(to_v, weight * start, v);
            }
            add::<S, A>(&mut self.faded.q.error, weight * fading.start.error, q);
            add::<S, A>(&mut self.faded.v.error, weight * fading.start.error, v);
        }
        if let Some(Fast { convolved, factors }) = &response.fast {
            self.faded.q.add::<A>(weight * factors.q, convolved);
            self.faded.v.add::<A>(weight * factors.v, convolved);
        }
    }

    /// At the nodes.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a shape of the table")]
    pub fn at_nodes<A: Arithmetic>(&self, shapes: &Shapes<S>) -> Pair<Table<S>> {
        let (mut q, mut v) = (Table::ZERO, Table::ZERO);
        for shape in 0..S {
            Pair { q: q.nodal[shape], v: v.nodal[shape] } = self.of_shape::<A>(shapes, |table| &table.nodal[shape]);
        }
        Pair { q: q.error, v: v.error } = self.of_shape::<A>(shapes, |table| &table.error);
        Pair { q, v }
    }

    /// At the nodes of one shape, for which the sums stay in registers.
    #[inline(always)]
    fn of_shape<A: Arithmetic>(&self, shapes: &Shapes<S>, column: impl Fn(&Table<S>) -> &Nodal<S>) -> Pair<Nodal<S>> {
        let Self { combination, faded } = self;
        let mut sum = Pair { q: [0.0; S], v: [0.0; S] };
        let Pair { q, v } = &combination.integrals;
        let factors = q.iter().zip(v).take(combination.terms);
        for ((for_q, for_v), table) in factors.zip(&shapes.integrals) {
            add::<S, A>(&mut sum.q, *for_q, column(table));
            add::<S, A>(&mut sum.v, *for_v, column(table));
        }
        let Pair { q, v } = &combination.derivatives;
        for ((for_q, for_v), table) in q.iter().zip(v).zip(shapes.derivatives) {
            add::<S, A>(&mut sum.q, *for_q, column(table));
            add::<S, A>(&mut sum.v, *for_v, column(table));
        }
        add::<S, A>(&mut sum.q, -1.0, column(&faded.q));
        add::<S, A>(&mut sum.v, -1.0, column(&faded.v));
        sum
    }
}
