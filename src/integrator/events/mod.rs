//! Events: openings, closings, interruptions and jumps of the force. Steps end at an event, and integration restarts
//! there.

pub mod closing;
pub mod interruption;
pub mod log;
pub mod opening;
pub mod other;

use crate::error::StepError;
use crate::integrator::collocation::step::Trial;
use crate::integrator::events::log::Event;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace};

/// A step shortened to end at an event.
pub(crate) struct Cut {
    /// Its length, s.
    pub(crate) length: f64,
    /// Whether the contact opens or closes at its end.
    pub(crate) switches: bool,
    /// Whether it is the other contact that closes.
    pub(crate) mirrors: bool,
}

impl Integration<'_> {
    /// Where in the step the contact may first open or close, 0 to 1.
    pub(crate) fn first_event_candidate<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        if self.state.closed {
            self.first_open(trial)
        } else {
            let own = self.first_near(trial, length);
            let other = self.toward_other(trial, length, |it, image| it.first_near(image, length));
            own.into_iter().chain(other).reduce(f64::min)
        }
    }

    /// Locates the event suspected at the part `candidate` of the step of `length` seconds; `None` if the step need not
    /// be shortened.
    pub(crate) fn cut<const S: usize>(&mut self, candidate: f64, trial: &Trial<S>, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        if self.state.closed {
            self.opening::<S>(candidate * length, length)
        } else {
            let own = self.closing(trial, length);
            let other = self.toward_other(trial, length, |it, image| it.closing(image, length));
            let other = other.map(|cut| Cut {
                // The other contact is a gap away: time advances.
                length: cut.length.max(self.resolution()),
                mirrors: true,
                ..cut
            });
            own.into_iter()
                .chain(other)
                .reduce(|a, b| if b.length < a.length { b } else { a })
        }
    }

    /// A step that ends at the cut, accepted or rejected, in place of one of `requested` seconds with the growth factor
    /// `growth`.
    pub(crate) fn end_at<const S: usize>(
        &mut self,
        cut: &Cut,
        growth: f64,
        requested: f64,
    ) -> Result<StepOutcome, StepError>
    where
        Workspace: Room<S>,
    {
        if cut.length <= 0.0 {
            // The event is at the start of the step.
            let length = self.switch(!self.state.closed);
            return Ok(self.reject(length));
        }
        let target = self.grid.cut(cut.length, self.state.time + cut.length);
        let attempt = self.attempt::<S>(&target);
        let Some(trial) = attempt.filter(|trial| self.is_acceptable(self.relative_error(trial, &target), &target))
        else {
            // Close to the event the law may vary too fast for one step up to it.
            if self.is_shortest(&target) {
                return self.take_with_constant_force(&target);
            }
            return Ok(self.reject(0.5 * target.length));
        };
        self.take(&trial, &target)?;
        if cut.mirrors {
            self.mirror();
        }
        if cut.switches {
            return Ok(StepOutcome {
                taken: true,
                // The step size starts anew after an event.
                growth: f64::INFINITY,
                length: self.switch(!self.state.closed),
            });
        }
        Ok(StepOutcome::after(target.length, requested, growth))
    }

    /// Opens or closes the contact at the instant of the state; returns the length of the next step, s.
    pub(crate) fn switch(&mut self, closed: bool) -> f64 {
        self.state.closed = closed;
        self.state.force_error.begin(&self.model.modes);
        self.workspace.events.record(Event {
            time: self.state.time,
            closes: closed,
            second: self.state.mirrored,
        });
        self.state.force = 0.0;
        self.state.last_step = 0.0;
        if closed {
            self.state.last_kink = self.state.time;
            self.state.last_closing = self.state.time;
            self.first_closed_step()
        } else {
            self.state.last_opening = self.state.time;
            self.step_after_jump()
        }
    }

    /// Applies a jump of the velocity of the fixed contact, with which the dissipative force jumps.
    pub(crate) fn set_support_rate(&mut self) {
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
        self.state.last_kink = self.state.time;
        self.state.last_step = 0.0;
        let next = self.first_closed_step();
        self.state.short_step = self.state.short_step.min(next);
        self.state.long_step = self.state.long_step.min(next);
    }

    /// First step after an acceleration has jumped or bent, s.
    pub(crate) fn step_after_jump(&self) -> f64 {
        0.1 * self.model.first_step(self.state.time)
    }

    /// First step after closing, s. The dissipative force starts as the square root of time, which no polynomial
    /// approximates well: the step is so short that its error moves the force by less than the error allowed per step.
    fn first_closed_step(&self) -> f64 {
        let Self { model, state, .. } = self;
        let d = model.preload.indentation + state.indentation;
        let speed = state.indentation_rate.abs();
        let mobility = model.mobility();
        let mut h = model.first_step(state.time);
        for _ in 0..40 {
            let law = model.law.closed_branch(d + speed * h, state.indentation_rate);
            let gain = mobility * h * (law.damping + 0.5 * h * law.stiffness.abs());
            if 0.1 * (law.force - state.force).abs() * gain / (1.0 + gain) <= self.allowed {
                break;
            }
            h *= 0.5;
        }
        h
    }
}
