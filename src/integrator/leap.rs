//! After a closing: leaps, first steps by the root of the time since, and how far polynomials of time follow it.

use crate::error::StepError;
use crate::integrator::collocation::polynomial::{LONG_BY_ROOT, LONG_BY_TIME};
use crate::integrator::collocation::trial::Trial;
use crate::integrator::constants::{LONGER, MISSED_ROOT, STEP_GROWTH, WORTH};
use crate::integrator::grid::{Target, round_down};
use crate::integrator::step_length::{StepOutcome, growth, shrinkage};
use crate::integrator::stepper::Stepper;
use crate::math::nodal::LONG;
use crate::math::prediction::parabola_in_time;
use crate::state::{LinkState, State};

impl Stepper<'_> {
    /// The length of a leap from here, s: where a contact has just closed, and nothing that is known ends it.
    pub(super) fn leap_length(&mut self) -> Option<f64> {
        let longest = self.workspace.longest_leap?;
        let State { time, links, lengths, .. } = &mut *self.state;
        let has_closed = links.iter().any(|at| at.closed && at.last_closing == Some(*time));
        if !has_closed || self.progress.conserves {
            return None;
        }
        let least = LONGER * lengths.short;
        if lengths.leap < least {
            // The next closing may be gentler.
            lengths.leap *= 2.0;
            return None;
        }
        let corner = self.model.generator.next_break(*time).unwrap_or(f64::INFINITY);
        let remaining = self.recorder.read.unwrap_or(self.grid.end()) - *time;
        let possible = longest.min(self.model.longest_step(*time)).min(remaining);
        let length = round_down(lengths.leap.min(possible));
        (length >= least && *time + length < corner).then_some(length)
    }

    /// Length of a step with many nodes whose polynomials follow the force of a contact, which goes as the root of the time since it
    /// closed, s.
    pub(super) fn smooth(&self) -> f64 {
        let Some(closing) = self.state.last_closing() else { return f64::INFINITY };
        let links = self.model.links.iter().zip(&self.state.links);
        let closed = links.filter(|(link, at)| at.closed && link.contact().is_some());
        let force = closed.fold(0.0, |most, (_, at)| at.force.max(most));
        (self.state.time - closing) * reach(force / self.model.tolerance.force)
    }

    /// One step over `length` (s) after a closing, by the root of the time since: accepted, or to be tried again with another length.
    pub(super) fn leap(&mut self, length: f64) -> Result<(), StepError> {
        let target = Target { recurring: true, ..self.grid.cut(length, self.state.time + length) };
        self.workspace.long.cache.collocation = &LONG_BY_ROOT;
        let done = self.with_trial(|stepper, trial| stepper.try_leap(trial, &target));
        self.workspace.long.cache.collocation = &LONG_BY_TIME;
        done
    }

    fn try_leap(&mut self, trial: &mut Trial<LONG>, target: &Target) -> Result<(), StepError> {
        let length = target.length;
        let [ratio, _] = self.judge(trial, target);
        let count = self.model.links.len();
        let mut locator = self.locator(trial, length);
        let state = locator.whole.state;
        let stays = |(index, at): (usize, &LinkState)| {
            if at.closed {
                locator.first_open(index).is_none()
            } else {
                locator.near(index).is_none() && locator.gap(index).is_none()
            }
        };
        let is_possible = ratio <= 1.0 && state.links.iter().take(count).enumerate().all(stays);
        if !is_possible || !self.commit(trial, target, false)? {
            self.state.rejected_steps += 1;
            self.state.lengths.leap = length * shrinkage::<LONG>(ratio.max(1.0));
            return Ok(());
        }
        for at in &mut self.state.links {
            at.course = parabola_in_time(&at.course);
        }
        // Nor does a short step reach as far as a long one.
        let short = self.smooth() / WORTH;
        let lengths = &mut self.state.lengths;
        lengths.leap = StepOutcome::accepted(length, lengths.leap, (growth::<LONG>(ratio), STEP_GROWTH)).length;
        lengths.short = short;
        Ok(())
    }
}

/// The longest step with many nodes, in times since a closing, whose polynomials follow a force that goes as the root of that time.
/// The `accuracy` is the part of the force that they may miss at the start of the step, inverted. At the most [`WORTH`].
fn reach(accuracy: f64) -> f64 {
    // The eighth root, as there are eight nodes.
    let ellipse = (MISSED_ROOT * accuracy).sqrt().sqrt().sqrt().max(1.0);
    (4.0 * ellipse / (ellipse - 1.0).powi(2)).min(WORTH)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::nodal::dot;
    use crate::math::simd::Separate;

    #[test]
    fn long_steps_after_a_closing_miss_as_much_of_a_root_as_they_may() {
        for exponent in 3..12 {
            let accuracy = 10_f64.powi(exponent);
            let length = reach(accuracy);
            let root = LONG_BY_TIME.nodes.map(|x| (1.0 + length * x).sqrt());
            let missed = (1.0 - dot::<LONG, Separate>(&root, &LONG_BY_TIME.at_start)).abs();
            // The polynomials miss 0.14 to 0.22 of the power of the ellipse.
            assert!(missed * accuracy <= 1.1, "{accuracy:e}: {length} misses {missed:e}");
            assert!(length == WORTH || missed * accuracy > 0.7, "{accuracy:e}: {length} misses {missed:e}");
        }
    }
}
