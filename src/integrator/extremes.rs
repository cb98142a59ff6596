//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::integrator::course::Places;
use crate::link::{Link, MAX_LINKS};
use crate::math::prediction::{Prediction, value_and_slope};
use serde::{Deserialize, Serialize};

/// Least and greatest force of a contact, N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// The least, N.
    pub least: f64,
    /// The greatest, N.
    pub greatest: f64,
}

impl Range {
    fn at(force: f64) -> Self {
        Self {
            least: force,
            greatest: force,
        }
    }

    /// Includes a force (N).
    pub fn add(&mut self, force: f64) {
        // `min` and `max` would hide NaN.
        if force < self.least || force.is_nan() {
            self.least = force;
        }
        if force > self.greatest || force.is_nan() {
            self.greatest = force;
        }
    }
}

/// Extremes over an interval of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Of the forces of the links.
    forces: [Range; MAX_LINKS],
    /// Greatest indentation of the second contact, m.
    pub nearest: f64,
}

impl Extremes {
    /// Of the present forces (N), and the indentation of the second contact (m).
    pub fn at(forces: [f64; MAX_LINKS], nearest: f64) -> Self {
        Self {
            forces: forces.map(Range::at),
            nearest,
        }
    }

    /// Those of the force of a link.
    #[expect(clippy::indexing_slicing, reason = "the remainder is in range")]
    pub fn of(&mut self, index: usize) -> &mut Range {
        &mut self.forces[index % MAX_LINKS]
    }

    /// All of them.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let ranges = self.forces.iter().flat_map(|range| [range.least, range.greatest]);
        ranges.chain([self.nearest])
    }

    /// Includes the force of a link over a step in which it is closed, from `from`, where it is included already, to `to`
    /// (relative to its end, in step lengths): of its polynomial, which turns at these places.
    pub(crate) fn add_course(
        &mut self,
        link: &Link,
        index: usize,
        (polynomial, turns): (&Prediction, &Places),
        from: f64,
        to: f64,
    ) {
        let range = self.of(index);
        for y in turns.between(from, to).chain([to]) {
            let force = link.force + value_and_slope(polynomial, y).0;
            range.add(link.contact().map_or(force, |law| law.without_pull(force)));
        }
    }

    /// Includes an indentation of the second contact, m.
    pub(crate) fn approach(&mut self, indentation: f64) {
        self.nearest = self.nearest.max(indentation);
    }
}
