//! Exact response of a damped oscillator `q'' + c q' + omega^2 q = r(t)` to its initial state and to a load that is a
//! polynomial in time, at any step length and any damping.
//!
//! With the impulse response `G`, let `Psi_m` be the response from rest to `t^m / m!`; `Psi_(-1) = G`, `Psi_(-2) = G'`.
//! Differentiating gives one recursion for all of them,
//! `Psi_(m-2) + c Psi_(m-1) + omega^2 Psi_m = t^m / m!`,
//! and the velocity of the response `m` is `Psi_(m-1)`. The recursion is run in the direction in which it damps errors:
//! upward from the closed form of `G` where the oscillator is fast against the step, downward from a power series where
//! it is slow, and for a strongly overdamped oscillator with one fast and one slow root each root apart.

/// Largest number of load powers: those of the nodal polynomials and of the two shapes of the error estimate.
pub const MOMENTS: usize = super::collocation::MAX_SHAPES;

/// The state `(q, v)` after a time `t` per initial state, and the responses to powers of time.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// q per initial q.
    pub q_from_q: f64,
    /// q per initial v (the impulse response G), s.
    pub q_from_v: f64,
    /// v per initial q, 1/s.
    pub v_from_q: f64,
    /// v per initial v.
    pub v_from_v: f64,
    /// `Psi_m / t^(m+2)`, as many as were asked for.
    pub moments: [f64; MOMENTS],
}

impl Response {
    /// After the time `t` > 0 (s), for `omega_squared` >= 0 (1/s2) and `damping` c >= 0 (1/s), with `count` moments.
    pub fn new(omega_squared: f64, damping: f64, t: f64, count: usize) -> Self {
        let half = damping / 2.0;
        let discriminant = half * half - omega_squared;
        // Magnitudes of the slow and the fast root, times t.
        let (slow, fast, q_from_v, v_from_v, q_from_q);
        if discriminant > 0.0 {
            let w = discriminant.sqrt();
            let (l1, l2) = (-omega_squared / (half + w), -(half + w));
            let (e1, e2) = ((l1 * t).exp(), (l2 * t).exp());
            q_from_v = -e1 * (-2.0 * w * t).exp_m1() / (2.0 * w);
            v_from_v = l1 * q_from_v + e2;
            q_from_q = e2 - l2 * q_from_v;
            (slow, fast) = (-l1 * t, -l2 * t);
        } else {
            let w = (-discriminant).sqrt();
            let decay = (-half * t).exp();
            let (sin, cos) = (w * t).sin_cos();
            q_from_v = if w > 0.0 { decay * sin / w } else { decay * t };
            v_from_v = decay * cos - half * q_from_v;
            q_from_q = decay * cos + half * q_from_v;
            (slow, fast) = (omega_squared.sqrt() * t, omega_squared.sqrt() * t);
        }
        let (c, w) = (damping * t, omega_squared * t * t);
        let moments = if slow >= 4.0 {
            upward(c, w, v_from_v, q_from_v / t, count)
        } else if fast <= 8.0 {
            downward(c, w, count)
        } else {
            split(slow, fast, count)
        };
        Self {
            q_from_q,
            q_from_v,
            v_from_q: -omega_squared * q_from_v,
            v_from_v,
            moments,
        }
    }
}

/// From `Psi_(-2)` and `Psi_(-1) / t` up.
fn upward(c: f64, w: f64, below2: f64, below1: f64, count: usize) -> [f64; MOMENTS] {
    let (mut y2, mut y1, mut power, mut m) = (below2, below1, 1.0, 0.0);
    let mut moments = [0.0; MOMENTS];
    for moment in moments.iter_mut().take(count) {
        *moment = (power - c * y1 - y2) / w;
        (y2, y1) = (y1, *moment);
        m += 1.0;
        power /= m;
    }
    moments
}

/// The two highest moments by their power series `sum gamma_k / (m + 2 + k)!`, the others by the recursion.
fn downward(c: f64, w: f64, count: usize) -> [f64; MOMENTS] {
    let top = count.min(MOMENTS) - 1;
    let factorial = |n: usize| (2..=n).fold(1.0, |product, k| product * k as f64);
    let mut inverse = 1.0 / factorial(top + 1);
    let (mut below, mut gamma) = (0.0, 1.0_f64);
    let (mut y, mut y_below) = (0.0_f64, 0.0);
    let mut order = (top + 1) as f64;
    // Roots times t are at most 8: the terms fall below rounding after 8 e or so, 60 is far beyond.
    for _ in 0..60 {
        y_below += gamma * inverse;
        order += 1.0;
        inverse /= order;
        y += gamma * inverse;
        (below, gamma) = (gamma, -c * gamma - w * below);
        if gamma.abs().max(below.abs()) * inverse < f64::EPSILON * 1e-2 * y.abs() {
            break;
        }
    }
    let mut moments = [0.0; MOMENTS];
    let mut power = 1.0 / factorial(top);
    let mut m = top as f64;
    for moment in moments.iter_mut().take(top + 1).rev() {
        *moment = y;
        (y, y_below) = (y_below, power - c * y_below - w * y);
        power *= m;
        m -= 1.0;
    }
    moments
}

/// Partial fractions `(E_m(l1) - E_m(l2)) / (l1 - l2)`, `E_m(l) = t^(m+1) phi_(m+1)(l t)`.
fn split(slow: f64, fast: f64, count: usize) -> [f64; MOMENTS] {
    let mut moments = phi(-slow, count);
    for (moment, fast_part) in moments.iter_mut().zip(phi(-fast, count)) {
        *moment = (*moment - fast_part) / (fast - slow);
    }
    moments
}

/// `phi_1(z) ... phi_count(z)`, where `phi_0 = e^z` and `phi_(k+1)(z) = (phi_k(z) - 1/k!) / z`, for z < 0: downward from the
/// series of the highest where z is small, upward elsewhere.
fn phi(z: f64, count: usize) -> [f64; MOMENTS] {
    let mut values = [0.0; MOMENTS];
    if z < -4.0 {
        let (mut value, mut inverse, mut k) = (z.exp(), 1.0, 0.0);
        for entry in values.iter_mut().take(count) {
            value = (value - inverse) / z;
            *entry = value;
            k += 1.0;
            inverse /= k;
        }
    } else {
        let mut n = count as f64;
        let mut inverse = (2..=count).fold(1.0, |product, k| product / k as f64);
        let (mut term, mut value, mut order) = (inverse, 0.0, n);
        while term.abs() > f64::EPSILON * 1e-2 * inverse {
            value += term;
            order += 1.0;
            term *= z / order;
        }
        for entry in values.iter_mut().take(count).rev() {
            *entry = value;
            inverse *= n;
            n -= 1.0;
            value = z * value + inverse;
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::legendre;

    /// The moments by quadrature of the impulse response over many panels.
    fn by_quadrature(omega_squared: f64, damping: f64, t: f64) -> [f64; MOMENTS] {
        let scale = omega_squared.sqrt().max(damping);
        let panels = (1..20_000).find(|panels| f64::from(*panels) >= scale * t).unwrap();
        let mut sums = [0.0; MOMENTS];
        for panel in 0..panels {
            for (x, weight) in legendre::gauss(16) {
                let s = t * (f64::from(panel) + f64::midpoint(1.0, x)) / f64::from(panels);
                let g = Response::new(omega_squared, damping, t - s, 1).q_from_v;
                let mut power = 1.0;
                for (m, sum) in sums.iter_mut().enumerate() {
                    *sum += weight * t / (2.0 * f64::from(panels)) * g * power / t.powi(i32::try_from(m).unwrap() + 2);
                    power *= s / (m + 1) as f64;
                }
            }
        }
        sums
    }

    #[test]
    fn moments_agree_with_quadrature_in_every_regime() {
        for omega_t in [1e-3, 0.3, 2.0, 3.9, 4.1, 9.0, 60.0] {
            for ratio in [0.0, 0.01, 0.9, 0.999_999, 1.0, 1.000_001, 1.2, 3.0, 30.0] {
                let (omega, t) = (1e4, omega_t / 1e4);
                let (w, c) = (omega * omega, 2.0 * ratio * omega);
                let exact = by_quadrature(w, c, t);
                let found = Response::new(w, c, t, MOMENTS).moments;
                for (m, (found, exact)) in found.iter().zip(exact).enumerate() {
                    // The recursions lose up to about three digits where they change direction.
                    assert!(
                        (found / exact - 1.0).abs() < 1e-12,
                        "omega t {omega_t}, ratio {ratio}, m {m}: {found} {exact}"
                    );
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
            let once = Response::new(w, c, t, 1);
            let twice = Response::new(w, c, 2.0 * t, 1);
            let q = once.q_from_q * once.q_from_q + once.q_from_v * once.v_from_q;
            let g = once.q_from_q * once.q_from_v + once.q_from_v * once.v_from_v;
            assert!((q - twice.q_from_q).abs() < 1e-14, "{w} {c} {t}");
            assert!((g - twice.q_from_v).abs() < 1e-13 * once.q_from_v.abs(), "{w} {c} {t}");
        }
    }
}
