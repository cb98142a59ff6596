//! Where a step ends: with its trial, or at the first event inside.

use std::array;

use crate::error::StepError;
use crate::force_error::Deviation;
use crate::integrator::collocation::error::of_rounding;
use crate::integrator::collocation::part::shorten;
use crate::integrator::collocation::trial::{LinkNodes, Trial};
use crate::integrator::constants::{INHERITED, LEAST_SHRINK, MOST_CHANGES, MOST_SHRINK, MOTION_ROUNDING, SAFETY};
use crate::integrator::events::{Cut, Event};
use crate::integrator::grid::Target;
use crate::integrator::step_length::StepOutcome;
use crate::integrator::stepper::Stepper;
use crate::integrator::workspace::{Room, Rooms, Workspace};
use crate::link::{CONTACT, MAX_LINKS};
use crate::math::nodal;

impl Stepper<'_> {
    /// The first event in a trial.
    ///
    /// # Errors
    /// The rejection of a trial that is too long to end at it.
    pub(super) fn find_end<const S: usize>(
        &mut self,
        trial: &Trial<S>,
        target: &Target,
    ) -> Result<Option<Cut>, StepOutcome>
    where
        Workspace: Rooms<S>,
    {
        let (model, length) = (self.model, target.length);
        // Where the communication step ends inside the trial, s.
        let end = (!self.grid.free && target.time > self.grid.end()).then(|| self.grid.end());
        let (passing, shortest, changes) = (self.passing(), self.shortest(), self.progress.changes);
        let is_shortest = self.is_shortest(target);
        let mut locator = self.locator(trial, length);
        let state = locator.whole.state;
        let links = || model.links.iter().zip(&state.links).enumerate();
        // Within rounding of time after a closing, rounding alone opens it again or makes it slip.
        let just_closed =
            |closing: Option<f64>| closing.is_some_and(|closing| (0.0..=shortest).contains(&(target.time - closing)));
        let rubs = state.links[CONTACT].closed && !just_closed(state.links[CONTACT].last_closing);
        let may_change = rubs && (changes <= MOST_CHANGES || !is_shortest);
        let change = may_change.then(|| locator.slip_change()).flatten();
        // What sticks slips before it opens.
        let sticks = change.is_some() && state.slip.phase.sign().is_none();
        let mut suspects = [None; MAX_LINKS];
        let mut first: Option<Cut> = None;
        for ((index, (link, at)), suspect) in links().zip(&mut suspects) {
            if link.contact().is_none() {
                first = earlier(first, locator.gap(index));
            } else if at.closed {
                let held = just_closed(at.last_closing) || sticks && index == CONTACT;
                *suspect = if held { None } else { locator.first_open(index) };
            } else {
                first = earlier(first, locator.closing(index));
            }
        }
        let opens = suspects.iter().any(Option::is_some);
        let event = opens || first.is_some();
        let (error, allowed) = if end.is_some() && !event {
            (trial.inner_error.with(passing), model.tolerance.step)
        } else if state.is_closed() {
            (trial.inner_error.total, model.tolerance.at_event)
        } else {
            (trial.inner_error.total, model.tolerance.step)
        };
        let fits = || {
            error <= allowed.max(trial.rounding)
                || is_shortest
                || error <= of_rounding::<S>(model, state, trial, MOTION_ROUNDING)
        };
        if (event || end.is_some()) && !fits() {
            self.progress.before_event = true;
            return Err(self.shorten_before_event::<S>(length, allowed / error));
        }
        // No blow follows a change between stick and slip.
        let inherited = INHERITED * trial.inner_error.total;
        if change.is_some() && inherited > model.tolerance.step.max(trial.rounding) && !is_shortest {
            return Err(self.shorten_before_event::<S>(length, model.tolerance.step / trial.inner_error.total));
        }
        for (index, latest) in suspects.into_iter().enumerate().filter_map(|(index, latest)| Some((index, latest?))) {
            first = earlier(first, locator.opening(index, latest));
        }
        if let Some(change) = change.filter(|change| first.is_none_or(|first| change.at < first.at)) {
            first = Some(locator.cut_at_change(&change));
        }
        Ok(match (first, end) {
            (Some(first), Some(end)) if first.time <= end => Some(first),
            (_, Some(time)) => Some(Cut { at: time - state.time, time, event: Event::Read }),
            (first, None) => first,
        })
    }

    /// Rejects a trial of `length` seconds for its error inside: the one allowed there is this share of it.
    fn shorten_before_event<const S: usize>(&mut self, length: f64, share: f64) -> StepOutcome {
        let shrink = SAFETY * share.powf(1.0 / S as f64);
        self.reject(length * shrink.clamp(LEAST_SHRINK, MOST_SHRINK))
    }

    /// Takes the trial to `target` up to a cut, in place of a step of `requested` seconds with this growth and the most there is.
    pub(super) fn end_at<const S: usize>(
        &mut self,
        cut: &Cut,
        trial: &mut Trial<S>,
        target: &Target,
        growth: (f64, f64),
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
        let misses = !switches && trial.links.iter().any(missed);
        let must = self.is_shortest(target);
        if misses && !must || !self.commit(trial, &end, must)? {
            return Ok(self.reject(MOST_SHRINK * target.length));
        }
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
            // The next one of this length goes on as it is: for no longer than rounding tells the two apart.
            let last = self.progress.changes > MOST_CHANGES;
            let most = match (last, again) {
                (true, _) => self.shortest(),
                (false, true) => MOST_SHRINK * requested,
                (false, false) => requested,
            };
            let lengths = &mut self.state.lengths;
            let length = lengths.long.min(most);
            if again {
                lengths.short = lengths.short.min(length);
            }
            length
        } else {
            requested
        };
        StepOutcome { switched: true, ..self.reject(length) }
    }

    /// Shortens a trial of `length` seconds to end `at` seconds after its start.
    fn shorten<const S: usize>(&mut self, trial: &mut Trial<S>, length: f64, at: f64)
    where
        Workspace: Rooms<S>,
    {
        let mut locator = self.locator(trial, length);
        let ends = array::from_fn(|index| locator.inside(index, at));
        let mut deviation = Deviation::default();
        if locator.whole.state.force_error.deviates() {
            locator.whole.deviation(at, &mut deviation);
        }
        let (room, search) = self.workspace.parts();
        let Room { cache, scratch, .. } = room;
        let part = (trial, scratch.axial.loads.as_mut_slice());
        let end = (&ends, &*search.modes, &deviation);
        shorten((self.model, self.state), cache.collocation, part, at / length, end);
        search.looked = None;
    }
}

/// The earlier of two cuts.
fn earlier(a: Option<Cut>, b: Option<Cut>) -> Option<Cut> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.at < a.at { b } else { a }),
        (a, b) => a.or(b),
    }
}
