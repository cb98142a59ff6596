//! Events: openings, closings, interruptions and jumps of the force. A step ends where the contact opens or closes, and
//! integration restarts there; where an interruption begins or ends it goes on.

pub mod closing;
pub mod interruption;
pub mod log;
pub mod opening;
pub mod other;

use crate::error::StepError;
use crate::friction::Phase;
use crate::integrator::collocation::error::sum_rounding;
use crate::integrator::collocation::part::Instant;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::{GUESSES, LOCATED, MOST_SHRINK};
use crate::integrator::events::log::Event;
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal;
use crate::math::prediction::value_and_slope;
use crate::math::roots;
use crate::model::Model;
use crate::state::State;

/// The end of a step inside the trial that was made for it.
pub(crate) struct Cut {
    /// The motion there, looked at last.
    pub(crate) end: Instant,
    /// The instant, s.
    pub(crate) time: f64,
    /// Whether the contact opens or closes there.
    pub(crate) switches: bool,
    /// Whether it is the other contact that closes.
    pub(crate) mirrors: bool,
    /// Whether the contact begins or ceases to slip, and how it goes on.
    pub(crate) slides: Option<Phase>,
}

impl Integration<'_> {
    /// The end of a step at an instant inside it.
    pub(crate) fn cut(&self, end: Instant, switches: bool) -> Cut {
        Cut {
            time: self.state.time + end.at,
            end,
            switches,
            mirrors: false,
            slides: None,
        }
    }

    /// The instant in a trial of `length` seconds at which `value` of indentation and velocity changes its sign, between
    /// `from` (s, value) and `latest` (s); it need not. To the spacing of floating-point numbers or to a value that is mere
    /// `rounding`: on the polynomials of the tip, then on the exact motion under the force polynomial.
    pub(crate) fn instant<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        length: f64,
        value: impl Fn(f64, f64) -> f64,
        from: (f64, f64),
        latest: f64,
        rounding: f64,
    ) -> Instant
    where
        Workspace: Room<S>,
    {
        let (d, rate) = (self.state.indentation, self.state.indentation_rate);
        let simd = self.model.simd;
        let collocation = self.collocation::<S>();
        let (d, rate) = (
            collocation.through(simd, d, &trial.indentations),
            collocation.through(simd, rate, &trial.rates),
        );
        let on_polynomials = |at: f64| {
            let y = at / length - 1.0;
            value(value_and_slope(&d, y).0, value_and_slope(&rate, y).0)
        };
        let end = (latest, on_polynomials(latest));
        let guess = roots::between(on_polynomials, from, end, 1e-12 * length);
        let at = guess.unwrap_or(latest);
        let near = at - 1e-4 * (at - from.0);
        let slope = (on_polynomials(at) - on_polynomials(near)) / (at - near);
        let exact = |_: &mut Self, now: &Instant| value(now.d, now.rate);
        self.refined(trial, length, exact, from, (at, slope), latest, rounding)
    }

    /// The same on the exact motion, from a guess and the slope there (1/s times the value).
    #[expect(clippy::too_many_arguments, reason = "as many as of what it refines")]
    pub(crate) fn refined<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        length: f64,
        value: impl Fn(&mut Self, &Instant) -> f64,
        from: (f64, f64),
        (mut at, mut slope): (f64, f64),
        latest: f64,
        rounding: f64,
    ) -> Instant
    where
        Workspace: Room<S>,
    {
        let resolution = self.resolution();
        let (mut low, mut high, mut last) = (from, None, None);
        for _ in 0..GUESSES {
            let now = self.inside(trial, length, at);
            let found = value(self, &now);
            let beyond = (found > 0.0) != (from.1 > 0.0);
            if found.abs() <= rounding || at == latest && !beyond {
                return now;
            }
            if beyond {
                high = Some((at, found));
            } else {
                low = (at, found);
            }
            if let Some((at_last, last)) = last {
                slope = (found - last) / (at - at_last);
            }
            let (next, highest) = (at - found / slope, high.map_or(latest, |(at, _)| at));
            let next = match high {
                _ if low.0 < next && next < highest => next,
                None => latest,
                Some(_) => f64::midpoint(low.0, highest),
            };
            if (next - at).abs() <= resolution {
                return now;
            }
            last = Some((at, found));
            at = next;
        }
        let exact = |at: f64| {
            let now = self.inside(trial, length, at);
            value(self, &now)
        };
        let found = high.and_then(|high| roots::between(exact, low, high, resolution));
        self.inside(trial, length, found.unwrap_or(latest))
    }

    /// Engagement that counts as zero where the contact opens, m.
    pub(crate) fn located(&self) -> f64 {
        let stiffness = self.model.law.tangent_stiffness(self.model.force_scale);
        (LOCATED * self.allowed / stiffness).max(motion_rounding(self.model, self.state))
    }

    /// Takes the trial to `target` up to a cut, in place of a step of `requested` seconds with the growth factor `growth`.
    pub(crate) fn end_at<const S: usize>(
        &mut self,
        cut: &Cut,
        trial: &Trial<S>,
        target: &Target,
        growth: f64,
        requested: f64,
    ) -> Result<StepOutcome, StepError>
    where
        Workspace: Room<S>,
    {
        if cut.end.at <= 0.0 {
            // The event is at the start of the step.
            if let Some(phase) = cut.slides {
                self.change_phase(phase);
                self.changes += 1;
                // Rounding must not let it change to and fro for ever.
                let shrink = if self.changes > 1 { MOST_SHRINK } else { 1.0 };
                let length = self.state.long_step.min(shrink * requested);
                return Ok(StepOutcome {
                    switched: true,
                    ..self.reject(length)
                });
            }
            self.switch(!self.state.closed);
            return Ok(StepOutcome {
                switched: true,
                ..self.reject(requested)
            });
        }
        let part = self.shorten(trial, target.length, &cut.end);
        let end = self.grid.cut(cut.end.at, cut.time);
        // Between the nodes the force of the law may miss that of the polynomial, most with a damper that is nearly rigid.
        let missed = (part.force - nodal::end(&part.forces)).abs();
        if !cut.switches && missed > self.tolerance && !self.is_shortest(target) {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
        let Some(passages) = self.passages(&part, end.length, self.is_shortest(target)) else {
            return Ok(self.reject(MOST_SHRINK * target.length));
        };
        self.take(&part, &end, passages)?;
        if cut.mirrors {
            self.mirror();
        }
        if let Some(phase) = cut.slides {
            self.change_phase(phase);
        }
        if cut.switches {
            self.switch(!self.state.closed);
        }
        let outcome = StepOutcome::after(target.length, requested, growth);
        let length = outcome.length.min(requested);
        Ok(StepOutcome {
            switched: cut.switches || cut.slides.is_some(),
            length: cut.slides.map_or(length, |_| self.state.long_step),
            ..outcome
        })
    }

    /// Opens or closes the contact at the instant of the state. Short steps begin anew.
    pub(crate) fn switch(&mut self, closed: bool) {
        self.state.closed = closed;
        self.driven = false;
        self.state.force_error.begin(&self.model.modes);
        self.workspace.events.record(Event {
            time: self.state.time,
            closes: closed,
            second: self.state.mirrored,
        });
        let touch = self.model.law.power().filter(|_| closed);
        self.state.force = touch.map_or(0.0, |law| law.force_at_touch(self.state.indentation_rate));
        self.state.last_step = 0.0;
        self.state.short_step = if closed {
            self.state.last_kink = self.state.time;
            self.state.last_closing = Some(self.state.time);
            self.first_closed_step()
        } else {
            self.state.last_opening = Some(self.state.time);
            self.step_after_jump()
        };
        self.model.settle_friction(self.state);
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
        self.model.settle_friction(self.state);
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

/// Rounding of the engagement by the sums over the modes, m.
pub(crate) fn motion_rounding(model: &Model, state: &State) -> f64 {
    let (displacement, velocity) = sum_rounding(model.modes.iter().map(|mode| mode.tip), state);
    displacement + model.law.damping() * velocity
}
