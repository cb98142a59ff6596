//! The exact motion of a damped oscillator `q'' + c q' + omega^2 q = 0` from its initial state.

use std::array;

use crate::math::elementary::{LARGEST_ANGLE, exp, sin_cos};
use crate::math::simd::Arithmetic;

/// Free motion: the state `(q, v)` after a time, per unit of the initial state.
#[derive(Clone, Copy, Debug)]
pub struct FreeMotion {
    /// q per initial q.
    pub q_from_q: f64,
    /// q per initial v (the impulse response G), s.
    pub q_from_v: f64,
    /// v per initial q, 1/s.
    pub v_from_q: f64,
    /// v per initial v.
    pub v_from_v: f64,
}

impl FreeMotion {
    /// After no time.
    const AT_ONCE: Self = Self {
        q_from_q: 1.0,
        q_from_v: 0.0,
        v_from_q: 0.0,
        v_from_v: 1.0,
    };

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
        Self {
            q_from_q,
            q_from_v,
            v_from_q: -omega_squared * q_from_v,
            v_from_v,
        }
    }

    /// Of several oscillators, or of one after several times, side by side.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "there is a value for each")]
    pub fn side_by_side<const N: usize, A: Arithmetic>(
        omega_squared: &[f64; N],
        damping: &[f64; N],
        times: &[f64; N],
    ) -> [Self; N] {
        let half = damping.map(|damping| 0.5 * damping);
        let (mut roots, mut slow, mut fast, mut angles) = ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
        let (mut creeps, mut swings, mut easy) = (false, false, true);
        for i in 0..N {
            let discriminant = half[i] * half[i] - omega_squared[i];
            let root = discriminant.abs().sqrt();
            let t = times[i];
            roots[i] = root;
            if discriminant > 0.0 {
                creeps = true;
                (slow[i], fast[i]) = (-omega_squared[i] / (half[i] + root), -(half[i] + root));
                // Else their difference needs care.
                easy &= root * t > 0.25;
            } else {
                swings = true;
                (slow[i], angles[i]) = (-half[i], root * t);
                easy &= root > 0.0 && angles[i] < LARGEST_ANGLE;
            }
        }
        if !easy {
            return array::from_fn(|i| Self::new(omega_squared[i], damping[i], times[i]));
        }
        let exponents = |rates: &[f64; N]| {
            let mut exponents = *rates;
            exponents.iter_mut().zip(times).for_each(|(rate, t)| *rate *= t);
            exponents
        };
        let by_slow = exp::<N, A>(&exponents(&slow));
        let by_fast = if creeps {
            exp::<N, A>(&exponents(&fast))
        } else {
            [0.0; N]
        };
        let (sin, cos) = if swings {
            sin_cos::<N, A>(&angles)
        } else {
            ([0.0; N], [0.0; N])
        };
        let mut motions = [Self::AT_ONCE; N];
        for i in 0..N {
            let (q_from_v, v_from_v, q_from_q);
            if fast[i] < 0.0 {
                // Far below rounding, and slow where it is not normal.
                let by_fast = if fast[i] * times[i] > -50.0 { by_fast[i] } else { 0.0 };
                q_from_v = (by_slow[i] - by_fast) / (2.0 * roots[i]);
                v_from_v = slow[i] * q_from_v + by_fast;
                q_from_q = by_fast - fast[i] * q_from_v;
            } else {
                q_from_v = by_slow[i] * sin[i] / roots[i];
                v_from_v = by_slow[i] * cos[i] - half[i] * q_from_v;
                q_from_q = by_slow[i] * cos[i] + half[i] * q_from_v;
            }
            motions[i] = Self {
                q_from_q,
                q_from_v,
                v_from_q: -omega_squared[i] * q_from_v,
                v_from_v,
            };
        }
        motions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::Separate;

    #[test]
    fn side_by_side_they_move_as_each_does_alone() {
        let ratios = [0.0, 0.3, 0.999, 1.0, 1.001, 1.3, 4.0, 40.0];
        for (k, t) in (0..400).map(|k| (k, 0.01 * 1.02_f64.powi(k))) {
            for first in ratios {
                for second in ratios {
                    let omega = [1.0, 1.7];
                    let squares = omega.map(|omega| omega * omega);
                    let damping = [2.0 * first, 3.4 * second];
                    let together = FreeMotion::side_by_side::<2, Separate>(&squares, &damping, &[t; 2]);
                    for (one, (omega, damping)) in together.iter().zip(omega.into_iter().zip(damping)) {
                        let alone = FreeMotion::new(omega * omega, damping, t);
                        let wrong = [
                            one.q_from_q - alone.q_from_q,
                            omega * (one.q_from_v - alone.q_from_v),
                            (one.v_from_q - alone.v_from_q) / omega,
                            one.v_from_v - alone.v_from_v,
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

    #[test]
    fn free_motion_composes() {
        for (w, c, t) in [
            (1.0, 0.0, 0.3),
            (1e10, 1e2, 1e-5),
            (1e10, 2e5, 1e-5),
            (1e10, 8e5, 1e-5),
            (1e12, 1e9, 1e-5),
        ] {
            let once = FreeMotion::new(w, c, t);
            let twice = FreeMotion::new(w, c, 2.0 * t);
            let q = once.q_from_q * once.q_from_q + once.q_from_v * once.v_from_q;
            let g = once.q_from_q * once.q_from_v + once.q_from_v * once.v_from_v;
            assert!((q - twice.q_from_q).abs() < 1e-14, "{w} {c} {t}");
            assert!((g - twice.q_from_v).abs() < 1e-13 * once.q_from_v.abs(), "{w} {c} {t}");
        }
    }
}
