//! Modes side by side, for vector arithmetic: their motion up to the end of a step under polynomial loads.
//!
//! The sums over integrals and derivatives of the loads are those of
//! [`modal_response`](crate::integrator::collocation::modal_response). Their factors follow from recurrences, so a sum is
//! taken from its last term on (Horner's rule, Clenshaw's algorithm): displacement and velocity result from one pass.

#![expect(clippy::needless_range_loop, reason = "several arrays have a value for each mode")]

use crate::beam::mode::{Mode, ModeState};
use crate::integrator::collocation::modal_response::Regime;
use crate::integrator::collocation::shapes::{Load, Shapes, TERMS};
use crate::integrator::collocation::superposition::Pair;
use crate::math::free_motion::{FreeMotion, Roots};
use crate::math::nodal::{add, add_products};
use crate::math::simd::{Arithmetic, LANES};

/// A value for each of the modes side by side.
pub(super) type Lanes = [f64; LANES];

/// Loads up to the end of a step of `length` seconds on modes side by side.
pub(super) struct Loads<'a, const S: usize> {
    pub(super) shapes: &'a Shapes<S>,
    pub(super) length: f64,
    pub(super) polynomials: &'a [Load],
    /// Of each polynomial its part in the load on each mode.
    pub(super) parts: &'a [Lanes],
}

/// What is known of modes side by side over a step.
struct Group {
    /// Factors of velocity and displacement in the acceleration, times the step length.
    damping: Lanes,
    squared: Lanes,
    /// Magnitudes of the roots, times the step length.
    slow: Lanes,
    fast: Lanes,
    free: [FreeMotion; LANES],
}

impl<const S: usize> Loads<'_, S> {
    /// The modes at the end from those at the start.
    #[inline(always)]
    pub(super) fn moved<A: Arithmetic>(
        &self,
        modes: &[Mode; LANES],
        starts: &[ModeState; LANES],
        ends: &mut [ModeState; LANES],
    ) {
        let [omega_squared, damping] =
            [|mode: &Mode| mode.omega_squared, |mode: &Mode| mode.damping].map(|of| modes.each_ref().map(of));
        let h = self.length;
        let roots = Roots::of(&omega_squared, &damping);
        let group = Group {
            damping: damping.map(|damping| -damping * h),
            squared: omega_squared.map(|squared| -squared * h * h),
            slow: roots.slow.map(|root| root * h),
            fast: roots.fast.map(|root| root * h),
            free: FreeMotion::side_by_side::<LANES, A>(&omega_squared, &damping, &roots, &[h; LANES]),
        };
        let Pair { q, v } = self.response::<A>(&group);
        let by_loads = q.iter().zip(&v);
        for (((end, start), free), (q, v)) in ends.iter_mut().zip(starts).zip(&group.free).zip(by_loads) {
            end.q = free.q_from_q * start.q + free.q_from_v * start.v + h * h * q;
            end.v = free.v_from_q * start.q + free.v_from_v * start.v + h * v;
        }
    }

    /// The responses to the loads from rest; displacement in step lengths squared, velocity in step lengths. Where the modes are of
    /// several regimes, each takes the sums of its own.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
    fn response<A: Arithmetic>(&self, group: &Group) -> Pair<Lanes> {
        let [mut slow, mut fast, mut split] = [[false; LANES]; 3];
        for i in 0..LANES {
            match Regime::of(group.slow[i], group.fast[i]) {
                Regime::Slow => slow[i] = true,
                Regime::Fast => fast[i] = true,
                Regime::Split(..) => split[i] = true,
            }
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
    #[expect(clippy::indexing_slicing, reason = "integrals that there are")]
    fn of_slow<A: Arithmetic>(&self, group: &Group, these: [bool; LANES]) -> Pair<Lanes> {
        let (mut v, mut q) = ([0.0; LANES], [0.0; LANES]);
        for n in (0..self.terms(&group.fast, these)).rev() {
            let mut next = self.sum::<A>(|load| load.integrals[n]);
            add_products::<LANES, A>(&mut next, &group.squared, &q);
            add_products::<LANES, A>(&mut next, &group.damping, &v);
            (v, q) = (next, v);
        }
        Pair { q, v }
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "derivatives that there are, and a value for each mode")]
    fn of_fast<A: Arithmetic>(&self, group: &Group) -> Pair<Lanes> {
        let inverse = group.squared.map(f64::recip);
        let mut over_squared = group.damping;
        for (damping, inverse) in over_squared.iter_mut().zip(&inverse) {
            *damping *= -inverse;
        }
        let mut ends = [Pair { q: [0.0; LANES], v: [0.0; LANES] }; 2];
        for m in (0..=S).rev() {
            for (end, Pair { q, v }) in ends.iter_mut().enumerate() {
                let mut next = self.sum::<A>(|load| load.derivatives[m][end]);
                add_products::<LANES, A>(&mut next, &inverse, v);
                add_products::<LANES, A>(&mut next, &over_squared, q);
                (*q, *v) = (next, *q);
            }
        }
        let [start, mut end] = ends;
        for i in 0..LANES {
            let FreeMotion { q_from_q, q_from_v, v_from_q, v_from_v } = group.free[i];
            let h = self.length;
            end.q[i] -= q_from_q * start.q[i] + q_from_v / h * start.v[i];
            end.v[i] -= v_from_q * h * start.q[i] + v_from_v * start.v[i];
            end.q[i] *= -inverse[i];
            end.v[i] *= -inverse[i];
        }
        end
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "integrals and derivatives that there are, and a value for each mode")]
    fn of_split<A: Arithmetic>(&self, group: &Group, these: [bool; LANES]) -> Pair<Lanes> {
        let (slow, inverse) = (group.slow.map(|root| -root), group.fast.map(|root| -1.0 / root));
        let mut by_slow = [0.0; LANES];
        for n in (0..self.terms(&group.slow, these)).rev() {
            let mut next = self.sum::<A>(|load| load.integrals[n]);
            add_products::<LANES, A>(&mut next, &slow, &by_slow);
            by_slow = next;
        }
        let [mut start, mut end] = [[0.0; LANES]; 2];
        for m in (0..=S).rev() {
            for (k, sum) in [&mut start, &mut end].into_iter().enumerate() {
                let mut next = self.sum::<A>(|load| load.derivatives[m][k]);
                add_products::<LANES, A>(&mut next, &inverse, sum);
                *sum = next;
            }
        }
        let (mut q, mut v) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let share = 1.0 / (slow[i] + group.fast[i]);
            // What the fast root follows, less what fades of it.
            let decay = group.free[i].v_from_v - slow[i] * group.free[i].q_from_v / self.length;
            let followed = end[i] - decay * start[i];
            q[i] = share * (by_slow[i] + inverse[i] * followed);
            v[i] = share * (slow[i] * by_slow[i] + followed);
        }
        Pair { q, v }
    }

    /// A value of the loads, such as an integral, for each mode.
    #[inline(always)]
    fn sum<A: Arithmetic>(&self, value: impl Fn(&Load) -> f64) -> Lanes {
        let mut sum = [0.0; LANES];
        for (load, parts) in self.polynomials.iter().zip(self.parts) {
            add::<LANES, A>(&mut sum, value(load), parts);
        }
        sum
    }

    /// Number of integrals of which the powers of the roots of these modes, times the step length, are not all negligible.
    #[inline(always)]
    fn terms(&self, roots: &Lanes, these: [bool; LANES]) -> usize {
        let of_these = roots.iter().zip(&these).map(|(root, is)| if *is { *root } else { 0.0 });
        let root = of_these.fold(0.0, f64::max);
        let counts = self.shapes.negligible.partition_point(|limit| *limit <= root);
        (counts + 2).min(TERMS)
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
