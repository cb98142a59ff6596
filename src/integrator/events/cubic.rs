//! The Hermite cubic through two samples of a motion.

use crate::integrator::collocation::part::Instant;

/// The cubic through two samples, the earlier first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cubic {
    pub(crate) a: Instant,
    pub(crate) b: Instant,
}

impl Cubic {
    /// Its length, s.
    pub(super) fn length(&self) -> f64 {
        self.b.at - self.a.at
    }

    /// Displacement (m) and velocity (m/s) at an instant (s).
    pub(crate) fn at(&self, at: f64) -> Instant {
        let Self { a, b } = self;
        let h = self.length();
        let x = (at - a.at) / h;
        let y = 1.0 - x;
        let d = a.d * (y * y * (1.0 + 2.0 * x))
            + b.d * (x * x * (1.0 + 2.0 * y))
            + h * (a.rate * (x * y * y) - b.rate * (x * x * y));
        let rate = 6.0 * (b.d - a.d) / h * (x * y) + a.rate * y * (1.0 - 3.0 * x) + b.rate * x * (1.0 - 3.0 * y);
        Instant { at, d, rate }
    }

    /// The greatest displacement, m.
    pub(super) fn highest(&self) -> f64 {
        let Self { a, b } = self;
        let h = self.length();
        let ends = a.d.max(b.d);
        // Slope of the cubic: h d' = p x^2 + q x + r.
        let rise = b.d - a.d;
        let p = 3.0 * (h * (a.rate + b.rate) - 2.0 * rise);
        let q = 6.0 * rise - 2.0 * h * (2.0 * a.rate + b.rate);
        let r = h * a.rate;
        let root = (q * q - 4.0 * p * r).max(0.0).sqrt();
        let larger = -0.5 * (q + root.copysign(q));
        [larger / p, r / larger]
            .into_iter()
            .filter(|x| 0.0 < *x && *x < 1.0)
            .fold(ends, |high, x| high.max(self.at(a.at + x * h).d))
    }

    /// The least displacement, m.
    pub(super) fn lowest(&self) -> f64 {
        let mirrored = |sample: Instant| Instant { d: -sample.d, rate: -sample.rate, ..sample };
        let Self { a, b } = *self;
        let (a, b) = (mirrored(a), mirrored(b));
        -Self { a, b }.highest()
    }

    /// Least and greatest rate (m/s) of the displacement plus `time` (s) times its velocity.
    pub(super) fn rates(&self, time: f64) -> (f64, f64) {
        let Self { a, b } = self;
        let h = self.length();
        let mean = (b.d - a.d) / h;
        let first = a.rate + time * (6.0 * mean - 4.0 * a.rate - 2.0 * b.rate) / h;
        let last = b.rate + time * (2.0 * a.rate + 4.0 * b.rate - 6.0 * mean) / h;
        let middle = 1.5 * mean - 0.25 * (a.rate + b.rate) + time * (b.rate - a.rate) / h;
        // A parabola through the three.
        let (rise, bend) = (4.0 * middle - 3.0 * first - last, 2.0 * (first - 2.0 * middle + last));
        let place = -0.5 * rise / bend;
        let vertex = if 0.0 < place && place < 1.0 { first + 0.5 * rise * place } else { first };
        (first.min(last).min(vertex), first.max(last).max(vertex))
    }

    /// How far the displacement plus `time` (s) times the velocity of a motion rises above that of the first sample at most, m; the cubic
    /// differs from the motion by `error` in its middle, of which `rounding` is none of the motion's.
    pub(super) fn rise(&self, time: f64, error: f64, rounding: f64) -> f64 {
        let Self { a, b } = self;
        let (h, steeper) = (self.length(), b.rate - a.rate);
        let beyond = |error: f64| (error.abs() - rounding).max(0.0) / h;
        // Along a straight line to the other sample. Displacement and velocity bend away from theirs by an eighth of what the slope
        // changes by, and by half again the difference of mean velocities; the velocity of a cubic is wrong by four times its error.
        let straight = (b.d - a.d + time * steeper).max(0.0);
        let bent = 1.5 * beyond(b.d - a.d - 0.5 * h * (a.rate + b.rate));
        straight + 0.125 * h * steeper.abs() + h * bent + error + time * (bent + 4.0 * beyond(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_polynomial_it_was_taken_from() {
        // d = t^3 - 2 t^2 + 0.5 t - 0.1, from 0.2 to 1.7.
        let of = |at: f64| Instant { at, d: ((at - 2.0) * at + 0.5) * at - 0.1, rate: (3.0 * at - 4.0) * at + 0.5 };
        let cubic = Cubic { a: of(0.2), b: of(1.7) };
        let (mut highest, mut lowest) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..=3000 {
            let at = 0.2 + 5e-4 * f64::from(k);
            let (exact, found) = (of(at), cubic.at(at));
            assert!((found.d - exact.d).abs() < 1e-14 && (found.rate - exact.rate).abs() < 1e-13, "{at}");
            (highest, lowest) = (highest.max(exact.d), lowest.min(exact.d));
            let rate = exact.rate + 0.3 * (6.0 * at - 4.0);
            (least, greatest) = (least.min(rate), greatest.max(rate));
        }
        // The samples miss an extreme by half their distance at most: its square times half the curvature.
        let near = |found: f64, sampled: f64| (found - sampled).abs() < 1e-6;
        assert!(near(cubic.highest(), highest) && near(cubic.lowest(), lowest));
        let rates = cubic.rates(0.3);
        assert!(near(rates.0, least) && near(rates.1, greatest), "{rates:?} {least} {greatest}");
    }

    /// A motion of two frequencies, over intervals of which the cubic misses up to a third of what it changes by.
    #[test]
    fn a_motion_rises_no_more_than_its_cubic_tells() {
        let of =
            |at: f64| Instant { at, d: at.sin() + 0.1 * (5.0 * at).cos(), rate: at.cos() - 0.5 * (5.0 * at).sin() };
        for (k, length) in (0..40).flat_map(|k| [1e-3, 0.03, 0.3, 0.6].map(|length| (0.17 * f64::from(k), length))) {
            let cubic = Cubic { a: of(k), b: of(k + length) };
            let middle = of(k + 0.5 * length);
            let error = (middle.d - cubic.at(middle.at).d).abs();
            for time in [0.0, 0.1, 3.0] {
                let rise = |at: &f64| of(*at).d - of(k).d + time * (of(*at).rate - of(k).rate);
                let most = (0..=100).map(|n| rise(&(k + length * 0.01 * f64::from(n)))).fold(0.0, f64::max);
                let told = cubic.rise(time, error, 0.0);
                assert!(most <= told + 1e-15, "{k} {length} {time}: {most} {told}");
            }
        }
    }

    /// The damper of a pusher lets go as the motion turns: over so short a time rounding is larger than all else.
    #[test]
    fn rounding_is_no_rise() {
        let (time, rounding) = (1.8e-5, 3e-19);
        for length in [1e-9, 1e-11, 1e-14] {
            let of = |at: f64, wrong| Instant {
                at,
                d: 2.66e-7 - 0.166 * at + 0.5 * 9e3 * at * at + wrong,
                rate: -0.166 + 9e3 * at,
            };
            let cubic = Cubic { a: of(0.0, 0.0), b: of(length, 0.5 * rounding) };
            let rise = cubic.rise(time, rounding, rounding);
            assert!(rise < 2.0 * rounding + 9e3 * length * length, "{length}: {rise}");
        }
    }
}
