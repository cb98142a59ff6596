//! Modes side by side, for vector arithmetic: their motion up to the end of a step under polynomial loads.
//!
//! The sums over integrals and derivatives of the loads are those of
//! [`modal_response`](crate::integrator::collocation::modal_response). Their factors follow from recurrences, so a sum is
//! taken from its last term on (Horner's rule, Clenshaw's algorithm): displacement and velocity result from one pass.

use std::array;

use crate::beam::mode::{Mode, ModeState, ModeStates};
use crate::integrator::collocation::modal_response::Regime;
use crate::integrator::collocation::shapes::{Load, Shapes, TERMS};
use crate::integrator::collocation::superposition::Pair;
use crate::math::free_motion::{FreeMotion, Roots};
use crate::math::nodal::{add, add_products, greatest};
use crate::math::simd::{Arithmetic, LANES};

/// Loads up to the end of a step of `length` seconds.
pub(super) struct Loads<'a, const S: usize, const LOADS: usize> {
    pub(super) shapes: &'a Shapes<S>,
    pub(super) length: f64,
    pub(super) polynomials: [&'a Load; LOADS],
}

impl<const S: usize, const LOADS: usize> Loads<'_, S, LOADS> {
    /// The modes at the end from those at the start, [`LANES`] side by side; each under the sum of the loads times its `factors`.
    #[inline(always)]
    pub(super) fn move_all<A: Arithmetic>(
        &self,
        modes: &[Mode],
        factors: impl Fn(usize, &Mode) -> [f64; LOADS],
        starts: &ModeStates,
        ends: &mut ModeStates,
    ) {
        let (groups, rest) = modes.as_chunks::<LANES>();
        let (starts, _) = starts.as_chunks::<LANES>();
        let (ends, _) = ends.as_chunks_mut::<LANES>();
        let mut states = starts.iter().zip(ends);
        for (k, (group, (starts, ends))) in groups.iter().zip(&mut states).enumerate() {
            let mut of_group = [[0.0; LANES]; LOADS];
            for (i, mode) in group.iter().enumerate() {
                for (row, factor) in of_group.iter_mut().zip(factors(k * LANES + i, mode)) {
                    row.iter_mut().skip(i).take(1).for_each(|entry| *entry = factor);
                }
            }
            self.moved::<A, LANES>(group, &of_group, starts, ends);
        }
        if let Some((starts, ends)) = states.next() {
            let done = modes.len() - rest.len();
            for (i, ((mode, start), end)) in rest.iter().zip(starts).zip(ends).enumerate() {
                let of_mode = factors(done + i, mode).map(|factor| [factor]);
                let (mode, start, end) = (array::from_ref(mode), array::from_ref(start), array::from_mut(end));
                self.moved::<A, 1>(mode, &of_mode, start, end);
            }
        }
    }

    /// The modes at the end from those at the start, each under the sum of the loads times its factors; side by side if they
    /// are of one regime, else one by one.
    #[inline(always)]
    pub(super) fn moved<A: Arithmetic, const N: usize>(
        &self,
        modes: &[Mode; N],
        factors: &[[f64; N]; LOADS],
        starts: &[ModeState; N],
        ends: &mut [ModeState; N],
    ) {
        let [omega_squared, damping] =
            [|mode: &Mode| mode.omega_squared, |mode: &Mode| mode.damping].map(|of| modes.each_ref().map(of));
        let h = self.length;
        let roots = Roots::of(&omega_squared, &damping);
        let free = FreeMotion::side_by_side::<N, A>(&omega_squared, &damping, &roots, &[h; N]);
        let mut response = if let Some(regime) = Together::of(&omega_squared, &damping, &roots, h) {
            regime.under::<S, A, LOADS>(self, &free, factors)
        } else {
            let mut responses = Pair {
                q: [0.0; N],
                v: [0.0; N],
            };
            for i in 0..N {
                #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
                let (omega_squared, damping, free, factors) = (
                    [omega_squared[i]],
                    [damping[i]],
                    [free[i]],
                    factors.each_ref().map(|factors| [factors[i]]),
                );
                if let Some(alone) = Together::of(&omega_squared, &damping, &roots.alone(i), h) {
                    let Pair { q: [q], v: [v] } = alone.under::<S, A, LOADS>(self, &free, &factors);
                    #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
                    {
                        (responses.q[i], responses.v[i]) = (q, v);
                    }
                }
            }
            responses
        };
        if let [factors] = factors.as_slice() {
            for (values, factor) in response.q.iter_mut().zip(&mut response.v).zip(factors) {
                *values.0 *= factor;
                *values.1 *= factor;
            }
        }
        let by_loads = response.q.iter().zip(&response.v);
        for (((end, start), free), (q, v)) in ends.iter_mut().zip(starts).zip(&free).zip(by_loads) {
            end.q = free.q_from_q * start.q + free.q_from_v * start.v + h * h * q;
            end.v = free.v_from_q * start.q + free.v_from_v * start.v + h * v;
        }
    }

    /// A value of the loads, such as an integral, for each mode; where there is one load, without its factors: they come last.
    #[inline(always)]
    fn sum<A: Arithmetic, const N: usize>(
        &self,
        factors: &[[f64; N]; LOADS],
        value: impl Fn(&Load) -> f64,
    ) -> [f64; N] {
        if let [load] = self.polynomials.as_slice() {
            return [value(load); N];
        }
        let mut sum = [0.0; N];
        for (load, factors) in self.polynomials.iter().zip(factors) {
            add::<N, A>(&mut sum, value(load), factors);
        }
        sum
    }

    /// Number of integrals of which the powers of a root times the step length are not negligible.
    #[inline(always)]
    fn terms(&self, root: f64) -> usize {
        let counts = self.shapes.negligible.partition_point(|limit| *limit <= root);
        (counts + 2).min(TERMS)
    }
}

/// Modes over a step that are of one [`Regime`].
enum Together<const N: usize> {
    /// Factors of velocity and displacement in the acceleration; the largest root. All times the step length.
    Slow([f64; N], [f64; N], f64),
    /// The same factors over that of the displacement, and its inverse.
    Fast([f64; N], [f64; N]),
    /// The roots times the step length.
    Split([f64; N], [f64; N]),
}

impl<const N: usize> Together<N> {
    /// These modes over `h` seconds, if they are of one regime.
    #[inline(always)]
    fn of(omega_squared: &[f64; N], damping: &[f64; N], roots: &Roots<N>, h: f64) -> Option<Self> {
        let (slow, fast) = (roots.slow.map(|root| root * h), roots.fast.map(|root| root * h));
        let all = |which: fn(&Regime) -> bool| {
            let mut roots = slow.iter().zip(&fast);
            roots.all(|(slow, fast)| which(&Regime::of(*slow, *fast)))
        };
        let damping = damping.map(|damping| -damping * h);
        let squared = omega_squared.map(|squared| -squared * h * h);
        if all(|regime| matches!(regime, Regime::Slow)) {
            Some(Self::Slow(damping, squared, greatest(&fast)))
        } else if all(|regime| matches!(regime, Regime::Fast)) {
            let inverse = squared.map(f64::recip);
            let mut over_squared = damping;
            over_squared
                .iter_mut()
                .zip(&inverse)
                .for_each(|(damping, inverse)| *damping *= -inverse);
            Some(Self::Fast(over_squared, inverse))
        } else if all(|regime| matches!(regime, Regime::Split(..))) {
            Some(Self::Split(slow.map(|root| -root), fast.map(|root| -root)))
        } else {
            None
        }
    }

    /// The responses to the loads times these factors, from rest; displacement in step lengths squared, velocity in step
    /// lengths. `free`: the free motions.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each mode")]
    fn under<const S: usize, A: Arithmetic, const LOADS: usize>(
        &self,
        loads: &Loads<S, LOADS>,
        free: &[FreeMotion; N],
        factors: &[[f64; N]; LOADS],
    ) -> Pair<[f64; N]> {
        let integral = |n: usize| loads.sum::<A, N>(factors, |load| load.integrals[n]);
        let derivative = |m: usize, end: usize| loads.sum::<A, N>(factors, |load| load.derivatives[m][end]);
        match self {
            Self::Slow(damping, squared, root) => {
                let (mut v, mut q) = ([0.0; N], [0.0; N]);
                for n in (0..loads.terms(*root)).rev() {
                    let mut next = integral(n);
                    add_products::<N, A>(&mut next, squared, &q);
                    add_products::<N, A>(&mut next, damping, &v);
                    (v, q) = (next, v);
                }
                Pair { q, v }
            }
            Self::Fast(damping, inverse) => {
                let mut ends = [Pair {
                    q: [0.0; N],
                    v: [0.0; N],
                }; 2];
                for m in (0..=S).rev() {
                    for (end, Pair { q, v }) in ends.iter_mut().enumerate() {
                        let mut next = derivative(m, end);
                        add_products::<N, A>(&mut next, inverse, v);
                        add_products::<N, A>(&mut next, damping, q);
                        (*q, *v) = (next, *q);
                    }
                }
                let [start, mut end] = ends;
                for i in 0..N {
                    let FreeMotion {
                        q_from_q,
                        q_from_v,
                        v_from_q,
                        v_from_v,
                    } = free[i];
                    let h = loads.length;
                    end.q[i] -= q_from_q * start.q[i] + q_from_v / h * start.v[i];
                    end.v[i] -= v_from_q * h * start.q[i] + v_from_v * start.v[i];
                    end.q[i] *= -inverse[i];
                    end.v[i] *= -inverse[i];
                }
                end
            }
            Self::Split(slow, fast) => {
                let root = slow.iter().fold(0.0_f64, |root, slow| root.max(slow.abs()));
                let mut by_slow = [0.0; N];
                for n in (0..loads.terms(root)).rev() {
                    let mut next = integral(n);
                    add_products::<N, A>(&mut next, slow, &by_slow);
                    by_slow = next;
                }
                let inverse = fast.map(f64::recip);
                let [mut start, mut end] = [[0.0; N]; 2];
                for m in (0..=S).rev() {
                    for (k, sum) in [&mut start, &mut end].into_iter().enumerate() {
                        let mut next = derivative(m, k);
                        add_products::<N, A>(&mut next, &inverse, sum);
                        *sum = next;
                    }
                }
                let (mut q, mut v) = ([0.0; N], [0.0; N]);
                for i in 0..N {
                    let share = 1.0 / (slow[i] - fast[i]);
                    // What the fast root follows, less what fades of it.
                    let decay = free[i].v_from_v - slow[i] * free[i].q_from_v / loads.length;
                    let followed = end[i] - decay * start[i];
                    q[i] = share * (by_slow[i] + inverse[i] * followed);
                    v[i] = share * (slow[i] * by_slow[i] + followed);
                }
                Pair { q, v }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::modal_response::ModeOverStep;
    use crate::integrator::collocation::polynomial::LONG_BY_TIME;
    use crate::math::nodal::{LONG, dot};
    use crate::math::simd::Separate;

    /// Modes with these roots of `omega^2` times the step, and damping ratios.
    fn modes(h: f64, roots: [(f64, f64); LANES]) -> [Mode; LANES] {
        roots.map(|(omega_h, ratio)| Mode {
            omega_squared: (omega_h / h).powi(2),
            damping: 2.0 * ratio * omega_h / h,
            tip: 1.0,
            participation: 1.0,
            rotation: 1.0,
            ..Mode::default()
        })
    }

    #[test]
    #[expect(
        clippy::indexing_slicing,
        reason = "every index runs over the fixed size of the arrays"
    )]
    fn they_move_as_each_does_alone() {
        let h = 1e-4;
        let collocation = &LONG_BY_TIME;
        let values: [[f64; LONG]; 2] = [1.0, 3.0].map(|k| std::array::from_fn(|j| (k * (1.0 + j as f64)).sin()));
        let both = values.map(|values| collocation.shapes.load::<Separate>(&values));
        let loads = Loads {
            shapes: &collocation.shapes,
            length: h,
            polynomials: [&both[0], &both[1]],
        };
        for roots in [
            [(0.001, 0.0), (0.3, 0.1), (2.0, 1.0), (3.0, 0.9)],
            [(6.8, 0.0), (25.0, 0.3), (9.0, 1.0), (40.0, 1.01)],
            [(4.0, 3.0), (9.0, 5.0), (2.0, 30.0), (1.0, 5.0)],
            [(0.3, 0.1), (25.0, 0.3), (9.0, 5.0), (4.0, 0.3)],
        ] {
            let modes = modes(h, roots);
            let factors = [[1.0, -2.0, 0.5, 3.0], [0.3, 1.0, -1.0, 2.0]];
            let starts = [ModeState { q: 1e-9, v: 1e-5 }; LANES];
            let mut ends = [ModeState::default(); LANES];
            loads.moved::<Separate, LANES>(&modes, &factors, &starts, &mut ends);
            for (i, mode) in modes.iter().enumerate() {
                let over = ModeOverStep::new(mode.omega_squared, mode.damping, h);
                let response = over.response::<LONG, Separate>(&collocation.nodes, &collocation.shapes);
                let Pair { q, v } = response.at_end::<Separate>(&collocation.shapes);
                let mut load = [0.0; LONG];
                for (values, factors) in values.iter().zip(&factors) {
                    add::<LONG, Separate>(&mut load, factors[i], values);
                }
                let free = FreeMotion::new(mode.omega_squared, mode.damping, h);
                let q = free.q_from_q * 1e-9 + free.q_from_v * 1e-5 + h * h * dot::<LONG, Separate>(&q, &load);
                let v = free.v_from_q * 1e-9 + free.v_from_v * 1e-5 + h * dot::<LONG, Separate>(&v, &load);
                // Cancellation of the power series and of the derivatives, as in the test of the responses: twelve digits of
                // the motion of a mode without spring under the load.
                let errors = ((ends[i].q - q) / (h * h), (ends[i].v - v) / h);
                assert!(errors.0.abs().max(errors.1.abs()) < 1e-11, "{roots:?} {i} {errors:?}");
            }
        }
    }
}
