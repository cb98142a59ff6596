//! A communication step as a sequence of integration steps.

use crate::BARE;
use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::attempt::{INSIDE, reach};
use crate::integrator::budget::{Budget, work};
use crate::integrator::collocation::step::Trial;
use crate::integrator::discrete_gradient::REFUSALS;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::{Progress, Target};
use crate::integrator::motion::Span;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::state::State;

/// Spacing of floating-point numbers at an instant, in first steps, with which the motion can be followed.
const COARSEST: f64 = 0.1;

/// m/s.
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Share of the tolerance that one step may use up. Found by comparing errors with tolerances over scenes
/// (`tests/calibration.rs`): a blow makes the errors of the motion before it a hundred times larger, and without
/// damping errors add up.
const SHARE: f64 = 0.004;

/// Growth from step to step that shows the steps are still finding their length.
const GROWING: f64 = 1.5;

/// How much longer than a short step a long one has to be to be worth its cost.
const WORTH: f64 = 2.0;

/// Tolerances at which the rounding of the polynomials of many nodes begins to show.
const LONG_FLOOR: f64 = 3e-11;

/// Many nodes reach at most about this many times as far as few.
const LONGER: f64 = 16.0;

/// A communication step under way.
pub(crate) struct Integration<'a> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a mut State,
    pub(crate) workspace: &'a mut Workspace,
    pub(crate) drive: Drive,
    pub(crate) progress: Progress,
    /// The instant beyond which the step is looked into, s, and what the tip does in it.
    pub(crate) span: Option<(f64, &'a mut Span)>,
    /// Of the contact force, where they are asked for.
    pub(crate) extremes: Option<&'a mut Extremes>,
    /// Error allowed in the contact force, N.
    pub(crate) tolerance: f64,
    /// Error allowed in a step, N.
    pub(crate) allowed: f64,
    /// Steps given up in succession.
    pub(crate) refusals: u32,
    /// Whether the energy changes by the work done alone.
    pub(crate) conserves: bool,
}

/// What a step says about the next.
pub(crate) struct Advice {
    /// Whether it was taken.
    pub(crate) taken: bool,
    /// How many times as long as this one it could have been.
    pub(crate) growth: f64,
    /// Length wanted next, s.
    pub(crate) length: f64,
}

impl Advice {
    /// After a step of `length` seconds taken, where `wanted` seconds were wanted.
    pub(crate) fn after(length: f64, wanted: f64, growth: f64) -> Self {
        let next = growth.min(4.0) * length;
        Self {
            taken: true,
            growth,
            // A step cut short by the grid says nothing against the length wanted before.
            length: if length < 0.9 * wanted { wanted.max(next) } else { next },
        }
    }
}

/// How far to advance.
#[derive(Debug)]
pub(crate) enum Steps<'a> {
    /// From the instant `time` (s) by `size` (s), neither more nor less.
    Exactly {
        /// s.
        time: f64,
        /// s.
        size: f64,
    },
    /// By one step as long as the error allows, also within it where it goes beyond the instant `until` (s); what the
    /// tip does in it goes to `span`.
    Own {
        /// s.
        until: f64,
        /// See [`Steps::Own`].
        span: &'a mut Span,
    },
}

impl Model {
    /// Advances the state.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then of no use.
    pub(crate) fn advance(
        &self,
        state: &mut State,
        workspace: &mut Workspace,
        drive: Drive,
        steps: Steps,
        extremes: Option<&mut Extremes>,
    ) -> Result<(), StepError> {
        let tolerance = self.scene.solver.effective_tolerance() * self.force_scale;
        let (progress, span) = match steps {
            Steps::Exactly { time, size } => {
                state.time = self.rests_until(state, &drive, tolerance, time + size).unwrap_or(time);
                let left = size - (state.time - time);
                if left <= 0.0 || self.step_exactly(state, &mut workspace.propagators, &drive, left) {
                    return Ok(());
                }
                (Progress::over(state.time, left), None)
            }
            Steps::Own { until, span } => {
                let size = state.short_step.max(state.long_step);
                (Progress::free(state.time, size), Some((until, span)))
            }
        };
        Integration {
            model: self,
            state,
            workspace,
            drive,
            progress,
            span,
            extremes: extremes.filter(|_| !BARE),
            tolerance,
            allowed: SHARE * tolerance,
            refusals: 0,
            conserves: self.conserves(&drive),
        }
        .run()
    }
}

impl Integration<'_> {
    fn run(&mut self) -> Result<(), StepError> {
        let allowed = COARSEST * self.model.first_step(self.state.time);
        let spacing = self.resolution();
        if spacing > allowed {
            return Err(self.error(StepErrorCause::Resolution { spacing, allowed }));
        }
        if self.drive.support_rate.abs() > SPEED_OF_LIGHT {
            return Err(self.error(StepErrorCause::Speed(self.drive.support_rate)));
        }
        self.set_support_rate();
        self.note_force();
        let budget = Budget::new(self.workspace, self.progress.size);
        while self.progress.done < 1.0 {
            budget.check(self.workspace, self.state.time)?;
            self.advance()?;
            self.note_force();
            let Progress { free, done, .. } = self.progress;
            let end = self.progress.end();
            if !free
                && done < 1.0
                && let Some(until) = self.model.rests_until(self.state, &self.drive, self.tolerance, end)
            {
                let target = self.progress.cut(until - self.state.time, until);
                (self.state.time, self.progress.done) = (target.time, target.done);
            }
        }
        Ok(())
    }

    pub(crate) fn error(&self, cause: StepErrorCause) -> StepError {
        StepError {
            time: self.state.time,
            cause,
        }
    }

    /// One integration step, taken or rejected: with few nodes where they reach far enough, else with many.
    fn advance(&mut self) -> Result<(), StepError> {
        let left = self.progress.left();
        let short_step = self.state.short_step;
        // Just after a blow the force is no polynomial of high degree.
        let smooth = if self.state.last_closing < 0.0 {
            f64::INFINITY
        } else {
            self.state.time - self.state.last_closing
        };
        let long_step = self.state.long_step.min(smooth);
        if self.tolerance <= LONG_FLOOR * self.model.force_scale || left <= short_step || long_step < WORTH * short_step
        {
            let advice = self.advance_with::<SHORT>(short_step)?;
            self.state.short_step = advice.length;
            if advice.taken && advice.growth < GROWING {
                self.state.long_step = self.state.long_step.max(2.0 * WORTH * advice.length);
            }
        } else {
            let advice = self.advance_with::<LONG>(long_step)?;
            self.state.long_step = advice.length;
            // Where a long step is far shorter than it might be, a short one will do.
            if advice.taken {
                self.state.short_step = short_step.max(advice.growth * left.min(long_step) / LONGER);
            }
        }
        Ok(())
    }

    /// One step of `S` nodes, taken or rejected, of `wanted` seconds or less.
    fn advance_with<const S: usize>(&mut self, wanted: f64) -> Result<Advice, StepError>
    where
        Workspace: Room<S>,
    {
        let wanted = wanted
            .min(self.model.longest_step(self.state.time))
            .max(self.shortest());
        let corner = self.model.generator.next_break(self.state.time);
        let target = self.progress.target(wanted, self.state.time, corner);
        let attempt = self.attempt::<S>(&target);
        let ratio = attempt
            .as_ref()
            .map_or(f64::INFINITY, |trial| self.relative_error(trial, &target));
        let Some(trial) = attempt.filter(|_| self.is_acceptable(ratio, &target)) else {
            // The law asks for what no polynomial follows: a constant force gets on.
            if self.state.closed && (self.is_shortest(&target) || self.refusals >= REFUSALS) {
                return self.fall_back(&target);
            }
            if self.is_shortest(&target) {
                return Err(self.error(StepErrorCause::NotFinite));
            }
            // Without an error estimate by the most, as nothing is known.
            let shrink = if ratio.is_finite() {
                0.8 * reach::<S>(ratio)
            } else {
                0.0
            };
            return Ok(self.reject(target.length * shrink.clamp(0.1, 0.5)));
        };
        // The error estimate may miss what the energy shows.
        if !self.is_shortest(&target) && self.breaks_account(&trial, target.length) {
            return Ok(self.reject(0.5 * target.length));
        }
        // By the whole step, also where an event cuts it short.
        let growth = if ratio < 1e-7 {
            64.0
        } else {
            (0.9 * reach::<S>(ratio)).clamp(0.5, 64.0)
        };
        let suspect = self.first_suspect(&trial, target.length);
        if let Some(passed) = self.first_passage(&trial)
            && suspect.is_none_or(|part| passed <= part)
            && let Some(advice) = self.pass::<S>(passed, &target, growth, wanted)?
        {
            return Ok(advice);
        }
        if let Some(part) = suspect {
            if S != SHORT {
                // Events are located in short steps; long ones end before.
                return Ok(self.reject(0.9 * part * target.length));
            }
            if let Some(cut) = self.cut(part, &trial, target.length) {
                return self.end_at::<S>(&cut, growth, wanted);
            }
        }
        self.take(&trial, &target)?;
        Ok(Advice::after(target.length, wanted, growth))
    }

    /// Gives up a step; the next one is to have the length.
    pub(crate) fn reject(&mut self, length: f64) -> Advice {
        self.state.rejected_steps += 1;
        self.refusals += 1;
        Advice {
            taken: false,
            growth: 1.0,
            length,
        }
    }

    /// The trial becomes the state, if it is finite.
    pub(crate) fn take<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> Result<(), StepError>
    where
        Workspace: Room<S>,
    {
        if !(trial.indentation.is_finite() && trial.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let due = self.energy_due(trial, target);
        if due.is_some() {
            // The step once more, in halves.
            self.workspace.work += work(target.recurring) + 1;
        }
        self.enter(trial, target.length);
        let Self { model, state, .. } = self;
        let (cache, end, _) = Room::<S>::parts(self.workspace);
        let collocation = cache.collocation();
        let ratio = if state.last_step > 0.0 {
            target.length / state.last_step
        } else {
            0.0
        };
        let start = state.force - model.preload.force;
        state.predictions = collocation.predictions(model.machine, start, &trial.forces, &state.predictions, ratio);
        if let Some((_, span)) = &mut self.span {
            span.good = INSIDE * trial.missed <= self.tolerance;
            span.indentation = collocation.through(state.indentation, &trial.indentations);
            span.rate = collocation.through(state.indentation_rate, &trial.rates);
            span.force = *state.predictions.through_all();
        }
        for ((mode, end), _) in state.modes.iter_mut().zip(end).zip(&model.modes) {
            *mode = *end;
        }
        state.time = target.time;
        state.support = trial.support;
        state.indentation = trial.indentation;
        state.indentation_rate = trial.rate;
        if state.closed {
            state.force = model.law.without_pull(model.preload.force + nodal::end(&trial.forces));
        }
        if let Some(extremes) = &mut self.extremes {
            extremes.add_course(model, state.closed, state.predictions.through_all(), -1.0, 0.0);
        }
        state.last_step = target.length;
        state.steps += 1;
        state.iterations += trial.iterations;
        self.progress.done = target.done;
        self.refusals = 0;
        self.settle(target.length);
        self.balance(due);
        Ok(())
    }
}
