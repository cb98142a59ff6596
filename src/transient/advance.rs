//! A communication step as a sequence of integration steps.

use crate::error::{StepError, StepErrorCause};
use crate::inputs::Inputs;
use crate::model::{Model, State};
use crate::transient::coefficients::Cache;
use crate::transient::collocation::NODES;
use crate::transient::nodal::{Drive, Trial};
use crate::transient::touchdown::Sample;

/// Integration steps a communication step may take, and further ones per second of it.
const BUDGET: u64 = 10_000_000;
/// See [`BUDGET`].
const BUDGET_RATE: f64 = 1e7;

/// Share of the tolerance that one step may use up.
const SHARE: f64 = 0.05;

/// Power of the step length with which the error estimate grows.
const ORDER: f64 = NODES as f64 + 2.0;

/// Where a communication step stands. Steps end on halvings of it, so that their lengths come again.
struct Progress {
    /// Start, s.
    start: f64,
    /// Length, s.
    size: f64,
    /// Part done, 0 to 1.
    done: f64,
}

/// The length a step is to have.
struct Target {
    /// Part done at its end.
    done: f64,
    /// Length, s.
    length: f64,
    /// Whether the length is a halving of the communication step.
    recurring: bool,
    /// The instant at its end, s.
    time: f64,
}

impl Progress {
    /// The next step, not longer than about `wanted` (s), which ends at `corner` (s) at the latest.
    fn target(&self, wanted: f64, time: f64, corner: Option<f64>) -> Target {
        let level = (self.size / wanted).log2().ceil().clamp(0.0, 52.0);
        let cell = (-level).exp2();
        let mut done = ((self.done / cell).floor() + 1.0) * cell;
        if done - self.done < 0.3 * cell {
            done += cell;
        }
        let done = done.min(1.0);
        let part = done - self.done;
        if let Some(corner) = corner.filter(|corner| *corner < self.start + done * self.size) {
            return Target {
                done: (corner - self.start) / self.size,
                length: corner - time,
                recurring: false,
                time: corner,
            };
        }
        Target {
            done,
            length: part * self.size,
            recurring: part == (part.log2().round()).exp2(),
            time: if done == 1.0 {
                self.start + self.size
            } else {
                self.start + done * self.size
            },
        }
    }
}

impl Model {
    /// Advances the state over the communication step from `time` to `time + size` (s) with the inputs held.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then unchanged.
    pub fn step(
        &self,
        state: &mut State,
        cache: &mut Cache,
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
        let mut work = *state;
        work.time = time;
        work.current = inputs.contact_current;
        let target = inputs.support_displacement - self.initial_support;
        let drive = Drive::new(inputs, target, &work, size);
        self.set_support_rate(&mut work, drive.support_rate);
        let mut progress = Progress {
            start: time,
            size,
            done: 0.0,
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of steps, saturating"
        )]
        let budget = BUDGET.saturating_add((size * BUDGET_RATE) as u64);
        let limit = work.steps + work.rejected_steps + budget;
        while progress.done < 1.0 {
            if work.steps + work.rejected_steps >= limit {
                return Err(StepError {
                    time: work.time,
                    cause: StepErrorCause::Budget(budget),
                });
            }
            self.advance(&mut work, cache, &drive, &mut progress)?;
        }
        work.support = target;
        *state = work;
        Ok(())
    }

    /// One integration step, taken or rejected.
    fn advance(
        &self,
        state: &mut State,
        cache: &mut Cache,
        drive: &Drive,
        progress: &mut Progress,
    ) -> Result<(), StepError> {
        let tolerance = self.scene.solver.effective_tolerance() * self.force_scale;
        let newton = 1e-2 * tolerance;
        let shortest = 8.0 * f64::EPSILON * (progress.start.abs() + progress.size);
        let wanted = state.next_step.min(self.longest_step).max(shortest);
        let mut target = progress.target(wanted, state.time, self.generator.next_break(state.time));

        let (step, collocation) = cache.get(target.length, target.recurring, &self.modes);
        let trial = self.trial(state, drive, step, collocation, newton);
        let ratio = trial
            .as_ref()
            .map_or(f64::INFINITY, |trial| trial.error / (SHARE * tolerance));
        let Some(mut trial) = trial.filter(|_| ratio <= 1.0 || target.length <= 2.0 * shortest) else {
            if target.length <= 2.0 * shortest || ratio.is_nan() {
                return Err(StepError {
                    time: state.time,
                    cause: StepErrorCause::NotFinite,
                });
            }
            state.rejected_steps += 1;
            state.iterations += trial_iterations(trial.as_ref());
            state.next_step = target.length * (0.8 * ratio.powf(-1.0 / ORDER)).clamp(0.1, 0.5);
            return Ok(());
        };

        let event = if state.closed {
            let open = self.first_open(state, &trial, collocation);
            open.map(|x| self.release(state, cache, drive, x * target.length, newton))
        } else {
            self.touchdown(state, cache, drive, target.length, &trial)
        };
        let mut closes = state.closed;
        if let Some((length, event_trial, changes)) = event {
            let Some(event_trial) = event_trial else {
                state.rejected_steps += 1;
                state.next_step = 0.25 * target.length;
                return Ok(());
            };
            trial = event_trial;
            if length < target.length {
                target = Target {
                    done: progress.done + length / progress.size,
                    length,
                    recurring: false,
                    time: state.time + length,
                };
                if target.done >= 1.0 {
                    target.done = 1.0;
                    target.time = progress.start + progress.size;
                }
            }
            closes = state.closed != changes;
        }
        if !(trial.indentation.is_finite() && trial.rate.is_finite()) {
            return Err(StepError {
                time: state.time,
                cause: StepErrorCause::NotFinite,
            });
        }
        let grown = target.length * (0.9 * ratio.powf(-1.0 / ORDER)).clamp(0.5, 4.0);
        // A step cut short by the grid says nothing against the length wanted before.
        let next = if target.length < 0.9 * wanted {
            grown.max(wanted)
        } else {
            grown
        };
        self.take(state, &trial, &target, next);
        progress.done = target.done;
        if closes != state.closed {
            self.switch(state, closes, tolerance);
        }
        Ok(())
    }

    /// The trial becomes the state.
    fn take(&self, state: &mut State, trial: &Trial, target: &Target, next_step: f64) {
        state.modes = trial.modes;
        state.time = target.time;
        state.support = trial.support;
        state.indentation = trial.indentation;
        state.indentation_rate = trial.rate;
        state.force = if state.closed {
            self.hertz
                .force(self.preload.indentation + trial.indentation, trial.rate)
        } else {
            0.0
        };
        state.nodal_forces = trial.forces;
        state.last_step = target.length;
        state.next_step = next_step;
        state.steps += 1;
        state.iterations += trial.iterations;
    }

    /// The contact opens or closes at the instant of the state.
    fn switch(&self, state: &mut State, closed: bool, tolerance: f64) {
        state.closed = closed;
        state.force = 0.0;
        state.last_step = 0.0;
        if closed {
            state.last_closing = state.time;
            state.next_step = state.next_step.min(self.first_closed_step(state, SHARE * tolerance));
        } else {
            state.last_opening = state.time;
            state.next_step = state.next_step.max(0.1 * self.first_step());
        }
    }

    /// A new velocity of the fixed contact changes the dissipative force at once.
    fn set_support_rate(&self, state: &mut State, rate: f64) {
        let jump = rate - state.support_rate;
        if jump == 0.0 {
            return;
        }
        state.support_rate = rate;
        state.indentation_rate += jump;
        let d = self.preload.indentation + state.indentation;
        let force = self.hertz.force(d, state.indentation_rate);
        let closed = force > 0.0;
        if closed != state.closed {
            self.switch(
                state,
                closed,
                self.scene.solver.effective_tolerance() * self.force_scale,
            );
        }
        state.force = force;
        state.last_step = 0.0;
        state.next_step = state
            .next_step
            .min(self.first_closed_step(state, self.scene.solver.effective_tolerance() * self.force_scale));
    }

    /// The step that ends at the release, sought up to `latest` seconds from the state; with whether it is one (a dip of the
    /// polynomial may turn out not to reach zero).
    fn release(
        &self,
        state: &State,
        cache: &mut Cache,
        drive: &Drive,
        latest: f64,
        newton: f64,
    ) -> (f64, Option<Trial>, bool) {
        let mut at = |length: f64| {
            let (step, collocation) = cache.get(length, false, &self.modes);
            self.trial(state, drive, step, collocation, newton)
        };
        let start = self
            .hertz
            .engagement(self.preload.indentation + state.indentation, state.indentation_rate);
        let value = |trial: Option<Trial>| trial.map_or(f64::NAN, |trial| self.engagement(&trial));
        let end = at(latest);
        if end.is_some_and(|end| self.engagement(&end) > 0.0) {
            return (latest, end, false);
        }
        let f = |length: f64| {
            if length > 0.0 {
                value(at(length))
            } else {
                start.max(f64::MIN_POSITIVE)
            }
        };
        let length = crate::math::roots::bracketed(f, 0.0, latest).unwrap_or(latest);
        (length, at(length), true)
    }

    /// The step of free flight that ends where the contact closes, if it does within `length` seconds.
    fn touchdown(
        &self,
        state: &State,
        cache: &mut Cache,
        drive: &Drive,
        length: f64,
        trial: &Trial,
    ) -> Option<(f64, Option<Trial>, bool)> {
        let d0 = self.preload.indentation;
        let mut samples = [Sample {
            at: 0.0,
            d: d0 + state.indentation,
            rate: state.indentation_rate,
        }; NODES + 2];
        let nodes = cache.collocation().nodes;
        let inner = nodes.iter().zip(trial.indentations.iter().zip(&trial.rates));
        let end = (1.0, (trial.indentation, trial.rate));
        let known = inner
            .map(|(node, (d, rate))| (*node, (*d, *rate)))
            .chain(std::iter::once(end));
        for (sample, (node, (d, rate))) in samples.iter_mut().skip(1).zip(known) {
            *sample = Sample {
                at: node * length,
                d: d0 + d,
                rate,
            };
        }
        let mut at = |length: f64| {
            let (step, collocation) = cache.get(length, false, &self.modes);
            self.trial(state, drive, step, collocation, 0.0)
        };
        let mut sample = |at_time: f64| {
            at(at_time).map_or(
                Sample {
                    at: at_time,
                    d: f64::NAN,
                    rate: 0.0,
                },
                |trial| Sample {
                    at: at_time,
                    d: d0 + trial.indentation,
                    rate: trial.rate,
                },
            )
        };
        // An overlap whose force is lost in the tolerance need not be found.
        let negligible = self
            .hertz
            .indentation(1e-3 * self.scene.solver.effective_tolerance() * self.force_scale);
        let touch = self.first_touch(&samples, -negligible, &mut sample)?;
        if touch <= 0.0 {
            return None;
        }
        Some((touch, at(touch), true))
    }

    /// First step after the surfaces meet, s. The dissipative force starts as the square root of time, which no polynomial
    /// follows: the step is chosen so short that what it misses moves the contact by less than the limit (N).
    fn first_closed_step(&self, state: &State, limit: f64) -> f64 {
        let d = (self.preload.indentation + state.indentation).max(0.0);
        let speed = state.indentation_rate.abs();
        let mobility: f64 = self.modes.iter().map(|mode| mode.tip * mode.tip).sum();
        let mut h = self.first_step();
        for _ in 0..40 {
            let depth = d + speed * h;
            let law = self.hertz.closed_branch(depth, state.indentation_rate);
            let gain = mobility * h * (law.damping + 0.5 * h * law.stiffness.abs());
            if 0.1 * (law.force - state.force).abs() * gain / (1.0 + gain) <= limit {
                break;
            }
            h *= 0.5;
        }
        h
    }
}

fn trial_iterations(trial: Option<&Trial>) -> u64 {
    trial.map_or(0, |trial| trial.iterations)
}
