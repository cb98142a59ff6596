//! Steps: a communication step, or one free step, as a sequence of integration steps with 4 or 8 nodes. A step is computed on
//! trial, judged, searched for events, and committed up to the first of them.

use crate::error::{StepError, StepErrorCause};
use crate::inputs::Inputs;
use crate::integrator::collocation::trial::Trial;
use crate::integrator::constants::{HALVINGS, MOST_SHRINK, SAFETY, STEP_GROWTH};
use crate::integrator::energy::conservation;
use crate::integrator::grid::{Grid, Target};
use crate::integrator::rest::rests_until;
use crate::integrator::step_length::{Proposal, StepOutcome, growth, shrinkage};
use crate::integrator::stepper::{Progress, Stepper};
use crate::integrator::transition;
use crate::integrator::with_contact;
use crate::integrator::workspace::{Rooms, Workspace};
use crate::math::nodal::{LONG, SHORT};
use crate::state::State;

/// Limit of the velocity of a body that an input moves, m/s.
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

impl Stepper<'_> {
    /// Takes steps to the end of the grid. `driven`: an input has just changed, in a contact that is closed since the beginning.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then undefined.
    pub(crate) fn run(&mut self, driven: bool) -> Result<(), StepError> {
        with_contact::leave(self.model, self.state);
        let conserves = conservation::conserves(self.model, &self.drive);
        // Without any damping errors add up over the more steps that this takes.
        self.progress = Progress { driven: driven && !conserves, conserves, ..Progress::default() };
        let mut speeds = Inputs::MOVING.iter().zip(self.drive.velocities);
        if let Some((input, speed)) = speeds.find(|(_, speed)| speed.abs() > SPEED_OF_LIGHT) {
            let input = input.variable().name;
            return Err(self.error(StepErrorCause::Speed { input, speed }));
        }
        transition::set_velocities(self.model, self.state, &self.drive, &mut self.workspace.events);
        transition::set_coil(self.model, self.state, self.drive.coil);
        self.recorder.note_forces(self.model, self.state);
        let steps = self.state.steps;
        let mut first = None;
        while self.grid.done < 1.0 {
            let before = self.state.time;
            self.advance()?;
            // What a search that gave up has not found is not passed over.
            self.workspace.search.check(before)?;
            if self.progress.driven && first.is_none() && self.state.steps > steps {
                first = Some((self.state.lengths.short, self.state.lengths.long));
            }
            self.recorder.note_forces(self.model, self.state);
            let Grid { free, done, .. } = self.grid;
            let end = self.grid.end();
            if !free
                && done < 1.0
                && let Some(until) = rests_until(self.model, self.state, &self.drive, end)
            {
                let target = self.grid.cut(until - self.state.time, until);
                (self.state.time, self.grid.done) = (target.time, target.done);
            }
        }
        if let Some((short, long)) = first {
            // The next change will need steps as short as this one.
            let lengths = &mut self.state.lengths;
            (lengths.short, lengths.long) = (lengths.short.min(short), lengths.long.min(long));
        }
        Ok(())
    }

    /// One integration step, accepted or rejected: with 4 nodes where they suffice, else with 8.
    fn advance(&mut self) -> Result<(), StepError> {
        if let Some(length) = self.leap_length() {
            return self.leap(length);
        }
        let remaining = self.grid.remaining();
        let closed = self.state.is_closed();
        let proposal = self.state.lengths.propose(closed, self.smooth(), remaining);
        let outcome = match proposal {
            Proposal::Short(length) => self.advance_with::<SHORT>(length)?,
            Proposal::Long(length) => self.advance_with::<LONG>(length)?,
        };
        let situation = (self.progress.driven, self.state.last_closing().is_some());
        let lengths = &mut self.state.lengths;
        lengths.keep(proposal, &outcome, closed, remaining, situation);
        Ok(())
    }

    /// One step with `S` nodes of at most `requested` seconds, accepted or rejected.
    fn advance_with<const S: usize>(&mut self, requested: f64) -> Result<StepOutcome, StepError>
    where
        Workspace: Rooms<S>,
    {
        let requested = requested.min(self.model.longest_step(self.state.time)).max(self.shortest());
        let corner = self.model.generator.next_break(self.state.time);
        let target = self.grid.target(requested, self.state.time, corner);
        self.with_trial(|stepper, trial: &mut Trial<S>| stepper.try_step(trial, &target, requested, corner))
    }

    /// The same with room for the trial, that ends at the latest at the discontinuity `corner` (s) of the excitation.
    fn try_step<const S: usize>(
        &mut self,
        trial: &mut Trial<S>,
        target: &Target,
        requested: f64,
        corner: Option<f64>,
    ) -> Result<StepOutcome, StepError>
    where
        Workspace: Rooms<S>,
    {
        let [ratio, own] = self.judge(trial, target);
        let closed = self.state.is_closed();
        let is_least = self.is_shortest(target) || closed && self.progress.refusals >= HALVINGS;
        // One that cannot be shorter is accepted with any finite error: what does not shrink with it is rounding.
        if !(own <= 1.0 || is_least && own.is_finite()) {
            if is_least && closed {
                // The collocation failed; use the discrete-gradient step.
                return self.take_with_constant_force(target);
            }
            if is_least {
                return Err(self.error(StepErrorCause::NotFinite));
            }
            return Ok(self.reject(target.length * shrinkage::<S>(ratio)));
        }
        // The energy may reveal an error that the estimate misses.
        let watches = self.progress.conserves && closed;
        if watches && !self.is_shortest(target) && conservation::is_broken(self.whole(trial, target.length)) {
            return Ok(self.reject(0.5 * target.length));
        }
        // From the error of the whole step, also if an event shortens it.
        let own_growth = growth::<S>(ratio);
        let (leaving, most) = self.leaving_kink(target.length);
        let growth = if self.progress.before_event { own_growth.min(1.0) } else { own_growth * leaving };
        let cut = match self.find_end(trial, target) {
            Ok(cut) => cut,
            Err(rejected) => return Ok(rejected),
        };
        if let Some(cut) = cut {
            return self.end_at(&cut, trial, target, (growth, most), requested);
        }
        let is_first = self.state.slip.last_change == Some(self.state.time);
        if !self.commit(trial, target, self.is_shortest(target))? {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
        if is_first {
            // After a change between stick and slip; so long is the next such step.
            let factor = own_growth.clamp(MOST_SHRINK, 1.0 / MOST_SHRINK);
            *self.state.lengths.after_change(self.state.slip.phase) = target.length * factor;
        }
        if corner.is_some_and(|corner| corner <= target.time) {
            // What the corner sets vibrating, the step sizes before it do not resolve.
            let next = transition::step_after_jump(self.model, self.state);
            let lengths = &mut self.state.lengths;
            (lengths.long, lengths.flight, lengths.last) = (lengths.long.min(next), lengths.flight.min(next), 0.0);
            return Ok(StepOutcome { accepted: true, switched: false, growth: 1.0, length: requested.min(next) });
        }
        Ok(StepOutcome::accepted(target.length, requested, (growth, most)))
    }

    /// Factor by which the next step may be longer for its distance from the last closing, or from where slip last began or ended, alone:
    /// with a damper the force there is smooth in the logarithm of the time since. Without one the spring rings on after slip. And the
    /// most that it may grow: the first step after such a change is far shorter than those that follow.
    fn leaving_kink(&self, length: f64) -> (f64, f64) {
        let State { time, last_kink, kink_is_closing, slip, .. } = *self.state;
        let elapsed = time - last_kink;
        let slides = self.model.law.damping > 0.0 && slip.last_change == Some(last_kink);
        let most = if slides { STEP_GROWTH * STEP_GROWTH } else { STEP_GROWTH };
        if slides && elapsed == 0.0 {
            (most, most)
        } else if (slides || kink_is_closing) && elapsed > 0.0 {
            ((SAFETY * (1.0 + length / elapsed)).max(1.0), most)
        } else {
            (1.0, most)
        }
    }
}
