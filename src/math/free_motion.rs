//! The exact motion of a damped oscillator `q'' + c q' + omega^2 q = 0` from its initial state.

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
}

#[cfg(test)]
mod tests {
    use super::*;

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
