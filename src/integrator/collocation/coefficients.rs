//! The coefficients of a step, which depend on its length only.

use std::ops::Range;

use bytemuck::Zeroable;

use crate::beam::mode::{Mode, ModeState};
use crate::excitation::generator::Turns;
use crate::integrator::collocation::shapes::Shapes;
use crate::integrator::collocation::superposition::{self, Pair, Sum};
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{Nodal, add, add_columns, end, scaled};
use crate::math::simd::{Arithmetic, LANES, Simd, compiled_for};

/// Free motion of a port at the nodes due to one mode; includes the displacement of the port per coordinate of the mode.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct NodeRows<const S: usize> {
    /// Displacement per initial q, and per initial v.
    pub from_q: Nodal<S>,
    /// See [`NodeRows::from_q`].
    pub from_v: Nodal<S>,
    /// Velocity per initial q, and per initial v.
    pub rate_from_q: Nodal<S>,
    /// See [`NodeRows::rate_from_q`].
    pub rate_from_v: Nodal<S>,
}

/// Two values for each mode of a group, one of its q and one of its v, as the states of the modes lie side by side.
pub(super) type Pairs = [f64; 2 * LANES];

/// State of a group of modes at the end of the step.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct EndGroup<const S: usize> {
    /// q per initial q, and v per initial v.
    pub(super) same: Pairs,
    /// q per initial v, and v per initial q.
    pub(super) crossed: Pairs,
    /// q and v per load at each node.
    pub(super) from_load: [Pairs; S],
}

impl<const S: usize> NodeRows<S> {
    /// Sets them to a multiple of the free motion of a mode over a step of `h` seconds.
    #[inline(always)]
    pub(super) fn set<A: Arithmetic>(
        &mut self,
        factor: f64,
        mode: &Mode,
        response: &superposition::Response<S>,
        h: f64,
    ) {
        let Pair { q, v } = &response.impulse;
        self.from_v = scaled(q, factor * h);
        self.rate_from_v = scaled(v, factor);
        self.from_q = scaled(v, factor);
        add::<S, A>(&mut self.from_q, factor * mode.damping * h, q);
        self.rate_from_q = scaled(q, -factor * mode.omega_squared * h);
    }
}

impl<const S: usize> EndGroup<S> {
    /// Sets a mode of it: its free motion, and its displacement and velocity per load at each node.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a mode of the group")]
    pub(super) fn set(&mut self, lane: usize, free: &FreeMotion, load: &Pair<Nodal<S>>) {
        let [q, v] = [2 * lane, 2 * lane + 1];
        (self.same[q], self.same[v]) = (free.q_from_q, free.v_from_v);
        (self.crossed[q], self.crossed[v]) = (free.q_from_v, free.v_from_q);
        for (row, (of_q, of_v)) in self.from_load.iter_mut().zip(load.q.iter().zip(&load.v)) {
            (row[q], row[v]) = (*of_q, *of_v);
        }
    }
}

/// Displacement and velocity at the nodes per unit load at each node.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Columns<const S: usize> {
    /// Displacement.
    pub displacement: [Nodal<S>; S],
    /// Velocity.
    pub velocity: [Nodal<S>; S],
}

/// Motion of a link or port at the nodes: displacement and velocity.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct NodalMotion<const S: usize> {
    pub(crate) d: Nodal<S>,
    pub(crate) rate: Nodal<S>,
}

/// Motion of one mode at the nodes.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct ModeColumns<const S: usize> {
    /// Displacement per initial q, and per initial v.
    pub q_from_q: Nodal<S>,
    /// See [`ModeColumns::q_from_q`].
    pub q_from_v: Nodal<S>,
    /// Displacement and velocity per load on the mode.
    pub load: Response<S>,
}

impl<const S: usize> NodalMotion<S> {
    pub(crate) const ZERO: Self = Self { d: [0.0; S], rate: [0.0; S] };

    /// Adds the response to nodal values of a load.
    #[inline(always)]
    pub(crate) fn respond<A: Arithmetic>(&mut self, columns: &Columns<S>, load: &Nodal<S>) {
        // Copies, which stay in registers.
        let Self { mut d, mut rate } = *self;
        add_columns::<S, A>(&mut d, &columns.displacement, load);
        add_columns::<S, A>(&mut rate, &columns.velocity, load);
        *self = Self { d, rate };
    }

    /// Adds a multiple of another.
    #[inline(always)]
    pub(crate) fn add<A: Arithmetic>(&mut self, factor: f64, other: &Self) {
        add::<S, A>(&mut self.d, factor, &other.d);
        add::<S, A>(&mut self.rate, factor, &other.rate);
    }
}

impl<const S: usize> Columns<S> {
    /// Displacement and velocity at the end under nodal values of the load.
    #[inline(always)]
    pub(crate) fn at_end(&self, load: &Nodal<S>) -> (f64, f64) {
        let last = |columns: &[Nodal<S>; S]| {
            let entries = columns.iter().zip(load);
            entries.map(|(column, load)| end(column) * load).sum()
        };
        (last(&self.displacement), last(&self.velocity))
    }
}

/// Motion of a port per nodal values of a load, and per defect of the load at the start.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Response<const S: usize> {
    /// Per nodal values.
    pub columns: Columns<S>,
    /// Per defect: under the shape of the error estimate.
    pub defect: NodalMotion<S>,
}

/// The coefficients of a step of one length.
#[derive(Clone, Copy, Debug)]
pub struct StepCoefficients<'a, const S: usize> {
    /// The length, s.
    pub length: f64,
    /// Motion of each mode, for an axial force that follows the deflection; else empty.
    pub columns: &'a [ModeColumns<S>],
    /// With friction: velocity of a deflection z that follows another with the contact's damping time, `beta_c z' + z = z_1`,
    /// per difference of the two from the start, 1/s; else empty.
    pub following: &'a [Nodal<S>],
    /// The modes at the end, group by group.
    pub(super) end: &'a [EndGroup<S>],
    /// Phase advance of the generator.
    pub turns: &'a Turns<S>,
    /// Port by port the motion per base acceleration, and per force at each port up to that one.
    pub(super) responses: &'a [Response<S>],
    /// Free motion, port by port and mode by mode.
    pub(super) rows: &'a [NodeRows<S>],
    /// Where those of each port begin and end.
    pub(super) of_port: &'a [Range<usize>],
}

/// Where the responses of a port begin: after those of the ports before it.
pub(super) const fn responses_before(port: usize) -> usize {
    port * (port + 3) / 2
}

impl<'a, const S: usize> StepCoefficients<'a, S> {
    /// Free motion of a port at the nodes, of which the modes that it has a part in begin so.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there are coefficients for every port of the model")]
    pub(super) fn free_motion<A: Arithmetic>(&self, port: usize, states: &[ModeState]) -> NodalMotion<S> {
        // Separate sums for q and v, which the processor computes in parallel.
        let [mut d, mut rate, mut from_v, mut rate_from_v] = [[0.0; S]; 4];
        for (mode, row) in states.iter().zip(&self.rows[self.of_port[port].clone()]) {
            add::<S, A>(&mut d, mode.q, &row.from_q);
            add::<S, A>(&mut from_v, mode.v, &row.from_v);
            add::<S, A>(&mut rate, mode.q, &row.rate_from_q);
            add::<S, A>(&mut rate_from_v, mode.v, &row.rate_from_v);
        }
        for (sum, from_v) in d.iter_mut().zip(&from_v) {
            *sum += from_v;
        }
        for (sum, from_v) in rate.iter_mut().zip(&rate_from_v) {
            *sum += from_v;
        }
        NodalMotion { d, rate }
    }

    /// The response of a port to a base acceleration, which loads the modes with their `participation`.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there are coefficients for every port of the model")]
    pub fn acceleration(&self, port: usize) -> &'a Response<S> {
        &self.responses[responses_before(port)]
    }

    /// The response of one port to forces at another, or at itself.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there are coefficients for every port of the model")]
    pub fn response(&self, a: usize, b: usize) -> &'a Response<S> {
        &self.responses[responses_before(a.max(b)) + 1 + a.min(b)]
    }
}

impl<const S: usize> Response<S> {
    /// All nodal values, one after the other.
    #[inline(always)]
    fn values_mut(&mut self) -> impl Iterator<Item = &mut Nodal<S>> {
        let Self { columns, defect } = self;
        let columns = columns.displacement.iter_mut().chain(&mut columns.velocity);
        columns.chain([&mut defect.d, &mut defect.rate])
    }

    /// Multiplies it.
    #[inline(always)]
    pub(super) fn scale(&mut self, factor: f64) {
        for values in self.values_mut() {
            *values = scaled(values, factor);
        }
    }

    /// Adds a multiple of another.
    #[inline(always)]
    pub(super) fn add<A: Arithmetic>(&mut self, factor: f64, other: &Self) {
        let mut other = *other;
        for (sum, values) in self.values_mut().zip(other.values_mut()) {
            add::<S, A>(sum, factor, values);
        }
    }

    /// Sets it to a sum at the nodes, scaled from units of the step length `h` (s) to seconds.
    #[inline(never)]
    pub(super) fn set(&mut self, sum: &Sum<S>, simd: Simd, shapes: &Shapes<S>, h: f64) {
        let Self { columns, defect } = self;
        compiled_for!(simd, A => {
            let Pair { q, v } = sum.at_nodes::<A>(shapes);
            let nodal = columns.displacement.iter_mut().zip(&mut columns.velocity);
            for ((displacement, velocity), (q, v)) in nodal.zip(q.nodal.iter().zip(&v.nodal)) {
                (*displacement, *velocity) = (scaled(q, h * h), scaled(v, h));
            }
            (defect.d, defect.rate) = (scaled(&q.error, h * h), scaled(&v.error, h));
        });
    }
}
