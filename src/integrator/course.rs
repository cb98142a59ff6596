//! The course of the contact force inside a step, from its polynomial: where it turns, and where it crosses a level.

use std::array;

use crate::integrator::constants::PIECES;
use crate::math::nodal::LONG;
use crate::math::prediction::{Prediction, derivative, value_and_slope, value_at, values_and_slopes};
use crate::math::roots;
use crate::math::simd::{Simd, compiled_for};
use serde::{Deserialize, Serialize};

/// Places in a step, relative to its end in step lengths, ascending; as many as a polynomial of its degree has roots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Places {
    list: [f64; LONG],
    count: u8,
}

impl Places {
    /// Adds a place after the others; no more than there is room for.
    pub(crate) fn push(&mut self, place: f64) {
        if let Some(entry) = self.list.get_mut(usize::from(self.count)) {
            *entry = place;
            self.count += 1;
        }
    }

    /// One after the other.
    pub(crate) fn iter(&self) -> impl Iterator<Item = f64> {
        self.list.iter().take(self.count.into()).copied()
    }

    /// Those up to a place.
    pub(crate) fn until(&self, to: f64) -> impl Iterator<Item = f64> {
        self.iter().take_while(move |place| *place <= to)
    }

    /// Those after a place up to another.
    pub(crate) fn between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        self.until(to).filter(move |place| from < *place)
    }

    /// Whether they are in the step and in order (check of a deserialised state).
    pub(crate) fn is_sound(&self) -> bool {
        let Self { list, count } = self;
        list.iter().all(|place| (-1.0..=0.0).contains(place))
            && usize::from(*count) <= LONG
            && list.iter().take((*count).into()).is_sorted()
    }
}

/// Where a polynomial over a step turns.
pub(crate) fn turning_points(simd: Simd, polynomial: &Prediction) -> Places {
    turning_points_between(simd, polynomial, -1.0, 0.0)
}

/// Where it turns between two places.
pub(crate) fn turning_points_between(simd: Simd, polynomial: &Prediction, from: f64, to: f64) -> Places {
    if is_monotone(polynomial) {
        return Places::default();
    }
    let rate = derivative(polynomial);
    let bend = |y: f64| value_and_slope(&rate, y).1;
    let piece = (to - from) / PIECES as f64;
    let ends: [f64; PIECES + 1] = array::from_fn(|i| if i < PIECES { from + piece * i as f64 } else { to });
    let (slopes, bends) = compiled_for!(simd, A => values_and_slopes::<{ PIECES + 1 }, A>(&rate, &ends));
    let mut places = Places::default();
    let mut pass = |(a, from): (f64, f64), (b, to): (f64, f64)| {
        if (from > 0.0) != (to > 0.0) {
            places.push(roots::newton(|y| value_and_slope(&rate, y), (a, from), (b, to), 1e-9));
        }
    };
    for (((a, b), (first, last)), (falls, rises)) in pairs(&ends).zip(pairs(&slopes)).zip(pairs(&bends)) {
        // Slopes of one sign that first fall towards zero, then rise, may have passed it twice.
        let dips = (first > 0.0) == (last > 0.0) && first * falls < 0.0 && last * rises > 0.0;
        let least = dips.then(|| roots::between(bend, (a, falls), (b, rises), 1e-9));
        let middle = least.flatten().map_or((a, first), |y| (y, value_at(&rate, y)));
        pass((a, first), middle);
        pass(middle, (b, last));
    }
    places
}

/// Each value with the next.
fn pairs(values: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    values.iter().copied().zip(values.iter().skip(1).copied())
}

/// Whether a polynomial over a step rises or falls throughout, as its steepest terms show.
fn is_monotone(polynomial: &Prediction) -> bool {
    let [_, slope, bends @ ..] = polynomial;
    let most = bends.iter().zip(2_u8..).fold(0.0, |most, (bend, power)| most + f64::from(power) * bend.abs());
    // Beyond what rounding makes of the sum.
    slope.abs() > 1.001 * most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_points_that_lie_side_by_side_are_found() {
        for (a, b) in [(-0.9, 0.3), (0.05, 0.2), (0.1, 0.101), (-0.7, -0.6)] {
            // (z - a) (z - b) is its slope.
            let polynomial = [0.0, a * b, -0.5 * (a + b), 1.0 / 3.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            let found: Vec<f64> = turning_points(Simd::Portable, &polynomial).iter().map(|y| 2.0 * y + 1.0).collect();
            let near = |(found, expected): (&f64, f64)| (found - expected).abs() < 1e-8;
            assert!(found.len() == 2 && found.iter().zip([a, b]).all(near), "{found:?}, not {a} and {b}");
        }
    }
}
