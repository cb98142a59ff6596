//! A trial step: its relative error, acceptance and rejection.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::error::is_rounding;
use crate::integrator::collocation::newton::Source;
use crate::integrator::collocation::part::{self, Instant};
use crate::integrator::collocation::step::Trial;
use crate::integrator::collocation::trial::trial;
use crate::integrator::constants::{
    AFTER_BLOW, AFTER_REJECTION, AT_EVENT, DRIVEN, FORCE_ROUNDING, INHERITED, INSIDE, INSIDE_DRIVEN, ITERATIONS,
    LEAST_SHRINK, NEAR_BLOW, NEWTON, NEXT_LENGTH, ROUNDED,
};
use crate::integrator::course::{Places, turning_points};
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace, work};
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{LONG, SHORT, greatest};
use crate::math::prediction::value_and_slope;
use crate::state::State;

impl Integration<'_> {
    /// Estimated error of a trial to the target, relative to the error allowed: that from which the next length follows, and
    /// that by which it is accepted, with less of what the contact's damper takes back. [`ROUNDED`] where it is mere
    /// rounding, which no shorter step reduces.
    pub(crate) fn relative_errors<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> [f64; 2]
    where
        Workspace: Room<S>,
    {
        let read = self.dense.as_ref().is_some_and(|(until, _)| *until < target.time);
        let watched = self.model.scene.effects.extremes || self.model.criterion.is_some();
        // 4-node steps may be inaccurate inside: they end where they are read.
        let inside = if self.driven && watched {
            INSIDE_DRIVEN * self.inaccuracy(trial, target.length)
        } else if (read || watched || !self.state.closed) && S != SHORT {
            self.inaccuracy(trial, target.length)
        } else {
            0.0
        };
        let after_blow = self.after_blow(target);
        let all = self.passing();
        let [ratio, own] = [all, all.min(INHERITED)].map(|share| {
            let ratio = after_blow * trial.error.with(share) / self.allowed.max(trial.rounding);
            // Not `max`, which would hide NaN.
            if ratio < inside { inside } else { ratio }
        });
        let rounding = ratio > 1.0
            && (self.state.closed || inside < 1.0)
            && is_rounding::<S>(self.model, self.state, &trial.tangent, trial.error.total);
        if rounding { [ROUNDED; 2] } else { [ratio, own] }
    }

    /// Factor on the error that the contact's damper takes back.
    fn passing(&self) -> f64 {
        if self.driven { DRIVEN } else { 1.0 }
    }

    /// Factor on the error just after a closing, where the force is not smooth enough for the estimate.
    fn after_blow(&self, target: &Target) -> f64 {
        let State {
            time,
            closed,
            last_kink,
            ..
        } = *self.state;
        let near = closed && self.state.bent_by_closing() && time - last_kink < NEAR_BLOW * target.length;
        if near { AFTER_BLOW } else { 1.0 }
    }

    /// Whether a step to the target with this relative error is accepted; one of the shortest length with any finite
    /// error.
    pub(crate) fn is_acceptable(&self, ratio: f64, target: &Target) -> bool {
        ratio <= 1.0 || self.is_shortest(target) && ratio.is_finite()
    }

    /// Error of what is read inside a trial of `length` seconds, in tolerances: of the force, in flight of the
    /// indentation.
    pub(crate) fn inaccuracy<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> f64
    where
        Workspace: Room<S>,
    {
        if !self.state.closed {
            self.misread(trial, length)
        } else if trial.next_terms > self.tolerance {
            // Only rejects: a length chosen by it would be too short by a twentieth.
            trial.next_terms / self.tolerance
        } else {
            INSIDE * trial.start_defect / self.tolerance
        }
    }

    /// Error of the indentation between the nodes of a trial of `length` seconds as it would be read there, in that which
    /// a force wrong by the tolerance makes of the spring. The polynomial through the indentations has slopes at the nodes
    /// that differ from the velocities there; between two nodes its error is the cubic with these slopes.
    fn misread<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> f64
    where
        Workspace: Room<S>,
    {
        let (start, simd) = (self.state.indentation, self.model.simd);
        let collocation = self.collocation::<S>();
        let polynomial = collocation.through(simd, start, &trial.indentations);
        let wrong = |x: f64, rate: f64| (rate * length - value_and_slope(&polynomial, x - 1.0).1).abs();
        let mut before = (0.0, wrong(0.0, self.state.indentation_rate));
        let mut most = 0.0_f64;
        for (x, rate) in self.collocation::<S>().nodes.iter().zip(&trial.rates) {
            let now = (*x, wrong(*x, *rate));
            most = most.max(0.125 * (now.0 - before.0) * (now.1 + before.1));
            before = now;
        }
        if most <= FORCE_ROUNDING * greatest(&trial.indentations).max(start.abs()) {
            // Rounding of the polynomial, which no shorter step reduces.
            return 0.0;
        }
        most / (self.tolerance * self.model.compliance)
    }

    /// Whether the step ends with the communication step, inside the trial.
    pub(crate) fn is_cut(&self, target: &Target) -> bool {
        !self.grid.recurs && target.time > self.grid.end()
    }

    /// Error of a trial that ends inside, at an event or else where it is read or the communication step ends, and the one
    /// allowed there, N.
    pub(crate) fn inner_error<const S: usize>(&self, trial: &Trial<S>, target: &Target, event: bool) -> (f64, f64) {
        let error = trial.inner_error;
        if self.is_cut(target) && !event {
            (error.with(self.passing()), self.allowed)
        } else if self.state.closed {
            (error.total, AT_EVENT * self.allowed)
        } else {
            (error.total, self.allowed)
        }
    }

    /// Whether the trial may end inside with this error (N) where that one is allowed.
    pub(crate) fn may_end_inside<const S: usize>(
        &self,
        trial: &Trial<S>,
        target: &Target,
        (error, allowed): (f64, f64),
    ) -> bool {
        error <= allowed.max(trial.rounding)
            || self.is_shortest(target)
            || is_rounding::<S>(self.model, self.state, &trial.tangent, error)
    }

    /// A trial step to the target; the modes at its end are kept for [`Integration::take`].
    pub(crate) fn attempt<const S: usize>(&mut self, target: &Target) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        let (cache, end, _) = self.workspace.parts();
        let prepared = cache.prepare(self.state.time, target.length, target.recurring, self.model);
        let source = Source::Law(NEWTON * self.allowed);
        let trial = trial(self.model, self.state, &self.drive, prepared, source, end);
        let iterations = trial.as_ref().map_or(ITERATIONS, |trial| trial.iterations);
        self.workspace.work += work::<S>(self.model, target.recurring) + iterations * (S * S) as u64;
        trial
    }

    /// The exact motion under the polynomials of a trial of `length` seconds, `at` seconds after its start; the modes are
    /// kept for [`Integration::shorten`].
    pub(crate) fn inside<const S: usize>(&mut self, trial: &Trial<S>, length: f64, at: f64) -> Instant
    where
        Workspace: Room<S>,
    {
        self.workspace.work += work::<S>(self.model, true);
        let (cache, end, inside) = Room::<S>::parts(self.workspace);
        let whole = (trial, length, &*end);
        let collocation = cache.collocation();
        part::motion(self.model, self.state, &self.drive, collocation, whole, at, inside)
    }

    /// The trial of `length` seconds up to the instant that was looked at last.
    pub(crate) fn shorten<const S: usize>(&mut self, trial: &Trial<S>, length: f64, last: &Instant) -> Trial<S>
    where
        Workspace: Room<S>,
    {
        let (cache, end, inside) = Room::<S>::parts(self.workspace);
        end.modes = *inside;
        let whole = (trial, length, &mut end.loads, &mut end.tangential);
        part::first_part(self.model, self.state, &self.drive, cache.collocation(), whole, last)
    }

    /// Rejects a step; the next one shall have `length` (s).
    pub(crate) fn reject(&mut self, length: f64) -> StepOutcome {
        self.state.rejected_steps += 1;
        self.refusals += 1;
        StepOutcome {
            taken: false,
            switched: false,
            growth: 1.0,
            length,
        }
    }

    /// Rejects a step of `length` seconds that would end inside with this error (N) where that one is allowed.
    pub(crate) fn reject_inside<const S: usize>(&mut self, length: f64, (error, allowed): (f64, f64)) -> StepOutcome {
        let shrink = AFTER_REJECTION * (allowed / error).powf(1.0 / S as f64);
        self.reject(length * shrink.clamp(LEAST_SHRINK, NEXT_LENGTH))
    }

    /// Accepts the trial as the new state; its force passes that of an interruption at `passages`.
    ///
    /// # Errors
    /// [`StepErrorCause::NotFinite`] where it is not finite.
    pub(crate) fn take<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        target: &Target,
        passages: Places,
    ) -> Result<(), StepError>
    where
        Workspace: Room<S>,
    {
        if !(trial.indentation.is_finite() && trial.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let expected_energy = self.expected_energy(trial, target);
        if expected_energy.is_some() {
            // The balance repeats the step in two halves.
            self.workspace.work += 2 * work::<LONG>(self.model, target.recurring);
        }
        self.enter(trial, target.length);
        self.note_approach(trial, target.length);
        self.state.force_error.add(trial.error.with(self.passing()));
        let Self { model, state, .. } = self;
        let (cache, end, _) = Room::<S>::parts(self.workspace);
        let collocation = cache.collocation();
        if state.force_error.deviates() {
            let closed = state.closed;
            if let Some(step) = cache.known(target.length, target.recurring) {
                let free = step.end.free();
                state.force_error.advance(&model.modes, free, trial.tangent, closed);
            } else {
                let modes = model.modes.iter();
                let free = modes.map(|mode| FreeMotion::new(mode.omega_squared, mode.damping, target.length));
                state.force_error.advance(&model.modes, free, trial.tangent, closed);
            }
        }
        let start = state.force - model.preload.force;
        state.course = collocation.through(model.simd, start, &trial.forces);
        let force = &state.course;
        let turns = if model.scene.effects.extremes && state.closed {
            turning_points(force)
        } else {
            Places::default()
        };
        if let Some((read, dense)) = &mut self.dense {
            // Of the other contact the approach is read from all steps.
            if target.time > *read || self.other.is_some() {
                dense.indentation = collocation.through(model.simd, state.indentation, &trial.indentations);
                dense.rate = collocation.through(model.simd, state.indentation_rate, &trial.rates);
            }
            (dense.force, dense.turns, dense.passages) = (*force, turns, passages);
        }
        if let Some(extremes) = &mut self.extremes
            && state.closed
        {
            extremes.add_course(model, (force, &turns), -1.0, 0.0);
        }
        if let Some(criterion) = &model.criterion {
            for place in passages.iter() {
                state.interruptions.turn(criterion, target.time + place * target.length);
            }
        }
        for ((mode, end), _) in state.modes.iter_mut().zip(&end.modes).zip(&model.modes) {
            *mode = *end;
        }
        state.time = target.time;
        state.support = trial.support;
        state.second_support += self.drive.second_rate * target.length;
        state.indentation = trial.indentation;
        state.indentation_rate = trial.rate;
        if state.closed {
            state.force = model.law.without_pull(model.preload.force + trial.force);
        }
        state.last_step = target.length;
        state.steps += 1;
        state.iterations += trial.iterations;
        self.grid.done = target.done;
        self.refusals = 0;
        self.before_event = false;
        self.changes = 0;
        self.follow_friction::<S>(target.length);
        self.settle(target.length);
        self.balance(expected_energy);
        Ok(())
    }
}
