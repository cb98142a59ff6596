//! Event location of interruptions: where the contact force passes that of the threshold resistance within a step. The
//! step goes on.

use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::Trial;
use crate::integrator::course::{Places, turning_points};
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::prediction::value_and_slope;
use crate::math::roots;

impl Integration<'_> {
    /// Where in a step of `length` seconds the force of the closed contact passes that of an interruption; `None` where
    /// the step is too long to tell, unless it `must` be told.
    ///
    /// The force polynomial is monotone between the places where it turns, so that a dip of any length is found. Where it
    /// is not accurate, the law gives the force at the exact motion under it.
    pub(crate) fn passages<const S: usize>(&mut self, trial: &Trial<S>, length: f64, must: bool) -> Option<Places>
    where
        Workspace: Room<S>,
    {
        let mut passages = Places::default();
        let model = self.model;
        let preload = model.preload;
        let Some(criterion) = model.criterion.filter(|_| self.state.closed) else {
            return Some(passages);
        };
        let mut interrupted = self.state.interruptions.in_progress();
        let excess = |force: f64| preload.force + force - criterion.force;
        let (start, simd) = (self.state.force - preload.force, self.model.simd);
        let ahead = |force: f64| if interrupted { -excess(force) } else { excess(force) };
        if !Collocation::comes_near_zero(ahead(start), &trial.forces.map(ahead)) {
            return Some(passages);
        }
        let polynomial = self.collocation::<S>().through(simd, start, &trial.forces);
        let value = |y: f64| excess(value_and_slope(&polynomial, y).0);
        let turns = turning_points(&polynomial);
        let inaccuracy = self.inaccuracy(trial, length);
        let is_accurate = inaccuracy <= 1.0;
        let unsure = inaccuracy * self.tolerance;
        if !is_accurate && !must && turns.iter().any(|y| value(y).abs() < unsure) {
            return None;
        }
        let end = model.law.without_pull(preload.force + trial.force) < criterion.force;
        let mut before = (-1.0, value(-1.0));
        for (y, is_end) in turns.iter().map(|y| (y, false)).chain([(0.0, true)]) {
            let now = (y, value(y));
            let below = if is_end { end } else { now.1 < 0.0 };
            if below != interrupted {
                let place = if is_accurate {
                    // Only rounding leaves both on one side.
                    let on_this_side = if (before.1 < 0.0) == below { before.0 } else { y };
                    roots::between(value, before, now, 1e-12).unwrap_or(on_this_side)
                } else {
                    let force = |d, rate| excess(model.law.force(preload.indentation + d, rate) - preload.force);
                    let from = ((1.0 + before.0) * length, before.1);
                    let found = self.instant(trial, length, force, from, (1.0 + y) * length, 1e-2 * self.allowed);
                    found.at / length - 1.0
                };
                passages.push(place.clamp(before.0, y));
                interrupted = below;
            }
            before = now;
        }
        Some(passages)
    }

    /// Records the present contact force in the extremes, and an interruption that begins or ends with it.
    pub(crate) fn note_force(&mut self) {
        if let Some(extremes) = &mut self.extremes {
            extremes.of(self.state.mirrored).add(self.state.force);
        }
        let Some(criterion) = self.model.criterion.as_ref() else {
            return;
        };
        let state = &mut *self.state;
        if (state.force < criterion.force) != state.interruptions.in_progress() {
            state.interruptions.turn(criterion, state.time);
        }
    }
}
