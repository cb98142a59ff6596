//! A step on trial, and whether its error is one that a step may have.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::newton::Source;
use crate::integrator::collocation::step::{Trial, is_rounding, trial};
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace, work};
use crate::math::nodal::{self, SHORT};

/// Error of the contact force within a step, per force that its polynomial misses at the start.
pub(crate) const INSIDE: f64 = 0.3;

/// Largest difference that Newton's method leaves between a nodal force and that of the law, in errors allowed in a
/// step.
const NEWTON: f64 = 0.2;

impl Integration<'_> {
    /// Estimated error of a trial to the target, in errors allowed; none where it is rounding, which no shorter step
    /// makes smaller.
    pub(crate) fn relative_error<const S: usize>(&self, trial: &Trial<S>, target: &Target) -> f64 {
        let looked_into = self.dense.as_ref().is_some_and(|(until, _)| *until < target.time);
        // Short steps may be wrong inside: `DenseOutput::good` then keeps them from being looked into.
        let inside = if looked_into && S != SHORT {
            INSIDE / self.tolerance
        } else {
            0.0
        };
        let (ratio, inside) = (trial.error / self.allowed.max(trial.rounding), trial.missed * inside);
        // Not `max`, which would hide what is not a number.
        let ratio = if ratio < inside { inside } else { ratio };
        if ratio > 1.0 && is_rounding(self.model, self.state, trial) {
            0.0
        } else {
            ratio
        }
    }

    /// Whether a step to the target may have this error: what is allowed, and any where it cannot be shorter.
    pub(crate) fn is_acceptable(&self, ratio: f64, target: &Target) -> bool {
        ratio <= 1.0 || self.is_shortest(target) && ratio.is_finite()
    }

    /// The step to the target, with the modes at its end kept for [`Integration::take`].
    pub(crate) fn attempt<const S: usize>(&mut self, target: &Target) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(target.length, target.recurring, true)
    }

    /// A step of `length` seconds only to be looked at.
    pub(crate) fn probe<const S: usize>(&mut self, length: f64) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(length, false, false)
    }

    /// A step of `length` seconds, whose coefficients may be wanted again (`recurring`), and the modes at its end
    /// (`kept`).
    fn trial<const S: usize>(&mut self, length: f64, recurring: bool, kept: bool) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.workspace.work += work(recurring);
        let (cache, end, probe) = self.workspace.parts();
        let (step, collocation) = cache.get(length, recurring, self.model);
        let source = Source::Law(NEWTON * self.allowed);
        let modes = if kept { end } else { probe };
        trial(self.model, self.state, &self.drive, (step, collocation), source, modes)
    }

    /// Gives up a step; the next one is to have the length.
    pub(crate) fn reject(&mut self, length: f64) -> StepOutcome {
        self.state.rejected_steps += 1;
        self.refusals += 1;
        StepOutcome {
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
        state.predictions = collocation.predictions(model.simd, start, &trial.forces, &state.predictions, ratio);
        if let Some((_, dense)) = &mut self.dense {
            dense.good = INSIDE * trial.missed <= self.tolerance;
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
        self.balance(due);
        Ok(())
    }
}

/// How many times as long a step could be that is wrong by `ratio` errors allowed: the error estimate grows with the
/// power `S + 1` of the length.
pub(crate) fn step_factor<const S: usize>(ratio: f64) -> f64 {
    ratio.powf(-1.0 / (S as f64 + 1.0))
}
