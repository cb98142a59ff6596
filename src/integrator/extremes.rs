//! Extremes of the contact force inside steps, from the polynomials of the steps.

use crate::electrical::ElectricalContact;
use crate::integrator::course::Places;
use crate::link::{CONTACT, Link, MAX_LINKS};
use crate::math::prediction::{Prediction, value_at};
use crate::model::Model;
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
        Self { least: force, greatest: force }
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

/// Samples of a step in which the least conductance of a pair of contacts is looked for.
const SAMPLES: u32 = 8;

/// Contact and parallel contact, where there are both, and what their spots conduct.
fn pair(model: &Model) -> Option<[(usize, ElectricalContact); 2]> {
    let parallel = model.roles.parallel?;
    let of = |index: usize| Some((index, model.links.get(index)?.electrical?));
    Some([of(CONTACT)?, of(parallel)?])
}

/// What both conduct at these forces of the links (N), S; `None` without a parallel contact.
fn together(model: &Model, force: impl Fn(usize) -> f64) -> Option<f64> {
    let spots = pair(model)?.map(|(index, spot)| spot.spot(force(index)));
    Some(spots.iter().sum())
}

/// Extremes over an interval of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Of the forces of the links.
    forces: [Range; MAX_LINKS],
    /// Greatest indentation of the second contact, m.
    pub nearest: f64,
    /// Least conductance of the spots of contact and parallel contact together, S; 0 without one.
    pub pair: f64,
}

impl Extremes {
    /// Of the present forces (N), and the indentation of the second contact (m).
    pub fn at(model: &Model, forces: [f64; MAX_LINKS], nearest: f64) -> Self {
        Self {
            forces: forces.map(Range::at),
            nearest,
            pair: together(model, |index| forces.get(index).copied().unwrap_or_default()).unwrap_or_default(),
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
        ranges.chain([self.nearest, self.pair])
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
            let force = link.force + value_at(polynomial, y);
            range.add(link.contact().map_or(force, |law| law.without_pull(force)));
        }
    }

    /// Includes the conductance of contact and parallel contact together over a step, or a part of it, with these courses of the
    /// links (N, as deviations) from `from` to `to` (relative to its end, in step lengths); `None` where a link is open.
    pub(crate) fn add_pair<'a>(
        &mut self,
        model: &Model,
        course: impl Fn(usize) -> Option<(&'a Prediction, Places)>,
        (from, to): (f64, f64),
    ) {
        let Some(pair) = pair(model) else { return };
        let courses = pair.map(|(index, spot)| {
            let (polynomial, turns) = course(index)?;
            Some((model.links.get(index)?.force, polynomial, turns, spot))
        });
        let conductance = |y: f64| {
            let of_one = |(force, polynomial, _, spot): &(f64, &Prediction, Places, ElectricalContact)| {
                spot.spot(force + value_at(polynomial, y))
            };
            courses.iter().flatten().map(of_one).sum::<f64>()
        };
        let turns = courses.iter().flatten().flat_map(|(_, _, turns, _)| turns.between(from, to));
        let grid = (0..=SAMPLES).map(|n| from + (to - from) * f64::from(n) / f64::from(SAMPLES));
        let least = grid.chain(turns).map(|y| (y, conductance(y))).min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((mut y, mut least)) = least else { return };
        // Between the samples a parabola, closer with each time; beside an end of the step through samples inside.
        let mut apart = (to - from) / f64::from(SAMPLES);
        for _ in 0..3 {
            let middle = y.max(from + apart).min(to - apart);
            let [before, at, after] = [middle - apart, middle, middle + apart].map(&conductance);
            let bend = before - 2.0 * at + after;
            if bend <= 0.0 {
                break;
            }
            let lower = (middle + 0.5 * apart * (before - after) / bend).max(from).min(to);
            (y, least) = [(y, least), (lower, conductance(lower))]
                .into_iter()
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap_or((y, least));
            apart *= 0.1;
        }
        self.pair = self.pair.min(least);
    }

    /// Includes the conductance of both together at these forces of the links, N.
    pub(crate) fn add_pair_at(&mut self, model: &Model, force: impl Fn(usize) -> f64) {
        if let Some(together) = together(model, force) {
            self.pair = self.pair.min(together);
        }
    }

    /// Includes an indentation of the second contact, m.
    pub(crate) fn approach(&mut self, indentation: f64) {
        self.nearest = self.nearest.max(indentation);
    }
}
