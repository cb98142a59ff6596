//! Steps: a communication step, or one free step, as a sequence of integration steps with 4 or 8 nodes. A step is computed on
//! trial, judged, searched for events, and committed up to the first of them.

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::integrator::accuracy::inaccuracy;
use crate::integrator::collocation::error::is_rounding;
use crate::integrator::collocation::part::{Whole, shorten};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::compute;
use crate::integrator::collocation::trial::{LinkNodes, Source, Trial};
use crate::integrator::commit::{commit, follow_slip};
use crate::integrator::constants::{
    AFTER_BLOW, DRIVEN, HALVINGS, INHERITED, ITERATIONS, LEAST_LEAP, LEAST_SHRINK, MOST_CHANGES, MOST_SHRINK,
    NEAR_BLOW, ROUNDED, SAFETY, STEP_GROWTH,
};
use crate::integrator::dense_output::DenseSlip;
use crate::integrator::discrete_gradient;
use crate::integrator::energy::{balance, conservation};
use crate::integrator::events::interruption::Passages;
use crate::integrator::events::{Cut, Event, Locator};
use crate::integrator::grid::{Grid, Target, round_down};
use crate::integrator::recorder::Recorder;
use crate::integrator::rest::rests_until;
use crate::integrator::step_length::{Proposal, StepOutcome, growth, shrinkage};
use crate::integrator::transition;
use crate::integrator::workspace::{Budget, Room, Rooms, Workspace, work};
use crate::link::{CONTACT, MAX_LINKS};
use crate::math::nodal;
use crate::math::nodal::{LONG, SHORT};
use crate::math::prediction::parabola_in_time;
use crate::model::Model;
use crate::state::State;

/// Limit of the velocity of a fixed contact, m/s.
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// An integration in progress.
pub(crate) struct Stepper<'a> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a mut State,
    pub(crate) workspace: &'a mut Workspace,
    pub(crate) budget: Budget,
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

impl Stepper<'_> {
    /// Takes steps to the end of the grid.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then undefined.
    pub(crate) fn run(&mut self) -> Result<(), StepError> {
        if let Some(speed) = self.drive.velocities.iter().find(|speed| speed.abs() > SPEED_OF_LIGHT) {
            return Err(self.error(StepErrorCause::Speed(*speed)));
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
            self.budget.check(&self.workspace.search, before)?;
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
        let closing = self.state.last_closing();
        let smooth = closing.map(|closing| self.state.time - closing);
        let proposal = self.state.lengths.propose(closed, smooth, remaining);
        let outcome = match proposal {
            Proposal::Short(length) => self.advance_with::<SHORT>(length)?,
            Proposal::Long(length) => self.advance_with::<LONG>(length)?,
        };
        let situation = (self.progress.driven, self.state.last_closing().is_some());
        let lengths = &mut self.state.lengths;
        lengths.keep(proposal, &outcome, closed, remaining, situation);
        Ok(())
    }

    /// The length of a leap from here, s: where a contact has just closed, and nothing that is known ends it.
    fn leap_length(&mut self) -> Option<f64> {
        let longest = self.workspace.leaps.as_ref()?.longest;
        let State {
            time, links, lengths, ..
        } = &mut *self.state;
        let has_closed = links.iter().any(|at| at.closed && at.last_closing == Some(*time));
        if !has_closed || self.progress.conserves {
            return None;
        }
        let least = LEAST_LEAP * lengths.short;
        if lengths.leap < least {
            // The next closing may be gentler.
            lengths.leap *= 2.0;
            return None;
        }
        let corner = self.model.generator.next_break(*time).unwrap_or(f64::INFINITY);
        let remaining = self.recorder.read.unwrap_or(self.grid.end()) - *time;
        let possible = longest.min(self.model.longest_step(*time)).min(remaining);
        let length = round_down(lengths.leap.min(possible));
        (length >= least && *time + length < corner).then_some(length)
    }

    /// One step over `length` (s) after a closing, by the root of the time since: accepted, or to be tried again with another length.
    fn leap(&mut self, length: f64) -> Result<(), StepError> {
        let target = Target {
            recurring: true,
            ..self.grid.cut(length, self.state.time + length)
        };
        self.workspace.exchange();
        let done = self.with_trial(|stepper, trial| stepper.try_leap(trial, &target));
        self.workspace.exchange();
        done
    }

    fn try_leap(&mut self, trial: &mut Trial<LONG>, target: &Target) -> Result<(), StepError> {
        let length = target.length;
        let [ratio, _] = match self.compute(trial, target) {
            Some(()) => self.relative_errors(trial, target),
            None => [f64::INFINITY; 2],
        };
        let count = self.model.links.len();
        let mut locator = self.locator(trial, length);
        let mut links = locator.whole.state.links.iter().take(count).enumerate();
        let mut stay = || {
            links.all(|(index, at)| {
                if at.closed {
                    locator.first_open(index).is_none()
                } else {
                    locator.is_far(index)
                }
            })
        };
        let is_possible = ratio <= 1.0 && stay();
        let mut passages = Passages::default();
        if !is_possible || !locator.find_passages(false, &mut passages) {
            self.state.rejected_steps += 1;
            self.state.lengths.leap = length * shrinkage::<LONG>(ratio.max(1.0));
            return Ok(());
        }
        self.commit(trial, target, &passages)?;
        for at in &mut self.state.links {
            at.course = parabola_in_time(&at.course);
        }
        let lengths = &mut self.state.lengths;
        lengths.leap = StepOutcome::accepted(length, lengths.leap, growth::<LONG>(ratio)).length;
        lengths.short = length;
        Ok(())
    }

    /// One step with `S` nodes of at most `requested` seconds, accepted or rejected.
    fn advance_with<const S: usize>(&mut self, requested: f64) -> Result<StepOutcome, StepError>
    where
        Workspace: Rooms<S>,
    {
        let requested = requested
            .min(self.model.longest_step(self.state.time))
            .max(self.shortest());
        let corner = self.model.generator.next_break(self.state.time);
        let target = self.grid.target(requested, self.state.time, corner);
        self.with_trial(|stepper, trial: &mut Trial<S>| stepper.try_step(trial, &target, requested, corner))
    }

    /// Does something with the room for a trial.
    #[inline(always)]
    fn with_trial<const S: usize, R>(&mut self, work: impl FnOnce(&mut Self, &mut Trial<S>) -> R) -> R
    where
        Workspace: Rooms<S>,
    {
        let mut trial = self.parts::<S>().trial.take().unwrap_or_else(bytemuck::zeroed_box);
        let outcome = work(self, &mut trial);
        self.parts::<S>().trial = Some(trial);
        outcome
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
        let computed = self.compute(trial, target);
        let [ratio, own] = match computed {
            Some(()) => self.relative_errors(trial, target),
            None => [f64::INFINITY; 2],
        };
        // One of the shortest length is accepted with any finite error.
        if !(own <= 1.0 || self.is_shortest(target) && own.is_finite()) {
            // The collocation failed; use the discrete-gradient step.
            if self.state.is_closed() && (self.is_shortest(target) || self.progress.refusals >= HALVINGS) {
                return self.take_with_constant_force(target);
            }
            if self.is_shortest(target) {
                return Err(self.error(StepErrorCause::NotFinite));
            }
            let shrink = if self.changes_now() {
                // Where the force bends the error is of order one.
                (SAFETY / ratio).clamp(LEAST_SHRINK, MOST_SHRINK)
            } else {
                shrinkage::<S>(ratio)
            };
            return Ok(self.reject(target.length * shrink));
        }
        // The energy may reveal an error that the estimate misses.
        if !self.is_shortest(target) && self.breaks_account(trial, target.length) {
            return Ok(self.reject(0.5 * target.length));
        }
        // From the error of the whole step, also if an event shortens it.
        let growth = if self.progress.before_event {
            growth::<S>(ratio).min(1.0)
        } else {
            growth::<S>(ratio) * self.leaving_kink(target.length)
        };
        let cut = match self.first_event(trial, target) {
            Ok(cut) => cut,
            Err(shorter) => {
                self.progress.before_event |= shorter.before_event;
                if shorter.before_event && self.state.is_closed() {
                    // More nodes do better inside than a shorter step.
                    self.state.lengths.long = self.state.lengths.long.max(target.length);
                }
                let Shorter { error, allowed, .. } = shorter;
                let shrink = SAFETY * (allowed / error).powf(1.0 / S as f64);
                return Ok(self.reject(target.length * shrink.clamp(LEAST_SHRINK, MOST_SHRINK)));
            }
        };
        if let Some(cut) = cut {
            return self.end_at(&cut, trial, target, growth, requested);
        }
        let must = self.is_shortest(target);
        let mut passages = Passages::default();
        if !self.locator(trial, target.length).find_passages(must, &mut passages) {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
        self.keep_first_step::<S>(target.length, ratio);
        self.commit(trial, target, &passages)?;
        if corner.is_some_and(|corner| corner <= target.time) {
            // What the corner sets vibrating, the step sizes before it do not resolve.
            let next = transition::step_after_jump(self.model, self.state);
            let lengths = &mut self.state.lengths;
            (lengths.long, lengths.flight, lengths.last) = (lengths.long.min(next), lengths.flight.min(next), 0.0);
            return Ok(StepOutcome {
                accepted: true,
                switched: false,
                growth: 1.0,
                length: requested.min(next),
            });
        }
        Ok(StepOutcome::accepted(target.length, requested, growth))
    }

    /// Computes a trial step to the target.
    pub(crate) fn compute<const S: usize>(&mut self, trial: &mut Trial<S>, target: &Target) -> Option<()>
    where
        Workspace: Rooms<S>,
    {
        let Self {
            model,
            state,
            workspace,
            drive,
            ..
        } = self;
        let (room, search) = workspace.parts();
        search.looked = None;
        let Room { cache, scratch, .. } = room;
        let prepared = cache.prepare(state.time, target.length, target.recurring, model);
        let source = Source::Laws(model.tolerance.newton);
        let computed = compute(model, state, drive, prepared, source, trial, scratch);
        let iterations = if computed.is_some() {
            trial.iterations
        } else {
            ITERATIONS
        };
        search.work += work::<S>(model, target.recurring) + iterations * (S * S) as u64;
        computed
    }

    /// Estimated error of a trial to the target, relative to the error allowed: that from which the next length follows, and
    /// that by which it is accepted, with less of what the contact's damper takes back. [`ROUNDED`] where it is mere
    /// rounding, which no shorter step reduces.
    fn relative_errors<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> [f64; 2]
    where
        Workspace: Rooms<S>,
    {
        let (model, closed) = (self.model, self.state.is_closed());
        let read = self.recorder.reads_before(target.time);
        let watched = model.scene.effects.extremes || model.counts_interruptions();
        // 4-node steps may be inaccurate inside: they end where they are read. After a change of the inputs, or a jump of the
        // generated acceleration, extremes lie there.
        let jumps = self.state.lengths.last == 0.0 && !self.state.touches_now();
        let inside =
            if (self.progress.driven || jumps) && watched && closed || (read || watched || !closed) && S != SHORT {
                self.inaccuracy(trial, target.length)
            } else {
                0.0
            };
        let near = self.state.kink_is_closing && self.state.time - self.state.last_kink < NEAR_BLOW * target.length;
        let after_blow = if closed && near { AFTER_BLOW } else { 1.0 };
        let all = self.passing();
        let [ratio, own] = [all, all.min(INHERITED)].map(|share| {
            let ratio = after_blow * trial.error.with(share) / model.tolerance.step.max(trial.rounding);
            // Not `max`, which would hide NaN.
            if ratio < inside { inside } else { ratio }
        });
        let fails = ratio > 1.0 && (closed || inside < 1.0);
        // What does not shrink with the step keeps one that is far too short from growing to the next length of the grid.
        let stays = closed && ratio == inside && ratio <= 1.0 && growth::<S>(ratio) < 2.0;
        let error = if stays { trial.start_defect } else { trial.error.total };
        let rounding = (fails || stays) && is_rounding::<S>(model, self.state, trial, error);
        if rounding { [ROUNDED; 2] } else { [ratio, own] }
    }

    fn inaccuracy<const S: usize>(&self, trial: &Trial<S>, length: f64) -> f64
    where
        Workspace: Rooms<S>,
    {
        inaccuracy((self.model, self.state), self.collocation::<S>(), trial, length)
    }

    /// The first event in a trial.
    ///
    /// # Errors
    /// [`Shorter`] where the trial has to be shorter to end at it.
    fn first_event<const S: usize>(&mut self, trial: &Trial<S>, target: &Target) -> Result<Option<Cut>, Shorter>
    where
        Workspace: Rooms<S>,
    {
        let (model, length) = (self.model, target.length);
        let read = self.read_at(trial, target);
        let is_cut = self.is_cut(target);
        let (passing, shortest, changes) = (self.passing(), self.shortest(), self.progress.changes);
        let is_shortest = self.is_shortest(target);
        let mut locator = self.locator(trial, length);
        let state = locator.whole.state;
        let links = || model.links.iter().zip(&state.links).enumerate();
        // Within rounding of time after a closing, rounding alone opens it again or makes it slip.
        let just_closed =
            |closing: Option<f64>| closing.is_some_and(|closing| (0.0..=shortest).contains(&(target.time - closing)));
        let rubs = state.links[CONTACT].closed && !just_closed(state.links[CONTACT].last_closing);
        let may_change = rubs && changes <= MOST_CHANGES;
        let change = may_change.then(|| locator.slip_change()).flatten();
        // What sticks slips before it opens.
        let sticks = change.is_some() && state.slip.phase.sign().is_none();
        let mut suspects = [None; MAX_LINKS];
        let mut closes: Option<Cut> = None;
        for ((index, (link, at)), suspect) in links().zip(&mut suspects) {
            if link.contact().is_none() {
                continue;
            }
            if at.closed {
                let held = just_closed(at.last_closing) || sticks && index == CONTACT;
                *suspect = if held { None } else { locator.first_open(index) };
            } else if let Some(cut) = locator.closing(index) {
                closes = earlier(closes, Some(cut));
            }
        }
        let opens = suspects.iter().any(Option::is_some);
        let event = opens || closes.is_some();
        let (error, allowed) = if is_cut && !event {
            (trial.inner_error.with(passing), model.tolerance.step)
        } else if state.is_closed() {
            (trial.inner_error.total, model.tolerance.at_opening)
        } else {
            (trial.inner_error.total, model.tolerance.step)
        };
        let fits =
            || error <= allowed.max(trial.rounding) || is_shortest || is_rounding::<S>(model, state, trial, error);
        if (event || read.is_some()) && !fits() {
            return Err(Shorter {
                error,
                allowed,
                before_event: true,
            });
        }
        // No blow follows a change between stick and slip.
        let inherited = INHERITED * trial.inner_error.total;
        if change.is_some() && inherited > model.tolerance.step.max(trial.rounding) && !is_shortest {
            return Err(Shorter {
                error: trial.inner_error.total,
                allowed: model.tolerance.step,
                before_event: false,
            });
        }
        let mut first = closes;
        for (index, latest) in suspects.iter().enumerate() {
            let cut = latest.and_then(|latest| locator.opening(index, latest));
            first = earlier(first, cut);
        }
        if let Some(change) = change.filter(|change| first.is_none_or(|first| change.at < first.at)) {
            first = Some(locator.cut_at_change(&change));
        }
        Ok(match (first, read) {
            (Some(first), Some(read)) if first.time <= read => Some(first),
            (_, Some(time)) => Some(Cut {
                at: time - state.time,
                time,
                event: Event::Read,
            }),
            (first, None) => first,
        })
    }

    /// The instant (s) in a trial at which it will be read, if its polynomials are not accurate there, or the communication
    /// step ends.
    fn read_at<const S: usize>(&self, trial: &Trial<S>, target: &Target) -> Option<f64>
    where
        Workspace: Rooms<S>,
    {
        let Some(read) = self.recorder.read else {
            return self.is_cut(target).then(|| self.grid.end());
        };
        let inside = read > self.state.time && read < target.time;
        (inside && S == SHORT && self.inaccuracy(trial, target.length) > 1.0).then_some(read)
    }

    /// Takes the trial to `target` up to a cut, in place of a step of `requested` seconds with the growth factor `growth`.
    fn end_at<const S: usize>(
        &mut self,
        cut: &Cut,
        trial: &mut Trial<S>,
        target: &Target,
        growth: f64,
        requested: f64,
    ) -> Result<StepOutcome, StepError>
    where
        Workspace: Rooms<S>,
    {
        if cut.at <= 0.0 {
            return Ok(self.happen_at_start(cut, requested));
        }
        self.shorten(trial, target.length, cut.at);
        let end = self.grid.cut(cut.at, cut.time);
        // Between the nodes the force of the law may miss that of the polynomial, most with a damper that is nearly rigid.
        let missed =
            |nodes: &LinkNodes<S>| (nodes.end.force - nodal::end(&nodes.forces)).abs() > self.model.tolerance.force;
        let switches = matches!(cut.event, Event::Switches(_));
        if !switches && trial.links.iter().any(missed) && !self.is_shortest(target) {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
        let must = self.is_shortest(target);
        let mut passages = Passages::default();
        if !self.locator(trial, end.length).find_passages(must, &mut passages) {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
        self.commit(trial, &end, &passages)?;
        self.happen(cut.event);
        let outcome = StepOutcome::accepted(target.length, requested, growth);
        let length = outcome.length.min(requested);
        let slides = matches!(cut.event, Event::Slides(_));
        Ok(StepOutcome {
            switched: switches || slides,
            length: if slides { self.state.lengths.long } else { length },
            ..outcome
        })
    }

    /// An event at the start of a step of `requested` seconds: no time passes.
    fn happen_at_start(&mut self, cut: &Cut, requested: f64) -> StepOutcome {
        self.happen(cut.event);
        if let Some(start) = &mut self.recorder.start {
            **start = *self.state;
        }
        let length = if let Event::Slides(_) = cut.event {
            self.progress.changes += 1;
            // Polynomials of a shorter step say which of the two it is; rounding must not let it change to and fro for ever.
            let again = self.progress.changes > 1;
            let lengths = &mut self.state.lengths;
            let length = lengths.long.min(if again { MOST_SHRINK * requested } else { requested });
            if again {
                lengths.short = lengths.short.min(length);
            }
            length
        } else {
            requested
        };
        StepOutcome {
            switched: true,
            ..self.reject(length)
        }
    }

    /// Rejects a step; the next one shall have `length` (s).
    fn reject(&mut self, length: f64) -> StepOutcome {
        self.state.rejected_steps += 1;
        self.progress.refusals += 1;
        StepOutcome {
            accepted: false,
            switched: false,
            growth: 1.0,
            length,
        }
    }

    /// Factor by which the next step may be longer for its distance from the last closing, or from where slip last began or
    /// ended, alone: the force there is smooth in the logarithm of the time since.
    fn leaving_kink(&self, length: f64) -> f64 {
        let State { time, last_kink, .. } = *self.state;
        let elapsed = time - last_kink;
        let bends = self.state.kink_is_closing || self.state.slip.last_change == Some(last_kink);
        if self.changes_now() {
            STEP_GROWTH
        } else if bends && elapsed > 0.0 {
            (SAFETY * (1.0 + length / elapsed)).max(1.0)
        } else {
            1.0
        }
    }

    /// Factor on the error that the contact's damper takes back.
    pub(crate) fn passing(&self) -> f64 {
        if self.progress.driven { DRIVEN } else { 1.0 }
    }

    /// Whether the step ends with the communication step, inside the trial.
    fn is_cut(&self, target: &Target) -> bool {
        !self.grid.recurs && target.time > self.grid.end()
    }

    /// Whether the step cannot be halved.
    pub(crate) fn is_shortest(&self, target: &Target) -> bool {
        target.length <= 2.0 * self.shortest()
    }

    /// Shortest step, s.
    fn shortest(&self) -> f64 {
        8.0 * self.resolution()
    }

    /// Rounding of time in the communication step, s.
    fn resolution(&self) -> f64 {
        resolution(self.grid.start, self.grid.size)
    }

    pub(crate) fn error(&self, cause: StepErrorCause) -> StepError {
        StepError {
            time: self.state.time,
            cause,
        }
    }

    /// The polynomials of the steps.
    pub(crate) fn collocation<const S: usize>(&self) -> &Collocation<S>
    where
        Workspace: Rooms<S>,
    {
        Rooms::<S>::room(self.workspace).cache.collocation()
    }

    pub(crate) fn parts<const S: usize>(&mut self) -> &mut Room<S>
    where
        Workspace: Rooms<S>,
    {
        Rooms::<S>::parts(self.workspace).0
    }

    /// For events in a trial of `length` seconds.
    pub(crate) fn locator<'b, const S: usize>(&'b mut self, trial: &'b Trial<S>, length: f64) -> Locator<'b, S>
    where
        Workspace: Rooms<S>,
    {
        let resolution = self.resolution();
        let (room, search) = self.workspace.parts();
        Locator {
            whole: Whole {
                model: self.model,
                state: self.state,
                drive: &self.drive,
                collocation: room.cache.collocation(),
                trial,
                axial: &room.scratch.axial.loads,
                length,
            },
            search,
            budget: self.budget,
            tolerance: self.model.tolerance,
            resolution,
        }
    }

    /// Shortens a trial of `length` seconds to end `at` seconds after its start.
    fn shorten<const S: usize>(&mut self, trial: &mut Trial<S>, length: f64, at: f64)
    where
        Workspace: Rooms<S>,
    {
        self.locator(trial, length).look(at);
        let (room, search) = self.workspace.parts();
        let Room { cache, scratch, .. } = room;
        let begun = (self.model, &*self.state, &self.drive);
        let part = (trial, scratch.axial.loads.as_mut_slice());
        shorten(begun, cache.collocation(), part, (length, at), &search.modes);
        search.looked = None;
    }

    /// Accepts the trial as the new state; its forces pass those of interruptions at `passages`.
    ///
    /// # Errors
    /// [`StepErrorCause::NotFinite`] where it is not finite.
    pub(crate) fn commit<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        target: &Target,
        passages: &Passages,
    ) -> Result<(), StepError>
    where
        Workspace: Rooms<S>,
    {
        let mut links = self.model.links.iter().zip(&trial.links);
        if !links.all(|(_, nodes)| nodes.end.approach.is_finite() && nodes.end.rate.is_finite()) {
            return Err(self.error(StepErrorCause::NotFinite));
        }
        let expected = self.model.scene.effects.energy.then(|| {
            // The balance repeats the step in two halves.
            self.workspace.search.work += 2 * work::<LONG>(self.model, target.recurring);
            balance::expected_energy(self.model, self.state, &self.drive, self.workspace, trial, target)
        });
        let passing = self.passing();
        let Self {
            model,
            state,
            workspace,
            drive,
            recorder,
            progress,
            ..
        } = self;
        let cache = &Rooms::<S>::room(*workspace).cache;
        if progress.conserves {
            state.energy_surplus +=
                conservation::surplus(model, state, drive, cache.collocation(), trial, target.length).0;
        }
        state.force_error.add(trial.error.with(passing), model.force_scale);
        recorder.note_step((*model, &mut **state), cache.collocation(), trial, target, passages);
        let slip = state.slip;
        commit(model, state, drive, cache, trial, target);
        let courses = follow_slip(model, (slip, &mut **state), cache, trial, target.length);
        if let (Some(dense), Some([slip, dissipated])) = (&mut recorder.dense, courses) {
            dense.slip = DenseSlip { slip, dissipated };
        }
        self.grid.done = target.done;
        *progress = Progress {
            driven: progress.driven,
            conserves: progress.conserves,
            ..Progress::default()
        };
        if progress.conserves {
            conservation::settle(model, state, target.length);
        }
        if let Some(Some(expected)) = expected {
            state.energy_balance += expected - model.energy(state);
        }
        Ok(())
    }

    /// Takes a step with constant forces, which always has a solution.
    pub(crate) fn take_with_constant_force(&mut self, target: &Target) -> Result<StepOutcome, StepError> {
        self.with_trial(|stepper, trial| stepper.try_with_constant_force(trial, target))
    }

    fn try_with_constant_force(&mut self, trial: &mut Trial<SHORT>, target: &Target) -> Result<StepOutcome, StepError> {
        let Self {
            model,
            state,
            workspace,
            drive,
            ..
        } = self;
        discrete_gradient::solve(model, state, drive, workspace, trial, target)
            .ok_or_else(|| self.error(StepErrorCause::NotFinite))?;
        let mut passages = Passages::default();
        self.locator(trial, target.length).find_passages(true, &mut passages);
        self.commit(trial, target, &passages)?;
        let mut switched = false;
        for index in 0..self.model.links.len() {
            switched |= self.switch_after_constant_force(trial, index, target.length);
        }
        self.model.settle_friction(self.state);
        // No polynomial to predict the next step with.
        self.state.lengths.last = 0.0;
        Ok(StepOutcome {
            accepted: true,
            switched,
            growth: 2.0,
            length: target.length,
        })
    }

    /// Opens or closes a contact as it is after a step of `length` seconds with constant forces, and sets its force; whether it
    /// opens or closes.
    fn switch_after_constant_force(&mut self, trial: &Trial<SHORT>, index: usize, length: f64) -> bool {
        let Some((link, nodes)) = self.model.links.get(index).zip(trial.links.get(index)) else {
            return false;
        };
        let (Some(law), end) = (link.contact(), &nodes.end) else {
            return false;
        };
        let closed = link.engagement(end.approach, end.rate) > 0.0;
        let switched = self.state.links.get(index).is_some_and(|at| at.closed != closed);
        if switched {
            self.happen(Event::Switches(index));
        }
        if closed && let Some(at) = self.state.links.get_mut(index) {
            // The velocity at the end belongs to a constant force: if the contact is nearly a rigid dashpot, the law
            // would overestimate the force.
            let branch = law.closed_branch(link.approach + end.approach, end.rate);
            let rigid = branch.damping * self.model.mobility_of(link.port) * length > 1.0;
            at.force = if rigid { link.force + end.force } else { branch.force };
        }
        switched
    }

    /// Whether the energy error of the step exceeds that of a force error of one tolerance along the path of the contacts.
    /// The error estimate, a single number, can be small by chance.
    fn breaks_account<const S: usize>(&self, trial: &Trial<S>, length: f64) -> bool
    where
        Workspace: Rooms<S>,
    {
        self.progress.conserves
            && self.state.is_closed()
            && conservation::is_broken(
                self.model,
                self.state,
                &self.drive,
                self.collocation::<S>(),
                trial,
                length,
            )
    }

    /// Makes of the state what an event makes of it.
    fn happen(&mut self, event: Event) {
        match event {
            Event::Switches(index) => {
                self.progress.driven = false;
                transition::switch(self.model, self.state, index, &mut self.workspace.events);
            }
            Event::Slides(phase) => transition::slide(self.model, self.state, phase),
            Event::Read | Event::Dips => {}
        }
    }

    /// Whether the contact begins or ceases to slip at the start of the next step.
    fn changes_now(&self) -> bool {
        self.model.friction().is_some() && self.state.slip.last_change == Some(self.state.time)
    }

    /// Keeps the length (s) of a step about to be taken, if it is the first one after a change between stick and slip, with the
    /// factor that its error would have allowed.
    fn keep_first_step<const S: usize>(&mut self, length: f64, ratio: f64) {
        if self.changes_now() {
            let factor = growth::<S>(ratio).clamp(MOST_SHRINK, 1.0 / MOST_SHRINK);
            *self.state.lengths.after_change(self.state.slip.phase) = length * factor;
        }
    }
}

/// A trial is too long to end at an event inside.
struct Shorter {
    /// Its error there, and the one allowed, N.
    error: f64,
    allowed: f64,
    /// Whether a contact opens or closes, or the step is read.
    before_event: bool,
}

/// The earlier of two cuts.
fn earlier(a: Option<Cut>, b: Option<Cut>) -> Option<Cut> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.at < a.at { b } else { a }),
        (a, b) => a.or(b),
    }
}
