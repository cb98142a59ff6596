//! The exact motion of a damped oscillator `q'' + c q' + omega^2 q = 0` from its initial state.

use bytemuck::Zeroable;

use crate::math::elementary::{LARGEST_ANGLE, exp, sin_cos};
use crate::math::nodal::add_products;
use crate::math::simd::Arithmetic;

/// Free motion: the state `(q, v)` after a time, per unit of the initial state; of an oscillator, or of several by vectors.
#[derive(Clone, Copy, Debug, Default, Zeroable)]
pub struct FreeMotion<T = f64> {
    /// q per initial q.
    pub q_from_q: T,
    /// q per initial v (the impulse response G), s.
    pub q_from_v: T,
    /// v per initial q, 1/s.
    pub v_from_q: T,
    /// v per initial v.
    pub v_from_v: T,
}

/// Exponent from which on what decays counts as zero: far below rounding, and slow to compute with once it is not normal.
pub const FADED: f64 = -50.0;

/// Several oscillators and their characteristic roots.
#[derive(Clone, Copy, Debug)]
pub struct Roots<const N: usize> {
    /// Squares of the natural frequencies, 1/s2.
    pub omega_squared: [f64; N],
    /// Their damping c, 1/s.
    pub damping: [f64; N],
    /// Whether they are real.
    pub creeps: [bool; N],
    /// Half their distance in the complex plane, 1/s.
    pub split: [f64; N],
    /// The smaller and the larger magnitude, 1/s.
    pub slow: [f64; N],
    /// See [`Roots::slow`].
    pub fast: [f64; N],
}

impl<const N: usize> Roots<N> {
    /// For `omega_squared` >= 0 (1/s2) and `damping` c >= 0 (1/s).
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each")]
    pub fn of(omega_squared: [f64; N], damping: [f64; N]) -> Self {
        let (mut creeps, mut split, mut slow, mut fast) = ([false; N], [0.0; N], [0.0; N], [0.0; N]);
        for i in 0..N {
            let half = 0.5 * damping[i];
            let discriminant = half * half - omega_squared[i];
            split[i] = discriminant.abs().sqrt();
            creeps[i] = discriminant > 0.0;
            let omega = omega_squared[i].sqrt();
            fast[i] = if creeps[i] { half + split[i] } else { omega };
            // Their product is omega^2.
            slow[i] = if fast[i] > 0.0 { omega_squared[i] / fast[i] } else { 0.0 };
        }
        Self { omega_squared, damping, creeps, split, slow, fast }
    }
}

impl FreeMotion {
    /// After the time `t` > 0 (s), for `omega_squared` >= 0 (1/s2) and `damping` c >= 0 (1/s).
    pub fn new(omega_squared: f64, damping: f64, t: f64) -> Self {
        let half = damping / 2.0;
        let discriminant = half * half - omega_squared;
        let (q_from_v, v_from_v, q_from_q);
        if discriminant > 0.0 {
            let w = discriminant.sqrt();
            let (l1, l2) = (-omega_squared / (half + w), -(half + w));
            let (e1, e2) = ((l1 * t).exp(), (l2 * t).exp());
            q_from_v = -e1 * (-2.0 * w * t).exp_m1() / (2.0 * w);
            v_from_v = l1 * q_from_v + e2;
            q_from_q = e2 - l2 * q_from_v;
        } else {
            let w = (-discriminant).sqrt();
            let decay = (-half * t).exp();
            let (sin, cos) = (w * t).sin_cos();
            q_from_v = if w > 0.0 { decay * sin / w } else { decay * t };
            v_from_v = decay * cos - half * q_from_v;
            q_from_q = decay * cos + half * q_from_v;
        }
        Self { q_from_q, q_from_v, v_from_q: -omega_squared * q_from_v, v_from_v }
    }

    /// Of several oscillators with these roots, each after its time, side by side.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each")]
    pub fn side_by_side<const N: usize, A: Arithmetic>(roots: &Roots<N>, times: &[f64; N]) -> FreeMotion<[f64; N]> {
        let Roots { omega_squared, damping, creeps, split, slow, fast } = roots;
        // Where the difference of exponentials needs care, or the quotient of sine and angle.
        let is_easy = |i: usize| {
            let angle = split[i] * times[i];
            if creeps[i] { angle > 0.25 } else { angle > 0.0 && angle < LARGEST_ANGLE }
        };
        if !(0..N).all(is_easy) {
            let mut motion = FreeMotion::zeroed();
            for i in 0..N {
                motion.set(i, &Self::new(omega_squared[i], damping[i], times[i]));
            }
            return motion;
        }
        let (mut decays, mut faster, mut angles) = ([0.0; N], [0.0; N], [0.0; N]);
        let (mut of_v, mut of_q) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let half = 0.5 * damping[i];
            faster[i] = if creeps[i] { -fast[i] * times[i] } else { 0.0 };
            angles[i] = if creeps[i] { 0.0 } else { split[i] * times[i] };
            of_v[i] = if creeps[i] { slow[i] } else { half };
            decays[i] = -of_v[i] * times[i];
            of_q[i] = if creeps[i] { fast[i] } else { half };
        }
        let decays = exp::<N, A>(&decays);
        // `q_from_v` times the split, and `v_from_v` with what follows from that.
        let (mut sine, mut cosine) = ([0.0; N], [0.0; N]);
        if creeps.contains(&true) {
            let faded = exp::<N, A>(&faster);
            for i in 0..N {
                cosine[i] = if faster[i] > FADED { faded[i] } else { 0.0 };
                sine[i] = 0.5 * (decays[i] - cosine[i]);
            }
        }
        if creeps.contains(&false) {
            let (sin, cos) = sin_cos::<N, A>(&angles);
            for i in 0..N {
                sine[i] = if creeps[i] { sine[i] } else { decays[i] * sin[i] };
                cosine[i] = if creeps[i] { cosine[i] } else { decays[i] * cos[i] };
            }
        }
        let mut motion = FreeMotion { q_from_q: cosine, q_from_v: sine, v_from_q: [0.0; N], v_from_v: cosine };
        for i in 0..N {
            motion.q_from_v[i] /= split[i];
            motion.q_from_q[i] += of_q[i] * motion.q_from_v[i];
            motion.v_from_q[i] = -omega_squared[i] * motion.q_from_v[i];
            motion.v_from_v[i] -= of_v[i] * motion.q_from_v[i];
        }
        motion
    }
}

impl<const N: usize> FreeMotion<[f64; N]> {
    /// Sets that of one of them.
    pub fn set(&mut self, n: usize, one: &FreeMotion) {
        let Self { q_from_q, q_from_v, v_from_q, v_from_v } = self;
        let of_one = [one.q_from_q, one.q_from_v, one.v_from_q, one.v_from_v];
        for (values, value) in [q_from_q, q_from_v, v_from_q, v_from_v].into_iter().zip(of_one) {
            if let Some(entry) = values.get_mut(n) {
                *entry = value;
            }
        }
    }

    /// Their states after these.
    #[inline(always)]
    pub fn moved<A: Arithmetic>(&self, q: &[f64; N], v: &[f64; N]) -> ([f64; N], [f64; N]) {
        let (mut next_q, mut next_v) = ([0.0; N], [0.0; N]);
        add_products::<N, A>(&mut next_q, &self.q_from_q, q);
        add_products::<N, A>(&mut next_q, &self.q_from_v, v);
        add_products::<N, A>(&mut next_v, &self.v_from_q, q);
        add_products::<N, A>(&mut next_v, &self.v_from_v, v);
        (next_q, next_v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::Separate;

    #[test]
    #[expect(clippy::indexing_slicing, reason = "two motions")]
    fn side_by_side_they_move_as_each_does_alone() {
        let ratios = [0.0, 0.3, 0.999, 1.0, 1.001, 1.3, 4.0, 40.0];
        for (k, t) in (0..400).map(|k| (k, 0.01 * 1.02_f64.powi(k))) {
            for first in ratios {
                for second in ratios {
                    let omega = [1.0, 1.7];
                    let squares = omega.map(|omega| omega * omega);
                    let damping = [2.0 * first, 3.4 * second];
                    let together = FreeMotion::side_by_side::<2, Separate>(&Roots::of(squares, damping), &[t; 2]);
                    for (n, (omega, damping)) in omega.into_iter().zip(damping).enumerate() {
                        let alone = FreeMotion::new(omega * omega, damping, t);
                        let wrong = [
                            together.q_from_q[n] - alone.q_from_q,
                            omega * (together.q_from_v[n] - alone.q_from_v),
                            (together.v_from_q[n] - alone.v_from_q) / omega,
                            together.v_from_v[n] - alone.v_from_v,
                        ];
                        // Angles and exponents are rounded.
                        let rounding = 8.0 * f64::EPSILON * (1.0 + omega * t);
                        let kept = wrong.iter().all(|wrong| wrong.abs() <= rounding);
                        assert!(kept, "{k} {first} {second}: {wrong:?}");
                    }
                }
            }
        }
    }
}
