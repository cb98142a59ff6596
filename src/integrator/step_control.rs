//! Step size control: a communication step as a sequence of integration steps with 4 or 8 nodes.

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::friction::Phase;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::{
    AFTER_REJECTION, AGAIN, COARSEST, GROWING, LEAST_SHRINK, LONGER, LOOSEST, MOST_SHRINK, REFUSALS, SAFETY, SHARE,
    SMOOTH, STEP_GROWTH, WORTH,
};
use crate::integrator::energy::conservation::conserves;
use crate::integrator::events::Cut;
use crate::integrator::exact_step;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::{Grid, Target};
use crate::integrator::integration::{Integration, StepOutcome, Steps, resolution};
use crate::integrator::rest::rests_until;
use crate::integrator::step_length::{growth, shrinkage};
use crate::integrator::with_contact;
use crate::integrator::workspace::{Budget, Room, Workspace};
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::state::State;

/// Limit of the velocity of the fixed contact, m/s.
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Advances the state.
///
/// # Errors
/// A [`StepError`]; the state is then undefined.
pub(crate) fn advance(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: Drive,
    steps: Steps,
    extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    let (model, other) = model.views(state);
    let drive = drive.seen(state);
    let tolerance = model.tolerance().min(LOOSEST * model.force_scale());
    let (grid, dense, driven) = match steps {
        Steps::Exactly { time, size, news } => {
            exact_step::leave_before_rest(model, state, &drive, tolerance);
            state.time = rests_until(model, state, &drive, tolerance, time + size).unwrap_or(time);
            let remaining = size - (state.time - time);
            if remaining <= 0.0 {
                return Ok(());
            }
            check_spacing(model, state.time, remaining)?;
            if exact_step::step_exactly(model, state, workspace, &drive, remaining) {
                return Ok(());
            }
            let grid = Grid {
                recurs: !(news.inputs && news.length),
                ..Grid::over(state.time, remaining)
            };
            // A blow would make more of an error than it is here.
            let never_opened = state.closed && !state.has_switched();
            (grid, None, news.inputs && never_opened)
        }
        Steps::Own { until, dense } => {
            let size = state.short_step.max(state.long_step);
            check_spacing(model, state.time, size)?;
            if exact_step::step_ahead(model, state, workspace, &drive, (until, &mut *dense)) {
                return Ok(());
            }
            (Grid::free(state.time, size), Some((until, dense)), false)
        }
    };
    with_contact::leave(model, state);
    let conserves = conserves(model, &drive);
    Integration {
        model,
        other,
        state,
        budget: Budget::new(workspace),
        workspace,
        drive,
        grid,
        dense,
        extremes,
        tolerance,
        allowed: SHARE * tolerance,
        refusals: 0,
        before_event: false,
        changes: 0,
        // Without any damping errors add up over the more steps that this takes.
        driven: driven && !conserves,
        conserves,
    }
    .run()
}

/// Checks that floating-point numbers of time lie close enough for the motion from `time` (s) over `size` (s).
///
/// # Errors
/// [`StepErrorCause::Resolution`] if they do not.
fn check_spacing(model: &Model, time: f64, size: f64) -> Result<(), StepError> {
    let allowed = COARSEST * model.first_step(time);
    let spacing = resolution(time, size);
    let cause = StepErrorCause::Resolution { spacing, allowed };
    let fits = spacing <= allowed;
    fits.then_some(()).ok_or(StepError { time, cause })
}

impl Integration<'_> {
    fn run(&mut self) -> Result<(), StepError> {
        if self.drive.support_rate.abs() > SPEED_OF_LIGHT {
            return Err(self.error(StepErrorCause::Speed(self.drive.support_rate)));
        }
        self.set_support_rate();
        self.note_force();
        let steps = self.state.steps;
        let mut first = None;
        while self.grid.done < 1.0 {
            let before = self.state.time;
            self.advance()?;
            // What a search that gave up has not found is not passed over.
            self.budget.check(self.workspace, before)?;
            if self.driven && first.is_none() && self.state.steps > steps {
                first = Some((self.state.short_step, self.state.long_step));
            }
            self.note_force();
            let Grid { free, done, .. } = self.grid;
            let end = self.grid.end();
            if !free
                && done < 1.0
                && let Some(until) = rests_until(self.model, self.state, &self.drive, self.tolerance, end)
            {
                let target = self.grid.cut(until - self.state.time, until);
                (self.state.time, self.grid.done) = (target.time, target.done);
            }
        }
        if let Some((short_step, long_step)) = first {
            // The next change will need steps as short as this one.
            self.state.short_step = self.state.short_step.min(short_step);
            self.state.long_step = self.state.long_step.min(long_step);
        }
        Ok(())
    }

    /// One integration step, accepted or rejected: with 4 nodes where they suffice, else with 8.
    fn advance(&mut self) -> Result<(), StepError> {
        let remaining = self.grid.remaining();
        let short_step = self.state.short_step;
        let closed = self.state.closed;
        // Just after an impact the force is not smooth enough for polynomials of high degree; in flight it is known.
        let long_step = if !closed {
            self.state.flight_step
        } else if let Some(closing) = self.state.last_closing {
            self.state.long_step.min(SMOOTH * (self.state.time - closing))
        } else {
            self.state.long_step
        };
        if remaining <= short_step || closed && long_step < WORTH * short_step {
            let outcome = self.advance_with::<SHORT>(short_step)?;
            if !outcome.switched {
                self.state.short_step = outcome.length;
                if outcome.taken && outcome.growth < GROWING {
                    self.state.long_step = self.state.long_step.max(2.0 * WORTH * outcome.length);
                }
            }
        } else {
            let outcome = self.advance_with::<LONG>(long_step)?;
            if closed {
                self.state.long_step = outcome.length;
                if !outcome.taken && self.state.last_closing.is_some() {
                    // Nor would a short one reach as far.
                    self.state.short_step = short_step.min(outcome.length / WORTH);
                }
            } else {
                self.state.flight_step = outcome.length;
            }
            // A long step cut far below its possible size: a short one will do next time.
            if outcome.taken && !outcome.switched {
                let again = if self.driven { AGAIN } else { 1.0 };
                self.state.short_step = (again * short_step).max(outcome.growth * remaining.min(long_step) / LONGER);
            }
        }
        Ok(())
    }

    /// One step with `S` nodes of at most `requested` seconds, accepted or rejected.
    fn advance_with<const S: usize>(&mut self, requested: f64) -> Result<StepOutcome, StepError>
    where
        Workspace: Room<S>,
    {
        let requested = requested
            .min(self.model.longest_step(self.state.time))
            .max(self.shortest());
        let corner = self.model.generator.next_break(self.state.time);
        let target = self.grid.target(requested, self.state.time, corner);
        let attempt = self.attempt::<S>(&target);
        let [ratio, own] = attempt
            .as_ref()
            .map_or([f64::INFINITY; 2], |trial| self.relative_errors(trial, &target));
        let Some(trial) = attempt.filter(|_| self.is_acceptable(own, &target)) else {
            // The collocation failed; use the discrete-gradient step.
            if self.state.closed && (self.is_shortest(&target) || self.refusals >= REFUSALS) {
                return self.take_with_constant_force(&target);
            }
            if self.is_shortest(&target) {
                return Err(self.error(StepErrorCause::NotFinite));
            }
            let shrink = if self.changes_now() {
                // Where the force bends the error is of order one.
                (AFTER_REJECTION / ratio).clamp(LEAST_SHRINK, MOST_SHRINK)
            } else {
                shrinkage::<S>(ratio)
            };
            return Ok(self.reject(target.length * shrink));
        };
        // The energy may reveal an error that the estimate misses.
        if !self.is_shortest(&target) && self.breaks_account(&trial, target.length) {
            return Ok(self.reject(0.5 * target.length));
        }
        // From the error of the whole step, also if an event shortens it.
        let growth = if self.before_event {
            growth::<S>(ratio).min(1.0)
        } else {
            growth::<S>(ratio) * self.leaving_kink(target.length)
        };
        // Within rounding of time after a closing, rounding alone opens it again or makes it slip.
        let just = 0.0..=self.shortest();
        let closing = self.state.last_closing;
        let has_just_closed = closing.is_some_and(|closing| just.contains(&(target.time - closing)));
        let (change, opens) = if self.state.closed && !has_just_closed {
            (self.slip_change(&trial, target.length), self.first_open(&trial))
        } else {
            (None, None)
        };
        // What sticks slips before it opens.
        let sticks = self.state.tangential.phase == Phase::Stick;
        let opens = opens.filter(|_| change.is_none() || !sticks);
        let read = self.read_at(&trial, &target);
        let closes = if self.state.closed {
            None
        } else {
            self.closing_of_either(&trial, target.length)
        };
        let event = opens.is_some() || closes.is_some();
        let inside = self.inner_error(&trial, &target, event);
        if (event || read.is_some()) && !self.may_end_inside(&trial, &target, inside) {
            self.before_event = true;
            if self.state.closed {
                // More nodes do better inside than a shorter step.
                self.state.long_step = self.state.long_step.max(target.length);
            }
            return Ok(self.reject_inside::<S>(target.length, inside));
        }
        if change.is_some() && !self.may_change_inside(&trial, &target) {
            return Ok(self.reject_inside::<S>(target.length, (trial.inner_error.total, self.allowed)));
        }
        let opening = opens.and_then(|part| self.opening(&trial, target.length, part * target.length));
        let event = match (opening.or(closes), &change) {
            (event, Some(change)) if event.as_ref().is_none_or(|event| change.at < event.end.at) => {
                Some(self.cut_at_change(&trial, target.length, change))
            }
            (event, _) => event,
        };
        let cut = match (event, read) {
            (Some(event), Some(read)) if event.time <= read => Some(event),
            (_, Some(time)) => Some(Cut {
                end: self.inside(&trial, target.length, time - self.state.time),
                time,
                switches: false,
                mirrors: false,
                slides: None,
            }),
            (event, None) => event,
        };
        if let Some(cut) = cut {
            return self.end_at(&cut, &trial, &target, growth, requested);
        }
        let Some(passages) = self.passages(&trial, target.length, self.is_shortest(&target)) else {
            return Ok(self.reject(MOST_SHRINK * target.length));
        };
        self.keep_first_step::<S>(target.length, ratio);
        self.take(&trial, &target, passages)?;
        if corner.is_some_and(|corner| corner <= target.time) {
            // What the corner sets vibrating, the step sizes before it do not resolve.
            let next = self.step_after_jump();
            self.state.long_step = self.state.long_step.min(next);
            self.state.flight_step = self.state.flight_step.min(next);
            return Ok(StepOutcome {
                taken: true,
                switched: false,
                growth: 1.0,
                length: requested.min(next),
            });
        }
        Ok(StepOutcome::after(target.length, requested, growth))
    }

    /// Factor by which the next step may be longer for its distance from the last closing, or from where slip last began or
    /// ended, alone: the force there is smooth in the logarithm of the time since.
    fn leaving_kink(&self, length: f64) -> f64 {
        let State { time, last_kink, .. } = *self.state;
        let elapsed = time - last_kink;
        let bends = self.state.bent_by_closing() || self.state.tangential.last_change == Some(last_kink);
        if self.changes_now() {
            STEP_GROWTH
        } else if bends && elapsed > 0.0 {
            (SAFETY * (1.0 + length / elapsed)).max(1.0)
        } else {
            1.0
        }
    }

    /// The instant (s) in a trial at which it will be read, if its polynomials are not accurate there, or the communication
    /// step ends.
    fn read_at<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let Some((read, _)) = &self.dense else {
            return self.is_cut(target).then(|| self.grid.end());
        };
        let read = *read;
        let inside = read > self.state.time && read < target.time;
        (inside && S == SHORT && self.inaccuracy(trial, target.length) > 1.0).then_some(read)
    }
}
