//! A communication step as a sequence of integration steps.

use crate::error::{StepError, StepErrorCause};
use crate::inputs::Inputs;
use crate::model::{MAX_MODES, ModeState, ModeStates, Model, State};
use crate::transient::coefficients::Cache;
use crate::transient::collocation::NODES;
use crate::transient::nodal::{Drive, Trial};
use crate::transient::progress::{Progress, Target};

/// Integration steps a communication step may take, and further ones per second of it.
const BUDGET: u64 = 10_000_000;
/// See [`BUDGET`].
const BUDGET_RATE: f64 = 1e7;

/// Share of the tolerance that one step may use up.
const SHARE: f64 = 0.01;

/// Power of the step length with which the error estimate grows.
const ORDER: f64 = NODES as f64 + 2.0;

/// Scratch of the steps. Nothing in it changes a result, only the time it takes.
#[derive(Clone, Debug)]
pub struct Workspace {
    pub(super) cache: Cache,
    /// The modes at the end of the step about to be taken.
    end: ModeStates,
    /// The modes at instants looked at.
    probe: ModeStates,
}

impl Workspace {
    /// For the model.
    pub fn new(model: &Model) -> Self {
        Self {
            cache: Cache::new(model.modes.len()),
            end: [ModeState::default(); MAX_MODES],
            probe: [ModeState::default(); MAX_MODES],
        }
    }
}

/// A communication step under way.
pub(super) struct Integration<'a> {
    pub(super) model: &'a Model,
    pub(super) state: &'a mut State,
    pub(super) workspace: &'a mut Workspace,
    drive: Drive,
    progress: Progress,
    /// Error allowed in the contact force, N.
    pub(super) tolerance: f64,
}

/// A step that ends before it was meant to.
pub(super) struct Cut {
    /// Its length, s.
    pub(super) length: f64,
    /// Whether the contact opens or closes at its end.
    pub(super) switches: bool,
}

impl Model {
    /// Advances the state over the communication step from `time` to `time + size` (s) with the inputs held.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then unchanged.
    pub fn step(
        &self,
        state: &mut State,
        workspace: &mut Workspace,
        inputs: &Inputs,
        time: f64,
        size: f64,
    ) -> Result<(), StepError> {
        if !(size > 0.0 && size.is_finite() && (time + size).is_finite()) {
            return Err(StepError {
                time,
                cause: StepErrorCause::StepSize,
            });
        }
        let saved = *state;
        state.time = time;
        state.current = inputs.contact_current;
        // The fixed contact moves linearly to the input.
        let support = inputs.support_displacement - self.initial_support;
        let drive = Drive {
            acceleration: inputs.base_acceleration,
            support_rate: (support - state.support) / size,
        };
        let tolerance = self.scene.solver.effective_tolerance() * self.force_scale;
        let progress = Progress {
            start: time,
            size,
            done: 0.0,
        };
        let result = Integration {
            model: self,
            state,
            workspace,
            drive,
            progress,
            tolerance,
        }
        .run();
        match result {
            Ok(()) => state.support = support,
            Err(_) => *state = saved,
        }
        result
    }
}

impl Integration<'_> {
    fn run(&mut self) -> Result<(), StepError> {
        self.set_support_rate();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of steps, saturating"
        )]
        let budget = BUDGET.saturating_add((self.progress.size * BUDGET_RATE) as u64);
        let limit = self.attempts().saturating_add(budget);
        while self.progress.done < 1.0 {
            if self.attempts() >= limit {
                return Err(self.error(StepErrorCause::Budget(budget)));
            }
            self.advance()?;
        }
        Ok(())
    }

    fn attempts(&self) -> u64 {
        self.state.steps + self.state.rejected_steps
    }

    fn error(&self, cause: StepErrorCause) -> StepError {
        StepError {
            time: self.state.time,
            cause,
        }
    }

    /// One integration step, taken or rejected.
    fn advance(&mut self) -> Result<(), StepError> {
        let shortest = 8.0 * f64::EPSILON * (self.progress.start.abs() + self.progress.size);
        let wanted = self.state.next_step.min(self.model.longest_step).max(shortest);
        let corner = self.model.generator.next_break(self.state.time);
        let mut target = self.progress.target(wanted, self.state.time, corner);

        let attempt = self.attempt(&target);
        let ratio = attempt
            .as_ref()
            .map_or(f64::INFINITY, |trial| trial.error / (SHARE * self.tolerance));
        let Some(mut trial) = attempt.filter(|_| ratio <= 1.0 || target.length <= 2.0 * shortest) else {
            if target.length <= 2.0 * shortest || ratio.is_nan() {
                return Err(self.error(StepErrorCause::NotFinite));
            }
            self.reject(target.length * (0.8 * ratio.powf(-1.0 / ORDER)).clamp(0.1, 0.5));
            return Ok(());
        };

        let cut = if self.state.closed {
            self.release(&trial, target.length)
        } else {
            self.touchdown(&trial, target.length)
        };
        if let Some(Cut { length, .. }) = cut {
            target = self.progress.cut(length, self.state.time + length);
            if let Some(shorter) = self.attempt(&target) {
                trial = shorter;
            } else {
                self.reject(0.25 * length);
                return Ok(());
            }
        }
        if !(trial.indentation.is_finite() && trial.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let growth = if ratio < 1e-6 {
            4.0
        } else {
            (0.9 * ratio.powf(-1.0 / ORDER)).clamp(0.5, 4.0)
        };
        // A step cut short by the grid says nothing against the length wanted before.
        let next = if target.length < 0.9 * wanted {
            wanted.max(growth * target.length)
        } else {
            growth * target.length
        };
        self.take(&trial, &target, next);
        if cut.is_some_and(|cut| cut.switches) {
            self.switch(!self.state.closed);
        }
        Ok(())
    }

    /// The step to the target, with the modes at its end kept for [`Integration::take`].
    fn attempt(&mut self, target: &Target) -> Option<Trial> {
        let Workspace { cache, end, .. } = &mut *self.workspace;
        let (step, collocation) = cache.get(target.length, target.recurring, self.model);
        self.model
            .trial(self.state, &self.drive, step, collocation, 1e-2 * self.tolerance, end)
    }

    /// A step of `length` seconds only to be looked at.
    pub(super) fn probe(&mut self, length: f64) -> Option<Trial> {
        let Workspace { cache, probe, .. } = &mut *self.workspace;
        let (step, collocation) = cache.get(length, false, self.model);
        self.model
            .trial(self.state, &self.drive, step, collocation, 1e-2 * self.tolerance, probe)
    }

    fn reject(&mut self, next_step: f64) {
        self.state.rejected_steps += 1;
        self.state.next_step = next_step;
    }

    /// The trial becomes the state.
    fn take(&mut self, trial: &Trial, target: &Target, next_step: f64) {
        let Self { model, state, .. } = self;
        for ((mode, end), _) in state.modes.iter_mut().zip(&self.workspace.end).zip(&model.modes) {
            *mode = *end;
        }
        state.time = target.time;
        state.support = trial.support;
        state.indentation = trial.indentation;
        state.indentation_rate = trial.rate;
        if state.closed {
            state.force = model
                .law
                .force(model.preload.indentation + trial.indentation, trial.rate);
        }
        let collocation = self.workspace.cache.collocation();
        state.prediction = collocation.prediction(&trial.forces, state.force - model.preload.force);
        state.last_step = target.length;
        state.next_step = next_step;
        state.steps += 1;
        state.iterations += trial.iterations;
        self.progress.done = target.done;
    }

    /// The contact opens or closes at the instant of the state.
    fn switch(&mut self, closed: bool) {
        self.state.closed = closed;
        self.state.force = 0.0;
        self.state.last_step = 0.0;
        if closed {
            self.state.last_closing = self.state.time;
            self.state.next_step = self.state.next_step.min(self.first_closed_step());
        } else {
            self.state.last_opening = self.state.time;
            self.state.next_step = self.state.next_step.max(0.1 * self.model.first_step());
        }
    }

    /// A new velocity of the fixed contact changes the dissipative force at once.
    fn set_support_rate(&mut self) {
        let jump = self.drive.support_rate - self.state.support_rate;
        if jump == 0.0 {
            return;
        }
        self.state.support_rate += jump;
        self.state.indentation_rate += jump;
        let d = self.model.preload.indentation + self.state.indentation;
        let force = self.model.law.force(d, self.state.indentation_rate);
        let closed = self
            .model
            .engagement(self.state.indentation, self.state.indentation_rate)
            > 0.0;
        if closed != self.state.closed {
            self.switch(closed);
        }
        self.state.force = force;
        self.state.last_step = 0.0;
        self.state.next_step = self.state.next_step.min(self.first_closed_step());
    }

    /// First step after the surfaces meet, s. The dissipative force starts as the square root of time, which no polynomial
    /// follows: the step is chosen so short that what it misses moves the contact by less than a step's share of the error.
    fn first_closed_step(&self) -> f64 {
        let Self { model, state, .. } = self;
        let d = model.preload.indentation + state.indentation;
        let speed = state.indentation_rate.abs();
        let mobility: f64 = model.modes.iter().map(|mode| mode.tip * mode.tip).sum();
        let mut h = model.first_step();
        for _ in 0..40 {
            let law = model.law.closed_branch(d + speed * h, state.indentation_rate);
            let gain = mobility * h * (law.damping + 0.5 * h * law.stiffness.abs());
            if 0.1 * (law.force - state.force).abs() * gain / (1.0 + gain) <= SHARE * self.tolerance {
                break;
            }
            h *= 0.5;
        }
        h
    }
}
