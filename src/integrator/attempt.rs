//! A trial step: its relative error, acceptance and rejection.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::newton::Source;
use crate::integrator::collocation::step::{Trial, is_rounding, trial};
use crate::integrator::constants::{AFTER_REJECTION, INSIDE, LEAST_SHRINK, MOST_GROWTH, MOST_SHRINK, NEWTON, SAFETY};
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace, work};
use crate::math::nodal::{self, SHORT};

impl Integration<'_> {
    /// Estimated error of a trial to the target, relative to the error allowed; 0 where it is mere rounding, which no
    /// shorter step reduces.
    pub(crate) fn relative_error<const S: usize>(&self, trial: &Trial<S>, target: &Target) -> f64 {
        let read = self.dense.as_ref().is_some_and(|(until, _)| *until < target.time);
        let looked_into = read || self.model.scene.effects.extremes;
        // 4-node steps may be inaccurate inside: `DenseOutput::accurate` then prevents dense output.
        let inside = if !looked_into || S == SHORT {
            0.0
        } else if trial.next_terms > self.tolerance {
            // Only rejects: a length chosen by it would be too short by a twentieth.
            trial.next_terms
        } else {
            INSIDE * trial.start_defect
        };
        let (ratio, inside) = (trial.error / self.allowed.max(trial.rounding), inside / self.tolerance);
        // Not `max`, which would hide NaN.
        let ratio = if ratio < inside { inside } else { ratio };
        if ratio > 1.0 && is_rounding(self.model, self.state, trial) {
            0.0
        } else {
            ratio
        }
    }

    /// Whether a step to the target with this relative error is accepted; one of the shortest length with any finite
    /// error.
    pub(crate) fn is_acceptable(&self, ratio: f64, target: &Target) -> bool {
        ratio <= 1.0 || self.is_shortest(target) && ratio.is_finite()
    }

    /// A trial step to the target; the modes at its end are kept for [`Integration::take`].
    pub(crate) fn attempt<const S: usize>(&mut self, target: &Target) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(target.length, target.recurring, true)
    }

    /// A trial step of `length` seconds for event location only; it cannot be taken.
    pub(crate) fn probe<const S: usize>(&mut self, length: f64) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(length, false, false)
    }

    /// A trial step of `length` seconds. `recurring`: cache its coefficients; `kept`: it may be taken.
    fn trial<const S: usize>(&mut self, length: f64, recurring: bool, kept: bool) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.workspace.work += work(recurring);
        let (cache, end, probe) = self.workspace.parts();
        let prepared = cache.prepare(self.state.time, length, recurring, self.model);
        let source = Source::Law(NEWTON * self.allowed);
        let modes = if kept { end } else { probe };
        trial(self.model, self.state, &self.drive, prepared, source, modes)
    }

    /// Rejects a step; the next one shall have `length` (s).
    pub(crate) fn reject(&mut self, length: f64) -> StepOutcome {
        self.state.rejected_steps += 1;
        self.refusals += 1;
        StepOutcome {
            taken: false,
            growth: 1.0,
            length,
        }
    }

    /// Accepts the trial as the new state.
    ///
    /// # Errors
    /// [`StepErrorCause::NotFinite`] where it is not finite.
    pub(crate) fn take<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> Result<(), StepError>
    where
        Workspace: Room<S>,
    {
        if !(trial.indentation.is_finite() && trial.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let expected_energy = self.expected_energy(trial, target);
        if expected_energy.is_some() {
            // The balance repeats the step in two halves.
            self.workspace.work += work(target.recurring) + 1;
        }
        self.enter(trial, target.length);
        let Self { model, state, .. } = self;
        let (cache, end, _) = Room::<S>::parts(self.workspace);
        state.force_error.add(trial.error);
        if state.force_error.deviates() {
            let (step, _) = cache.get(target.length, target.recurring, model);
            let closed = state.closed;
            state
                .force_error
                .advance(&model.modes, &step.end, trial.tangent, closed);
        }
        let collocation = cache.collocation();
        let ratio = if state.last_step > 0.0 {
            target.length / state.last_step
        } else {
            0.0
        };
        let start = state.force - model.preload.force;
        state.predictions = collocation.predictions(model.simd, start, &trial.forces, &state.predictions, ratio);
        if let Some((_, dense)) = &mut self.dense {
            dense.accurate = trial.next_terms.max(INSIDE * trial.start_defect) <= self.tolerance;
            dense.indentation = collocation.through(state.indentation, &trial.indentations);
            dense.rate = collocation.through(state.indentation_rate, &trial.rates);
            dense.force = *state.predictions.through_all();
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
        self.grid.done = target.done;
        self.refusals = 0;
        self.settle(target.length);
        self.balance(expected_energy);
        Ok(())
    }
}

/// Factor on the length after a step of the relative error `ratio`.
pub(crate) fn growth<const S: usize>(ratio: f64) -> f64 {
    if ratio < 1e-7 {
        MOST_GROWTH
    } else {
        (SAFETY * step_factor::<S>(ratio)).clamp(MOST_SHRINK, MOST_GROWTH)
    }
}

/// Factor on the length after a rejection for the relative error `ratio`; the smallest without an error estimate.
pub(crate) fn shrinkage<const S: usize>(ratio: f64) -> f64 {
    if ratio.is_finite() {
        (AFTER_REJECTION * step_factor::<S>(ratio)).clamp(LEAST_SHRINK, MOST_SHRINK)
    } else {
        LEAST_SHRINK
    }
}

/// Factor to the step size at which the relative error `ratio` becomes 1: the error estimate is of order `S + 1`.
fn step_factor<const S: usize>(ratio: f64) -> f64 {
    ratio.powf(-1.0 / (S as f64 + 1.0))
}
