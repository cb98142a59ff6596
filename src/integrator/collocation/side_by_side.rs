//! Modes side by side, for vector arithmetic: their motion up to the end of a step under polynomial loads.
//!
//! The sums over integrals and derivatives of the loads are those of
//! [`modal_response`](crate::integrator::collocation::modal_response). Their factors follow from recurrences, so a sum is
//! taken from its last term on (Horner's rule, Clenshaw's algorithm): displacement and velocity result from one pass.

#![expect(clippy::needless_range_loop, reason = "several arrays have a value for each mode")]

use crate::beam::mode::ModeState;
use crate::integrator::collocation::elimination::in_use;
use crate::integrator::collocation::modal_response::{FAST, SLOW};
use crate::integrator::collocation::shapes::{Loads, Shapes};
use crate::integrator::collocation::superposition::Pair;
use crate::math::free_motion::{FreeMotion, Roots};
use crate::math::nodal::{add, add_products, scaled};
use crate::math::simd::{Arithmetic, LANES};

/// A value for each of the modes side by side.
pub(super) type Lanes = [f64; LANES];

/// Loads up to the end of a step of `length` seconds on modes side by side.
pub(super) struct Loaded<'a, const S: usize, const N: usize> {
    pub(super) shapes: &'a Shapes<S>,
    pub(super) length: f64,
    pub(super) loads: &'a Loads<N>,
    /// Of each of them its part in the load on each mode.
    pub(super) parts: &'a [Lanes; N],
    /// How many of them there are.
    pub(super) count: usize,
}

/// What is known of modes side by side over a step.
struct Group {
    /// Factors of velocity and displacement in the acceleration, times the step length.
    damping: Lanes,
    squared: Lanes,
    /// Magnitudes of the roots, times the step length.
    slow: Lanes,
    fast: Lanes,
    free: FreeMotion<Lanes>,
}

impl<const S: usize, const N: usize> Loaded<'_, S, N> {
    /// The modes at the end from those at the start.
    #[inline(always)]
    pub(super) fn moved<A: Arithmetic>(
        &self,
        roots: &Roots<LANES>,
        starts: &[ModeState; LANES],
        ends: &mut [ModeState; LANES],
    ) {
        let h = self.length;
        let group = Group {
            damping: scaled(&roots.damping, -h),
            squared: scaled(&roots.omega_squared, -h * h),
            slow: scaled(&roots.slow, h),
            fast: scaled(&roots.fast, h),
            free: FreeMotion::side_by_side::<LANES, A>(roots, &[h; LANES]),
        };
        let Pair { q, v } = self.response::<A>(&group);
        let (mut moved_q, mut moved_v) =
            group.free.moved::<A>(&starts.map(|start| start.q), &starts.map(|start| start.v));
        add::<LANES, A>(&mut moved_q, h * h, &q);
        add::<LANES, A>(&mut moved_v, h, &v);
        for (end, (q, v)) in ends.iter_mut().zip(moved_q.into_iter().zip(moved_v)) {
            *end = ModeState { q, v };
        }
    }

    /// The responses to the loads from rest; displacement in step lengths squared, velocity in step lengths. Where the modes are of
    /// several regimes ([`Regime`](crate::integrator::collocation::modal_response::Regime)), each takes the sums of its own.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
    fn response<A: Arithmetic>(&self, group: &Group) -> Pair<Lanes> {
        let [mut slow, mut fast, mut split] = [[false; LANES]; 3];
        for i in 0..LANES {
            slow[i] = group.fast[i] <= SLOW;
            fast[i] = !slow[i] && group.slow[i] >= FAST;
            split[i] = !slow[i] && !fast[i];
        }
        let mut response = Pair { q: [0.0; LANES], v: [0.0; LANES] };
        if slow.contains(&true) {
            take(&mut response, slow, &self.of_slow::<A>(group, slow));
        }
        if fast.contains(&true) {
            take(&mut response, fast, &self.of_fast::<A>(group));
        }
        if split.contains(&true) {
            take(&mut response, split, &self.of_split::<A>(group, split));
        }
        response
    }

    #[inline(always)]
    fn of_slow<A: Arithmetic>(&self, group: &Group, these: [bool; LANES]) -> Pair<Lanes> {
        let (mut v, mut q) = ([0.0; LANES], [0.0; LANES]);
        for integrals in self.integrals(&group.fast, these).iter().rev() {
            let mut next = self.sum::<A>(integrals);
            add_products::<LANES, A>(&mut next, &group.squared, &q);
            add_products::<LANES, A>(&mut next, &group.damping, &v);
            (v, q) = (next, v);
        }
        Pair { q, v }
    }

    #[inline(always)]
    fn of_fast<A: Arithmetic>(&self, group: &Group) -> Pair<Lanes> {
        let (h, free) = (self.length, &group.free);
        let inverse = group.squared.map(f64::recip);
        let mut over_squared = inverse.map(|inverse| -inverse);
        for (over, damping) in over_squared.iter_mut().zip(&group.damping) {
            *over *= damping;
        }
        let mut ends = [Pair { q: [0.0; LANES], v: [0.0; LANES] }; 2];
        for derivatives in self.derivatives().iter().rev() {
            for (Pair { q, v }, derivative) in ends.iter_mut().zip(derivatives) {
                let mut next = self.sum::<A>(derivative);
                add_products::<LANES, A>(&mut next, &inverse, v);
                add_products::<LANES, A>(&mut next, &over_squared, q);
                (*q, *v) = (next, *q);
            }
        }
        let [start, mut end] = ends;
        let (faded_q, faded_v) = free.moved::<A>(&scaled(&start.q, h), &start.v);
        add::<LANES, A>(&mut end.q, -1.0 / h, &faded_q);
        add::<LANES, A>(&mut end.v, -1.0, &faded_v);
        for (end, inverse) in end.q.iter_mut().zip(&mut end.v).zip(&inverse) {
            *end.0 *= -inverse;
            *end.1 *= -inverse;
        }
        end
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
    fn of_split<A: Arithmetic>(&self, group: &Group, these: [bool; LANES]) -> Pair<Lanes> {
        let (slow, inverse) = (group.slow.map(|root| -root), group.fast.map(|root| -1.0 / root));
        let mut by_slow = [0.0; LANES];
        for integrals in self.integrals(&group.slow, these).iter().rev() {
            let mut next = self.sum::<A>(integrals);
            add_products::<LANES, A>(&mut next, &slow, &by_slow);
            by_slow = next;
        }
        let [mut start, mut end] = [[0.0; LANES]; 2];
        for [at_start, at_end] in self.derivatives().iter().rev() {
            for (sum, derivative) in [(&mut start, at_start), (&mut end, at_end)] {
                let mut next = self.sum::<A>(derivative);
                add_products::<LANES, A>(&mut next, &inverse, sum);
                *sum = next;
            }
        }
        let (mut q, mut v) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let share = 1.0 / (slow[i] + group.fast[i]);
            // What the fast root follows, less what fades of it.
            let decay = group.free.v_from_v[i] - slow[i] * group.free.q_from_v[i] / self.length;
            let followed = end[i] - decay * start[i];
            q[i] = share * (by_slow[i] + inverse[i] * followed);
            v[i] = share * (slow[i] * by_slow[i] + followed);
        }
        Pair { q, v }
    }

    /// A value of the loads, such as an integral, for each mode.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "loads in use")]
    fn sum<A: Arithmetic>(&self, values: &[f64; N]) -> Lanes {
        let mut sum = scaled(&self.parts[0], values[0]);
        for n in 1..in_use::<N>(self.count) {
            add::<LANES, A>(&mut sum, values[n], &self.parts[n]);
        }
        sum
    }

    /// The integrals of which the powers of the roots of these modes, times the step length, are not all negligible.
    #[inline(always)]
    fn integrals(&self, roots: &Lanes, these: [bool; LANES]) -> &[[f64; N]] {
        let of_these = roots.iter().zip(&these).map(|(root, is)| if *is { *root } else { 0.0 });
        let root = of_these.fold(0.0, f64::max);
        let count = self.shapes.negligible.partition_point(|limit| *limit <= root) + 2;
        self.loads.integrals.get(..count).unwrap_or(&self.loads.integrals)
    }

    /// The derivatives that there are.
    #[inline(always)]
    fn derivatives(&self) -> &[[[f64; N]; 2]] {
        self.loads.derivatives.get(..=S).unwrap_or(&self.loads.derivatives)
    }
}

/// Takes the values of these modes.
#[inline(always)]
fn take(response: &mut Pair<Lanes>, these: [bool; LANES], from: &Pair<Lanes>) {
    for (values, from) in [(&mut response.q, &from.q), (&mut response.v, &from.v)] {
        for ((value, from), is) in values.iter_mut().zip(from).zip(&these) {
            *value = if *is { *from } else { *value };
        }
    }
}
