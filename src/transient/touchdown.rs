//! The contact closes: the first instant within a step of free flight at which the force leaves zero.
//!
//! Looking at signs alone would miss a grazing touch. Between neighbouring instants at which indentation and velocity are
//! known, the indentation is a cubic but for an error that the middle one of any three shows. Where the cubic's highest
//! point clears zero by more than that error there is no touch; elsewhere the interval is halved.

use crate::model::Model;

/// Indentation d and its velocity at an instant of the step, in seconds from its start.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// s.
    pub at: f64,
    /// m.
    pub d: f64,
    /// m/s.
    pub rate: f64,
}

impl Model {
    /// The first instant (s from the start of the step) at which the contact closes, given samples in order of time that
    /// cover the step. `sample` evaluates the flight; `negligible` is the overlap that makes no force (m).
    pub fn first_touch(
        &self,
        samples: &[Sample],
        negligible: f64,
        sample: &mut impl FnMut(f64) -> Sample,
    ) -> Option<f64> {
        let error = samples
            .windows(3)
            .filter_map(|triple| match triple {
                [a, b, c] => Some((b.d - cubic(a, c, b.at)).abs()),
                _ => None,
            })
            .fold(0.0, f64::max);
        samples.windows(2).find_map(|pair| match pair {
            [a, b] => self.touch_between(a, b, error, negligible, sample, 0),
            _ => None,
        })
    }

    fn touch_between(
        &self,
        a: &Sample,
        b: &Sample,
        error: f64,
        negligible: f64,
        sample: &mut impl FnMut(f64) -> Sample,
        depth: u32,
    ) -> Option<f64> {
        let open = |s: &Sample| s.d <= 0.0 || self.hertz.engagement(s.d, s.rate) <= 0.0;
        if !open(b) {
            // One touch, or several of which the first is wanted: halve until the interval holds a plain crossing.
            let plain = a.d > 0.0 || (highest(a, b) <= b.d && a.rate >= 0.0) || depth > 40;
            if plain {
                return Some(self.crossing(a, b, sample));
            }
        } else if highest(a, b) + error < -negligible || (a.d > 0.0 && highest(a, b) <= a.d.max(b.d)) || depth > 40 {
            return None;
        }
        let middle = sample(f64::midpoint(a.at, b.at));
        let error = (middle.d - cubic(a, b, middle.at)).abs();
        self.touch_between(a, &middle, error, negligible, sample, depth + 1)
            .or_else(|| self.touch_between(&middle, b, error, negligible, sample, depth + 1))
    }

    /// The crossing between an open and a closed sample.
    fn crossing(&self, a: &Sample, b: &Sample, sample: &mut impl FnMut(f64) -> Sample) -> f64 {
        let value = |s: Sample| s.d.min(self.hertz.engagement(s.d, s.rate));
        let mut f = |at: f64| {
            if at == a.at {
                // The start of the flight lies on the release itself; rounding must not make it look closed.
                value(*a).min(-f64::MIN_POSITIVE)
            } else {
                value(sample(at))
            }
        };
        crate::math::roots::bracketed(&mut f, a.at, b.at).unwrap_or(b.at)
    }
}

/// The cubic through two samples and their velocities, at an instant.
fn cubic(a: &Sample, b: &Sample, at: f64) -> f64 {
    let h = b.at - a.at;
    let x = (at - a.at) / h;
    let y = 1.0 - x;
    a.d * (y * y * (1.0 + 2.0 * x))
        + b.d * (x * x * (1.0 + 2.0 * y))
        + h * (a.rate * (x * y * y) - b.rate * (x * x * y))
}

/// Highest value of the cubic between the two samples.
fn highest(a: &Sample, b: &Sample) -> f64 {
    let h = b.at - a.at;
    let ends = a.d.max(b.d);
    // Slope of the cubic, h w' = p x^2 + q x + r.
    let rise = b.d - a.d;
    let p = 3.0 * (h * (a.rate + b.rate) - 2.0 * rise);
    let q = 6.0 * rise - 2.0 * h * (2.0 * a.rate + b.rate);
    let r = h * a.rate;
    let root = (q * q - 4.0 * p * r).max(0.0).sqrt();
    let larger = -0.5 * (q + root.copysign(q));
    [larger / p, r / larger]
        .into_iter()
        .filter(|x| 0.0 < *x && *x < 1.0)
        .fold(ends, |high, x| high.max(cubic(a, b, x.mul_add(h, a.at))))
}
