//! Event location of interruptions: where the contact force crosses that of the threshold resistance within a step.

use crate::chatter::Criterion;
use crate::error::StepError;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::PLACES;
use crate::integrator::events::Cut;
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::{self, SHORT};
use crate::math::roots;

impl Integration<'_> {
    /// Where in a step of the closed contact the force first crosses the threshold, 0 to 1; `None` if it does not.
    pub(crate) fn first_passage<const S: usize>(&mut self, trial: &Trial<S>) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let criterion = self.model.criterion?;
        if !self.state.closed {
            return None;
        }
        let excess = trial.forces.map(|force| self.excess(&criterion, force));
        let start = self.excess(&criterion, self.state.force - self.model.preload.force);
        if !Collocation::comes_near_zero(start, &excess) {
            return None;
        }
        self.collocation::<S>().first_dip(&excess, f64::INFINITY)
    }

    /// Distance of a force (deviation from the preload force) from the threshold, positive on the side of before, N.
    fn excess(&self, criterion: &Criterion, force: f64) -> f64 {
        let above = self.model.preload.force + force - criterion.force;
        if self.state.interruptions.in_progress() {
            -above
        } else {
            above
        }
    }

    /// [`Integration::excess`] after a probe step of `length` seconds, N.
    fn excess_after<const S: usize>(&mut self, criterion: &Criterion, length: f64) -> f64
    where
        Workspace: Room<S>,
    {
        let trial = self.probe::<S>(length);
        trial.map_or(f64::NAN, |trial| self.excess(criterion, nodal::end(&trial.forces)))
    }

    /// Ends the step at the crossing found at or before the part `passed` of it; `None` if the step need not be
    /// shortened.
    pub(crate) fn stop_at_threshold<const S: usize>(
        &mut self,
        passed: f64,
        target: &Target,
        growth: f64,
        requested: f64,
    ) -> Result<Option<StepOutcome>, StepError>
    where
        Workspace: Room<S>,
    {
        let model = self.model;
        let Some(criterion) = &model.criterion else {
            return Ok(None);
        };
        let latest = passed * target.length;
        if S != SHORT {
            // Events are located in 4-node steps; 8-node steps end before them.
            return Ok(Some(self.reject(0.9 * latest)));
        }
        let cut_at = |length| Cut {
            length,
            switches: false,
            mirrors: false,
        };
        let end = self.excess_after::<S>(criterion, latest);
        if end > 0.0 {
            // The polynomial crosses, the force does not: the next step starts here.
            return (latest < target.length)
                .then(|| self.end_at::<S>(&cut_at(latest), growth, requested))
                .transpose();
        }
        let start = self.excess(criterion, self.state.force - model.preload.force);
        let resolution = self.resolution();
        // Where an interruption has just begun or ended, rounding may put the force on the wrong side: start from a
        // sample clearly on the right side.
        let clear = if start > 0.0 {
            Some((0.0, start))
        } else {
            (1..PLACES).find_map(|k| {
                let at = latest * f64::from(k) / f64::from(PLACES);
                let excess = self.excess_after::<S>(criterion, at);
                (excess > 0.0).then_some((at, excess))
            })
        };
        let length = clear.and_then(|clear| {
            let excess = |at| self.excess_after::<S>(criterion, at);
            roots::between(excess, clear, (latest, end), resolution)
        });
        let length = match length {
            Some(length) if length > resolution => length,
            _ if self.state.interruptions.turned_at(self.state.time) && start <= 0.0 => {
                // On the new side for less than the resolution of time: the force has crossed back by the end of this
                // piece.
                return self.end_at::<S>(&cut_at(latest), growth, requested).map(Some);
            }
            _ => {
                // The crossing is at the start of the step.
                self.state.interruptions.turn(criterion, self.state.time);
                return Ok(Some(self.reject(target.length)));
            }
        };
        let outcome = self.end_at::<S>(&cut_at(length), growth, requested)?;
        if outcome.taken {
            self.state.interruptions.turn(criterion, self.state.time);
        }
        Ok(Some(outcome))
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
        if !state.interruptions.turned_at(state.time)
            && (state.force < criterion.force) != state.interruptions.in_progress()
        {
            state.interruptions.turn(criterion, state.time);
        }
    }
}
