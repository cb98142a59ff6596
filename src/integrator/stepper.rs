//! An integration in progress, and what is done with one step on trial: it is computed, judged and committed.

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::error::of_rounding;
use crate::integrator::collocation::part::Whole;
use crate::integrator::collocation::step::compute;
use crate::integrator::collocation::trial::{Source, Trial};
use crate::integrator::commit::commit;
use crate::integrator::constants::{
    DRIVEN, FREE_ROUNDING, INHERITED, ITERATIONS, MANY_STEPS, MOTION_ROUNDING, ROUNDED, SAFETY,
};
use crate::integrator::energy::{balance, conservation};
use crate::integrator::events::interruption::Passages;
use crate::integrator::events::{Event, Locator};
use crate::integrator::grid::{Grid, Target};
use crate::integrator::recorder::Recorder;
use crate::integrator::step_length::{StepOutcome, error_of_growth};
use crate::integrator::transition;
use crate::integrator::workspace::{Room, Rooms, Workspace, work};
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::state::State;

/// An integration in progress.
pub(crate) struct Stepper<'a> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a mut State,
    pub(crate) workspace: &'a mut Workspace,
    pub(crate) drive: Drive,
    pub(crate) grid: Grid,
    pub(crate) recorder: Recorder<'a>,
    pub(crate) progress: Progress,
}

/// How it goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Progress {
    /// Successive rejected steps.
    pub(crate) refusals: u32,
    /// Whether one of them was too long to end at an event inside.
    pub(crate) before_event: bool,
    /// Changes between stick and slip in succession that took no time.
    pub(crate) changes: u32,
    /// Whether an input has changed as the communication step began, in a contact that is closed since the beginning.
    pub(crate) driven: bool,
    /// Whether the energy changes only by the work of the drive ([`crate::integrator::energy::conservation`]).
    pub(crate) conserves: bool,
}

/// Rounding of time from `start` over `size` (s): spacing of floating-point numbers, s.
pub(crate) fn resolution(start: f64, size: f64) -> f64 {
    f64::EPSILON * (start.abs() + size)
}

impl<'a> Stepper<'a> {
    /// At the start of a grid.
    pub(crate) fn new(
        model: &'a Model,
        state: &'a mut State,
        workspace: &'a mut Workspace,
        drive: Drive,
        grid: Grid,
        recorder: Recorder<'a>,
    ) -> Self {
        Self { model, state, workspace, drive, grid, recorder, progress: Progress::default() }
    }

    /// Does something with the room for a trial.
    #[inline(always)]
    pub(super) fn with_trial<const S: usize, R>(&mut self, work: impl FnOnce(&mut Self, &mut Trial<S>) -> R) -> R
    where
        Workspace: Rooms<S>,
    {
        let (room, _): (&mut Room<S>, _) = self.workspace.parts();
        let mut trial = room.trial.take().unwrap_or_else(bytemuck::zeroed_box);
        let outcome = work(self, &mut trial);
        let (room, _): (&mut Room<S>, _) = self.workspace.parts();
        room.trial = Some(trial);
        outcome
    }

    /// Computes a trial step to the target.
    pub(super) fn compute<const S: usize>(&mut self, trial: &mut Trial<S>, target: &Target) -> Option<()>
    where
        Workspace: Rooms<S>,
    {
        let Self { model, state, workspace, drive, .. } = self;
        let (room, search) = workspace.parts();
        search.looked = None;
        let Room { cache, scratch, .. } = room;
        let prepared = cache.prepare(state.time, target.length, target.recurring, model);
        let source = Source::Laws(model.tolerance.newton);
        let computed = compute(model, state, drive, prepared, source, trial, scratch);
        let iterations = if computed.is_some() { trial.iterations } else { ITERATIONS };
        search.work += work::<S>(model, target.recurring) + iterations * (S * S) as u64;
        computed
    }

    /// Computes a trial step to the target. Returns its estimated error relative to the error allowed, infinite where the forces
    /// are not found: that from which the next length follows, and that by which it is accepted, with less of what the contact's
    /// damper takes back. Where it may be mere rounding, which no shorter step reduces: [`ROUNDED`] if it is too large, else at most that
    /// after which the next length of the grid follows.
    pub(super) fn judge<const S: usize>(&mut self, trial: &mut Trial<S>, target: &Target) -> [f64; 2]
    where
        Workspace: Rooms<S>,
    {
        if self.compute(trial, target).is_none() {
            return [f64::INFINITY; 2];
        }
        let (model, closed) = (self.model, self.state.is_closed());
        let whole = self.whole(trial, target.length);
        let allowed = whole.readable();
        let read = self.recorder.reads_before(target.time);
        let watched = model.scene.effects.extremes || model.counts_interruptions();
        // Inside steps with few nodes extremes lie after a change of the inputs, or a jump of the generated acceleration, or where the
        // force turns; else they may be inaccurate there, unless they are read.
        let jumps = self.state.lengths.last == 0.0 && !self.state.touches_now();
        let changed = self.progress.driven || self.drive.has_just_changed(self.state.time, target.length);
        let inside = if read || (changed || jumps) && watched && closed || (watched || !closed) && S != SHORT {
            whole.inaccuracy(allowed)
        } else if watched {
            whole.inaccuracy_of_turns() / allowed
        } else {
            0.0
        };
        let looks = closed && (watched || read);
        let law_residual = if looks { whole.law_residual(allowed, changed, read) / allowed } else { 0.0 };
        // It only rejects.
        let inside = if law_residual > 1.0 { inside.max(law_residual) } else { inside };
        let all = self.passing();
        let [ratio, own] = [all, all.min(INHERITED)].map(|share| {
            let ratio = trial.error.with(share) / model.tolerance.step.max(trial.rounding);
            // Not `max`, which would hide NaN.
            if ratio < inside { inside } else { ratio }
        });
        let of_inside = closed && ratio == inside;
        let (error, rounding) =
            if of_inside { (inside * allowed, FREE_ROUNDING) } else { (trial.error.total, MOTION_ROUNDING) };
        let fails = ratio > 1.0 && (closed || inside < 1.0);
        // What does not shrink with the step would keep one that is far too short from growing to the next length of the grid.
        let next = error_of_growth::<S>(self.grid.spacing() / SAFETY);
        let tries = of_inside || closed && self.state.steps.is_multiple_of(MANY_STEPS.into());
        let stays = tries && ratio <= 1.0 && ratio > next;
        if (fails || stays) && error <= of_rounding::<S>(model, self.state, trial, rounding) {
            [if fails { ROUNDED } else { next }; 2]
        } else {
            [ratio, own]
        }
    }

    /// A trial of `length` seconds, to look at.
    pub(super) fn whole<'b, const S: usize>(&'b self, trial: &'b Trial<S>, length: f64) -> Whole<'b, S>
    where
        Workspace: Rooms<S>,
    {
        let begun = (self.model, &*self.state, &self.drive);
        Rooms::<S>::room(self.workspace).whole(begun, trial, length)
    }

    /// For events in a trial of `length` seconds.
    pub(super) fn locator<'b, const S: usize>(&'b mut self, trial: &'b Trial<S>, length: f64) -> Locator<'b, S>
    where
        Workspace: Rooms<S>,
    {
        let resolution = self.resolution();
        let (room, search) = self.workspace.parts();
        Locator { whole: room.whole((self.model, self.state, &self.drive), trial, length), search, resolution }
    }

    /// Accepts the trial as the new state; `false` where it is too long to tell where its forces pass those of interruptions, unless
    /// that `must` be told.
    ///
    /// # Errors
    /// [`StepErrorCause::NotFinite`] where it is not finite.
    pub(super) fn commit<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        target: &Target,
        must: bool,
    ) -> Result<bool, StepError>
    where
        Workspace: Rooms<S>,
    {
        let mut passages = Passages::default();
        if !self.locator(trial, target.length).find_passages(must, &mut passages) {
            return Ok(false);
        }
        let mut links = self.model.links.iter().zip(&trial.links);
        if !links.all(|(_, nodes)| nodes.end.approach.is_finite() && nodes.end.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let expected = if self.model.scene.effects.energy {
            // The balance repeats the step in two halves.
            self.workspace.search.work += 2 * work::<LONG>(self.model, target.recurring);
            balance::expected_energy(self.model, self.state, &self.drive, self.workspace, trial, target)
        } else {
            None
        };
        if self.progress.conserves {
            let (surplus, _) = conservation::surplus(self.whole(trial, target.length));
            self.state.energy_surplus += surplus;
        }
        let passing = self.passing();
        let Self { model, state, workspace, drive, recorder, progress, .. } = self;
        let cache = &Rooms::<S>::room(*workspace).cache;
        state.force_error.add(trial.error.with(passing), model.force_scale);
        recorder.note_step((*model, &mut **state), cache.collocation, trial, target, &passages);
        let slip = commit(model, state, drive, cache, trial, target);
        if let (Some(dense), Some(slip)) = (&mut recorder.dense, slip) {
            dense.slip = slip;
        }
        self.grid.done = target.done;
        *progress = Progress { driven: progress.driven, conserves: progress.conserves, ..Progress::default() };
        if progress.conserves {
            conservation::settle(model, state, target.length);
        }
        if let Some(expected) = expected {
            state.energy_balance += expected - model.energy(state);
        }
        Ok(true)
    }

    /// Makes of the state what an event makes of it.
    pub(super) fn happen(&mut self, event: Event) {
        match event {
            Event::Switches(index) => {
                self.progress.driven = false;
                transition::switch(self.model, self.state, index, &mut self.workspace.events);
            }
            Event::Slides(phase) => transition::slide(self.model, self.state, phase),
            Event::Read | Event::Bends => {}
        }
    }

    /// Rejects a step; the next one shall have `length` (s).
    pub(super) fn reject(&mut self, length: f64) -> StepOutcome {
        self.state.rejected_steps += 1;
        self.progress.refusals += 1;
        StepOutcome { accepted: false, switched: false, growth: 1.0, length }
    }

    /// Factor on the error that the contact's damper takes back.
    pub(super) fn passing(&self) -> f64 {
        if self.progress.driven { DRIVEN } else { 1.0 }
    }

    /// Whether the step cannot be halved.
    pub(super) fn is_shortest(&self, target: &Target) -> bool {
        target.length <= 2.0 * self.shortest()
    }

    /// Shortest step, s.
    pub(super) fn shortest(&self) -> f64 {
        8.0 * self.resolution()
    }

    /// Rounding of time in the communication step, s.
    pub(super) fn resolution(&self) -> f64 {
        resolution(self.grid.start, self.grid.size)
    }

    pub(super) fn error(&self, cause: StepErrorCause) -> StepError {
        StepError { time: self.state.time, cause }
    }
}
