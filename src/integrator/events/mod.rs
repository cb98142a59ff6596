//! Events inside a trial step: openings and closings of contacts, gaps of magnets, changes between stick and slip, interruptions. A step
//! ends where a contact opens or closes, or begins or ceases to slip, or where a gap opens, and integration restarts there; where an
//! interruption begins or ends it goes on.

pub mod closing;
pub mod cubic;
pub mod gap;
pub mod interruption;
pub mod log;
pub mod opening;
pub mod slip;
pub mod swings;

use crate::contact::friction::Phase;
use crate::contact::law::Law;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::constants::ITERATIONS;
use crate::integrator::rounding::motion_rounding;
use crate::integrator::workspace::{Search, work};
use crate::link::Link;
use crate::math::prediction::value_at;
use crate::math::roots;
use crate::model::Model;
use crate::state::{LinkState, State};

/// What happens inside a trial, where the step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    /// The communication step ends, or the step is read there.
    Read,
    /// A force is lowest there, of a contact that stays closed, or begins to bend, and the next step starts there.
    Bends,
    /// A contact opens or closes.
    Switches(usize),
    /// The first contact begins or ceases to slip, and goes on like this.
    Slides(Phase),
}

/// The end of a step inside the trial that was made for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// After the start of the trial, s.
    pub(crate) at: f64,
    /// The instant, s.
    pub(crate) time: f64,
    /// What ends it.
    pub(crate) event: Event,
}

/// Locates events in a trial.
pub(crate) struct Locator<'a, const S: usize> {
    pub(crate) whole: Whole<'a, S>,
    pub(crate) search: &'a mut Search,
    /// Rounding of time, s.
    pub(crate) resolution: f64,
}

impl<'a, const S: usize> Locator<'a, S> {
    /// A link and its state at the start of the trial.
    fn link(&self, index: usize) -> Option<(&'a Link, &'a LinkState)> {
        let Whole { model, state, .. } = self.whole;
        model.links.get(index).zip(state.links.get(index))
    }

    /// Computes the modes at an instant (s after the start), by the exact motion under the polynomials of the trial.
    fn look(&mut self, at: f64) {
        if self.search.looked.replace(at) == Some(at) {
            return;
        }
        self.search.work += work::<S>(self.whole.model, true);
        self.whole.modes(at, &mut self.search.modes);
    }

    /// A link there.
    pub(crate) fn inside(&mut self, index: usize, at: f64) -> Instant {
        self.look(at);
        self.whole.link(index, at, &self.search.modes)
    }

    /// The instant at which `value` of approach and velocity of a link changes its sign, between `from` (s, value) and `latest`
    /// (s); it need not. To the spacing of floating-point numbers or to a value that is mere `rounding`: on the polynomials of the
    /// link, then on the exact motion.
    fn instant(
        &mut self,
        index: usize,
        value: impl Fn(f64, f64) -> f64,
        from: (f64, f64),
        latest: f64,
        rounding: f64,
    ) -> Instant {
        let whole = self.whole;
        let Some((nodes, (_, start))) = whole.trial.links.get(index).zip(self.link(index)) else {
            return self.inside(index, latest);
        };
        let approach = whole.collocation.through(whole.model.simd, start.approach, &nodes.approaches);
        let rate = whole.collocation.through(whole.model.simd, start.rate, &nodes.rates);
        let on_polynomials = |at: f64| {
            let y = at / whole.length - 1.0;
            value(value_at(&approach, y), value_at(&rate, y))
        };
        let end = (latest, on_polynomials(latest));
        let guess = roots::between(on_polynomials, from, end, 1e-12 * whole.length);
        let at = guess.unwrap_or(latest);
        let near = at - 1e-4 * (at - from.0);
        let slope = (on_polynomials(at) - on_polynomials(near)) / (at - near);
        let exact = |_: &Self, now: &Instant| value(now.d, now.rate);
        self.refined(index, exact, from, (at, slope), latest, rounding)
    }

    /// The same on the exact motion, from a guess and the slope there (1/s times the value): by the secant method, then by
    /// bracketing.
    fn refined(
        &mut self,
        index: usize,
        value: impl Fn(&Self, &Instant) -> f64,
        from: (f64, f64),
        (mut at, mut slope): (f64, f64),
        latest: f64,
        rounding: f64,
    ) -> Instant {
        let (mut low, mut high, mut last) = (from, None, None);
        for _ in 0..ITERATIONS {
            let now = self.inside(index, at);
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
            if (next - at).abs() <= self.resolution {
                return now;
            }
            last = Some((at, found));
            at = next;
        }
        let resolution = self.resolution;
        let exact = |at: f64| {
            let now = self.inside(index, at);
            value(self, &now)
        };
        let found = high.and_then(|high| roots::between(exact, low, high, resolution));
        self.inside(index, found.unwrap_or(latest))
    }

    /// Engagement that counts as zero where a contact opens, m.
    fn located(&self, link: (&Link, &LinkState)) -> f64 {
        let Whole { model, state, .. } = self.whole;
        let stiffness = link.0.contact().map_or(1.0, |law| law.firm);
        (self.whole.model.tolerance.at_event / stiffness).max(engagement_rounding(model, link, state))
    }
}

/// Rounding of the engagement of a contact, m.
pub(crate) fn engagement_rounding(model: &Model, link: (&Link, &LinkState), state: &State) -> f64 {
    let (displacement, velocity) = motion_rounding(model, link, state);
    displacement + link.0.contact().map_or(0.0, Law::by_rate) * velocity
}
