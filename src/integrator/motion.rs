//! Communication steps, and output between the integrator's own steps.
//!
//! Where communication steps are long, the integrator steps exactly to their ends. Where they are short (a circuit's)
//! or of ever new lengths, and what drives the contact goes on as before, the integrator goes its own way ahead of
//! them, in steps as long as the error allows, and the communication points lie inside a step: there the contact force
//! is read from the step's polynomial. An input that changes meanwhile takes the motion back to the communication
//! point, exactly, from the start of the step.

use crate::BARE;
use crate::beam::mode::MAX_MODES;
use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::inputs::Inputs;
use crate::integrator::budget::Budget;
use crate::integrator::events::log::Event;
use crate::integrator::extremes::Extremes;
use crate::integrator::step_control::Steps;
use crate::integrator::workspace::Workspace;
use crate::math::prediction::Prediction;
use crate::math::prediction::value_and_slope;
use crate::model::Model;
use crate::state::State;
use serde::{Deserialize, Serialize};

/// How many of the integrator's steps a communication step has to be long for the integrator to end one with it.
const MANY_STEPS: f64 = 4.0;

/// Everything that moves: the motion around a communication point. Plain numbers: saving it is a copy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// The communication point, s.
    pub time: f64,
    /// Current through the contact, A, and its rate over the last communication step, A/s.
    pub current: f64,
    /// See [`Course::current`].
    pub current_rate: f64,
    /// Length of the last communication step, s.
    size: f64,
    /// Extremes of the contact force in it, but for what lies in [`Course::span`] inside which it ends, N; none where all
    /// of it does or nobody asks.
    extremes: Option<Extremes>,
    /// What drove the contact over it.
    drive: Drive,
    /// The motion at the communication point, or before it where the integrator is ahead.
    start: State,
    /// Where the integrator is.
    end: State,
    /// The tip in between.
    span: Span,
}

/// The tip over a step: polynomials about its end, in steps. Deviations from the preload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Span {
    /// Whether they are within the tolerance; just after a blow no polynomial is.
    pub good: bool,
    /// Contact force, N.
    pub force: Prediction,
    /// Indentation, m.
    pub indentation: Prediction,
    /// Its velocity, m/s.
    pub rate: Prediction,
}

/// The tip at a communication point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Contact force, N.
    pub force: f64,
    /// Indentation minus preload indentation, m.
    pub indentation: f64,
    /// Its velocity, m/s.
    pub rate: f64,
}

/// How the tip changes at a communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TipRates {
    /// Rate of the contact force, N/s.
    pub force: f64,
    /// Second derivative of the indentation, m/s2.
    pub acceleration: f64,
}

impl Course {
    /// From a state on.
    pub fn new(state: State) -> Self {
        Self {
            time: state.time,
            current: 0.0,
            current_rate: 0.0,
            size: 0.0,
            extremes: None,
            drive: Drive::default(),
            start: state,
            end: state,
            span: Span::default(),
        }
    }

    /// The last state that the integrator has reached by the communication point, at or before it.
    pub fn state(&self) -> &State {
        if self.end.time <= self.time {
            &self.end
        } else {
            &self.start
        }
    }

    /// Whether every number is one that a simulation can have come to.
    pub fn is_sound(&self) -> bool {
        let Self {
            time,
            current,
            current_rate,
            size,
            extremes,
            drive,
            start,
            end,
            span,
        } = self;
        let polynomials = [&span.force, &span.indentation, &span.rate].into_iter().flatten();
        let numbers = [*time, *current, *current_rate, *size, drive.jerk, drive.support_rate];
        let extremes = extremes
            .iter()
            .flat_map(|extremes| [&extremes.least, &extremes.greatest]);
        let driven = drive.acceleration(start.time);
        numbers
            .iter()
            .chain(extremes)
            .chain(polynomials)
            .all(|number| number.is_finite())
            && driven.is_finite()
            && *size >= 0.0
            && start.is_sound()
            && end.is_sound()
            && start.time <= *time
            && (start == end && end.time == *time || start.time < end.time && *time <= end.time)
    }

    /// The event that the integrator has met beyond the communication point.
    pub fn event_ahead(&self) -> Option<Event> {
        let ahead = self.end.time > self.time && self.end.closed != self.start.closed;
        ahead.then_some(Event {
            time: self.end.time,
            closes: self.end.closed,
        })
    }

    /// Whether the communication point lies inside a step of the integrator: how far before its end, in steps.
    fn inside(&self) -> Option<f64> {
        let from_end = self.time - self.end.time;
        (from_end < 0.0).then(|| from_end / self.length())
    }

    /// Length of the step that [`Course::span`] tells of, s.
    fn length(&self) -> f64 {
        self.end.time - self.start.time
    }

    /// The tip at the communication point.
    pub fn tip(&self, model: &Model) -> Tip {
        let state = self.state();
        let Some(y) = self.inside() else {
            return Tip {
                force: state.force,
                indentation: state.indentation,
                rate: state.indentation_rate,
            };
        };
        let at = |values| value_and_slope(values, y).0;
        let force = model.preload.force + at(&self.span.force);
        Tip {
            force: match state.closed {
                true if model.law.never_opens() => force,
                true => force.max(f64::MIN_POSITIVE),
                false => 0.0,
            },
            indentation: at(&self.span.indentation),
            rate: at(&self.span.rate),
        }
    }

    /// Extremes of the contact force within the last communication step, N, where the scene asks for them.
    pub fn extremes(&self, model: &Model) -> Extremes {
        let mut extremes = self.extremes.unwrap_or_else(|| Extremes::at(self.tip(model).force));
        if self.time < self.end.time {
            self.add_span(&mut extremes, model, self.time - self.size, self.time);
        }
        extremes
    }

    /// Adds what the force does in the span between two instants (s), of which the first may lie before it.
    fn add_span(&self, extremes: &mut Extremes, model: &Model, from: f64, to: f64) {
        let at = |time: f64| ((time - self.end.time) / self.length()).clamp(-1.0, 0.0);
        extremes.add_course(model, self.start.closed, &self.span.force, at(from), at(to));
    }

    /// How the tip changes at the communication point, as it has been reached: what changes there at once comes after.
    pub fn tip_rates(&self, model: &Model) -> TipRates {
        let state = self.state();
        if self.size == 0.0 {
            return TipRates::default();
        }
        if let Some(y) = self.inside() {
            let slope = |values| value_and_slope(values, y).1 / self.length();
            return TipRates {
                force: if state.closed { slope(&self.span.force) } else { 0.0 },
                acceleration: slope(&self.span.rate),
            };
        }
        let base = self.drive.acceleration(self.time) + model.generator.acceleration_before(self.time);
        let force = state.force - model.preload.force;
        let axial = match model.axial() {
            Some(axial) => axial.loads(&model.modes, &state.modes),
            None => [0.0; MAX_MODES],
        };
        let modes = model.modes.iter().zip(&state.modes).zip(&axial);
        let acceleration = modes.fold(0.0, |sum, ((mode, at), axial)| {
            let load = mode.tip * force - mode.participation * base + axial;
            sum - mode.tip * (load - mode.omega_squared * at.q - mode.damping * at.v)
        });
        let rate = state.indentation_rate;
        let law = model
            .law
            .closed_branch(model.preload.indentation + state.indentation, rate);
        TipRates {
            force: if state.closed {
                law.stiffness * rate + law.damping * acceleration
            } else {
                0.0
            },
            acceleration,
        }
    }
}

impl Model {
    /// Advances over the communication step from `time` to `time + size` (s) with inputs that are held or change linearly.
    ///
    /// # Errors
    /// A [`StepError`]; the course then stands where it did.
    pub fn step(
        &self,
        course: &mut Course,
        workspace: &mut Workspace,
        inputs: &Inputs,
        time: f64,
        size: f64,
    ) -> Result<(), StepError> {
        if self.scene.effects.extremes && !BARE {
            self.step_by::<true>(course, workspace, inputs, (time, size))
        } else {
            self.step_by::<false>(course, workspace, inputs, (time, size))
        }
    }

    /// [`Model::step`], with the extremes or without.
    fn step_by<const EXTREMES: bool>(
        &self,
        course: &mut Course,
        workspace: &mut Workspace,
        inputs: &Inputs,
        (time, size): (f64, f64),
    ) -> Result<(), StepError> {
        let until = time + size;
        if !(size > 0.0 && size.is_finite() && until.is_finite()) {
            return Err(StepError {
                time,
                cause: StepErrorCause::StepSize,
            });
        }
        // Where a point comes early by more than the step is long, time stands still.
        let until = until.max(course.time);
        // Lengths that differ by the rounding of time are one, but for exact steps.
        let size = if self.closed_loop.is_none() && (size - course.size).abs() <= f64::EPSILON * until.abs() {
            course.size
        } else {
            size
        };
        let since = course.time;
        workspace.events.forget_until(since);
        // The fixed contact moves linearly to where the input leads.
        let support = inputs.support_displacement_after(size) - self.initial_support;
        let drive = Drive::new(inputs, time, size, support - course.state().support);
        let steady = drive.continues(&course.drive) && self.closed_loop.is_none();
        let ahead = course.time < course.end.time;
        // Nothing is integrated: what is read of the step is computed when it is read.
        let inside = steady && until < course.end.time;
        let mut extremes = (EXTREMES && !inside).then(|| Extremes::at(course.tip(self).force));
        let reach = course.end.short_step.max(course.end.long_step);
        if steady && (ahead || size < reach || size < MANY_STEPS * reach && size != course.size) {
            if !inside {
                let left = until - course.end.time;
                if left < MANY_STEPS * reach {
                    self.go_ahead(course, workspace, until, extremes.as_mut())?;
                } else {
                    let (mut end, time) = (course.end, course.end.time);
                    let steps = Steps::Exactly { time, size: left };
                    if let Some(extremes) = &mut extremes {
                        course.add_span(extremes, self, since, time);
                    }
                    self.advance(&mut end, workspace, course.drive, steps, extremes.as_mut())?;
                    end.time = until;
                    (course.start, course.end) = (end, end);
                }
            }
        } else {
            let before = ahead.then_some((course.start, course.end));
            if ahead {
                course.end = self.state(course, workspace)?;
                course.start = course.end;
                workspace.events.forget_after(since);
            }
            let steps = Steps::Exactly { time, size };
            if let Err(error) = self.advance(&mut course.end, workspace, drive, steps, extremes.as_mut()) {
                (course.start, course.end) = before.unwrap_or((course.start, course.start));
                workspace.events.forget_after(since);
                return Err(error);
            }
            course.end.support = support;
            course.end.time = until;
            course.start = course.end;
            course.drive = drive;
        }
        course.size = size;
        if EXTREMES {
            course.extremes = extremes;
        }
        course.time = until;
        course.current = inputs.contact_current_after(size);
        course.current_rate = inputs.contact_current_rate;
        Ok(())
    }

    /// The whole motion at the communication point.
    ///
    /// # Errors
    /// A [`StepError`] where it cannot be found.
    pub fn state(&self, course: &Course, workspace: &mut Workspace) -> Result<State, StepError> {
        let mut state = *course.state();
        let (time, size) = (state.time, course.time - state.time);
        if size > 0.0 {
            let steps = Steps::Exactly { time, size };
            self.advance(&mut state, workspace, course.drive, steps, None)?;
        }
        Ok(state)
    }

    /// Advances the integrator by its own steps until it is at `time` (s) or ahead of it. Extremes are those up to the
    /// end of the last step that lies before.
    fn go_ahead(
        &self,
        course: &mut Course,
        workspace: &mut Workspace,
        time: f64,
        mut extremes: Option<&mut Extremes>,
    ) -> Result<(), StepError> {
        let since = course.time;
        let mut ahead = *course;
        if let Some(extremes) = &mut extremes
            && since < ahead.end.time
        {
            ahead.add_span(extremes, self, since, ahead.end.time);
            extremes.add(ahead.end.force);
        }
        let budget = Budget::new(workspace, time - since);
        while ahead.end.time < time {
            budget.check(workspace, ahead.end.time)?;
            ahead.start = ahead.end;
            let steps = Steps::Own {
                until: time,
                span: &mut ahead.span,
            };
            self.advance(&mut ahead.end, workspace, ahead.drive, steps, None)?;
            if let Some(extremes) = &mut extremes
                && ahead.end.time <= time
            {
                ahead.add_span(extremes, self, since, ahead.end.time);
                extremes.add(ahead.end.force);
            }
        }
        if ahead.end.time > time && !ahead.span.good {
            ahead.end = ahead.start;
            workspace.events.forget_after(ahead.end.time);
            let (start, size) = (ahead.end.time, time - ahead.end.time);
            let steps = Steps::Exactly { time: start, size };
            self.advance(&mut ahead.end, workspace, ahead.drive, steps, extremes)?;
        }
        *course = ahead;
        Ok(())
    }
}
