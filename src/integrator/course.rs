//! The course of the contact force inside a step, from its polynomial: where it turns, and where it crosses a level.

use crate::integrator::constants::PIECES;
use crate::math::nodal::LONG;
use crate::math::prediction::{Prediction, derivative, value_and_slope};
use crate::math::roots;
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
pub(crate) fn turning_points(polynomial: &Prediction) -> Places {
    turning_points_between(polynomial, -1.0, 0.0)
}

/// Where it turns between two places.
pub(crate) fn turning_points_between(polynomial: &Prediction, from: f64, to: f64) -> Places {
    if is_monotone(polynomial) {
        return Places::default();
    }
    let rate = derivative(polynomial);
    let slope = |y: f64| value_and_slope(&rate, y).0;
    let bend = |y: f64| value_and_slope(&rate, y).1;
    // Place, slope and bend.
    let look = |y: f64| {
        let (slope, bend) = value_and_slope(&rate, y);
        (y, slope, bend)
    };
    let mut places = Places::default();
    let mut pass = |(a, from, _): (f64, f64, f64), (b, to, _): (f64, f64, f64)| {
        if (from > 0.0) != (to > 0.0)
            && let Some(y) = roots::between(slope, (a, from), (b, to), 1e-9)
        {
            places.push(y);
        }
    };
    let mut before = look(from);
    while before.0 < to {
        let now = look((before.0 + 1.0 / f64::from(PIECES)).min(to));
        let ((a, first, falls), (b, last, rises)) = (before, now);
        // Slopes of one sign that first fall towards zero, then rise, may have passed it twice.
        let dips = (first > 0.0) == (last > 0.0) && first * falls < 0.0 && last * rises > 0.0;
        let least = dips.then(|| roots::between(bend, (a, falls), (b, rises), 1e-9));
        let middle = least.flatten().map_or(before, look);
        pass(before, middle);
        pass(middle, now);
        before = now;
    }
    places
}

/// Whether a polynomial over a step rises or falls throughout, as its steepest terms show.
fn is_monotone(polynomial: &Prediction) -> bool {
    let [_, slope, bends @ ..] = polynomial;
    let most = bends
        .iter()
        .zip(2_u8..)
        .fold(0.0, |most, (bend, power)| most + f64::from(power) * bend.abs());
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
            let found: Vec<f64> = turning_points(&polynomial).iter().map(|y| 2.0 * y + 1.0).collect();
            let near = |(found, expected): (&f64, f64)| (found - expected).abs() < 1e-8;
            assert!(
                found.len() == 2 && found.iter().zip([a, b]).all(near),
                "{found:?}, not {a} and {b}"
            );
        }
    }
}
