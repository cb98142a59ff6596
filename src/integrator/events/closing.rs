//! Event location of closing: the first instant within a step of free flight at which there is a contact force.
//!
//! Sign changes alone would miss a grazing contact. Between two samples of indentation and velocity the indentation is
//! approximated by the Hermite cubic, whose error is estimated at a sample between them. If the maximum of the cubic
//! stays below first touch by more than this error there is no contact; nor is there any where the bodies part faster than
//! all that is unseen, or where what the damper resists does not rise to a touch. Otherwise the interval is halved by the exact
//! motion. Modes that oscillate faster than the interval resolves, or settle faster after a jump, are added with their amplitudes.
//! An interval along which the engagement rises has one closing, which is found on cubics as well, to half the shortest step: each
//! look at the motion gives the next one a nearer sample.

use crate::contact::law::Law;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::constants::{DISTANT, HALVINGS, SHORTEST_FLIGHT, UNSEEN};
use crate::integrator::events::cubic::Cubic;
use crate::integrator::events::{Cut, Event, Locator, engagement_rounding};
use crate::integrator::rounding::motion_rounding;
use crate::link::Link;
use crate::math::nodal::LONG;
use crate::math::roots;
use crate::state::LinkState;

/// An open contact in which a touch is sought.
#[derive(Clone, Copy)]
pub(crate) struct Sought<'a> {
    index: usize,
    link: &'a Link,
    law: &'a Law,
    start: &'a LinkState,
    /// Engagement that does not count as contact, m.
    unsure: f64,
    /// Engagement that need not be found, m: its force is far below the tolerance, or it does not count.
    negligible: f64,
}

impl Sought<'_> {
    /// Engagement at a sample, m.
    fn engagement(&self, sample: &Instant) -> f64 {
        self.link.engagement(sample.d, sample.rate)
    }

    /// Its part that the damper resists, m: no less than the engagement.
    fn resisted(&self, sample: &Instant) -> f64 {
        self.law.resisted(self.link.approach + sample.d, sample.rate)
    }
}

impl<'a, const S: usize> Locator<'a, S> {
    /// Locates the closing of an open contact; `None` if it stays open.
    pub(crate) fn closing(&mut self, index: usize) -> Option<Cut> {
        let (sought, samples) = self.near(index)?;
        let samples = samples.get(..S + 1)?;
        self.search.swings.set(self.whole, sought.link);
        // The cubic over two intervals is wrong by more than that over each.
        let mut errors = [0.0_f64; LONG + 1];
        for (k, triple) in samples.windows(3).enumerate() {
            if let [a, b, c] = triple {
                let error = (b.d - Cubic { a: *a, b: *c }.at(b.at).d).abs();
                for entry in errors.iter_mut().skip(k).take(2) {
                    *entry = entry.max(error);
                }
            }
        }
        let touch = samples.windows(2).zip(errors).find_map(|(pair, error)| match pair {
            [a, b] => self.touch_between(&sought, Cubic { a: *a, b: *b }, error),
            _ => None,
        })?;
        Some(Cut { at: touch.at, time: self.whole.state.time + touch.at, event: Event::Switches(index) })
    }

    /// An open contact with samples at the start and the nodes of the trial; `None` where it is so far that it stays open, or no
    /// contact.
    #[inline(always)]
    pub(crate) fn near(&self, index: usize) -> Option<(Sought<'a>, [Instant; LONG + 1])> {
        let Whole { collocation, trial, length, .. } = self.whole;
        let (link, start) = self.link(index)?;
        let first = Instant { at: 0.0, d: start.approach, rate: start.rate };
        let mut samples = [first; LONG + 1];
        let (mut lowest, mut highest, mut fastest) = (first.d, first.d, first.rate.abs());
        let nodes = trial.links.get(index)?;
        let motion = nodes.approaches.iter().zip(&nodes.rates);
        for (entry, (node, (&d, &rate))) in samples.iter_mut().skip(1).zip(collocation.nodes.iter().zip(motion)) {
            *entry = Instant { at: node * length, d, rate };
            (lowest, highest, fastest) = (lowest.min(d), highest.max(d), fastest.max(rate.abs()));
        }
        let reach = DISTANT * (highest - lowest + fastest * length);
        let is_far = link.engagement(highest + reach, DISTANT * fastest) < 0.0;
        if is_far {
            return None;
        }
        let (law, unsure) = (link.contact()?, self.unsure(link, start));
        let sought = Sought {
            index,
            link,
            law,
            start,
            unsure,
            negligible: law.indentation(self.whole.model.tolerance.at_event).max(unsure),
        };
        Some((sought, samples))
    }

    /// Whether the contact certainly stays open between two open samples, whose cubic is wrong by `error` (m).
    fn is_clear(&self, sought: &Sought, cubic: &Cubic, error: f64) -> bool {
        let Cubic { a, b } = cubic;
        let (ripple, length) = (self.search.swings.ripple(cubic), cubic.length());
        let highest = cubic.highest() + error + ripple.displacement;
        if sought.link.engagement(highest, a.rate.max(b.rate) + ripple.velocity) < sought.negligible {
            return true;
        }
        let time = sought.law.by_rate();
        // A cubic wrong by this much in the middle has a slope wrong by four times that over its length at most, and a curvature by 32
        // times that over its square. It parts faster than all that is unseen could bring it back, by the motion that the damper resists.
        let bent = ripple.acceleration + 32.0 * error / (length * length);
        if sought.resisted(a) <= sought.unsure
            && cubic.rates(time).1 + ripple.velocity + 4.0 * error / length + time * bent < 0.0
        {
            return true;
        }
        let rounding = motion_rounding(self.whole.model, (sought.link, sought.start), self.whole.state).0;
        let rise = cubic.rise(time, error, rounding) + ripple.displacement + time * ripple.velocity;
        sought.resisted(a) + rise < sought.negligible
    }

    /// Engagement that does not count as contact, m. Just after an opening: what the resolution of time has left of it
    /// there, and what rounding makes of the motion. Without it the contact would close as it opens, again and again.
    fn unsure(&self, link: &Link, start: &LinkState) -> f64 {
        let Whole { model, state, .. } = self.whole;
        if start.last_opening != Some(state.time) {
            return 0.0;
        }
        let left = link.engagement(start.approach, start.rate).max(0.0);
        // Without its force the spring moves away from where that held it.
        let released = f64::EPSILON * model.preload.deflection.abs();
        left + released + engagement_rounding(model, (link, start), state)
    }

    /// Whether the engagement rises throughout between an open and a closed sample, whose cubic is wrong by `error` (m), so that it
    /// is found where it passes zero once: as the bodies approach, faster than all that is unseen could part them or where that is
    /// negligible, or while they are indented and the damper lets go of them.
    fn rises(&self, sought: &Sought, cubic: &Cubic, error: f64) -> bool {
        let Cubic { a, b } = cubic;
        let slowest = cubic.rates(0.0).0;
        if slowest > 0.0 {
            let slower = self.search.swings.ripple(cubic).velocity + 4.0 * error / cubic.length();
            if slower < slowest && sought.law.engages_by_way(slowest - slower) {
                return true;
            }
        }
        let approaches = a.rate >= 0.0 && cubic.highest() <= b.d;
        let is_held = || {
            sought.law.is_indented(sought.link.approach + cubic.lowest()) && cubic.rates(sought.law.by_rate()).0 >= 0.0
        };
        (approaches || is_held()) && self.is_resolved(sought, cubic)
    }

    /// Whether oscillations faster than the interval between two samples are negligible.
    fn is_resolved(&self, sought: &Sought, cubic: &Cubic) -> bool {
        let ripple = self.search.swings.ripple(cubic);
        let [from, to] = [&cubic.a, &cubic.b].map(|sample| sought.engagement(sample));
        ripple.displacement + sought.law.damping * ripple.velocity <= UNSEEN * (to - from).abs()
    }

    /// The first instant of closing between two samples; `error` (m) is the error of their cubic. Where that cannot tell, the
    /// interval is bisected, and the second half waits.
    fn touch_between(&mut self, sought: &Sought, mut cubic: Cubic, mut error: f64) -> Option<Instant> {
        let released = sought.start.last_opening == Some(self.whole.state.time);
        self.search.halves.clear();
        let mut depth = 0;
        while !self.search.is_exhausted() {
            let Cubic { a, b } = cubic;
            if sought.engagement(&b) <= sought.unsure {
                if self.is_clear(sought, &cubic, error) || depth > HALVINGS {
                    let later;
                    (later, error, depth) = self.search.halves.pop()?;
                    cubic = Cubic { a: b, b: later };
                    continue;
                }
            } else if self.rises(sought, &cubic, error) || depth > HALVINGS {
                let touch = self.crossing(sought, cubic);
                return Some(if released { self.prolonged(sought, touch, SHORTEST_FLIGHT * b.at) } else { touch });
            }
            let middle = self.inside(sought.index, f64::midpoint(a.at, b.at));
            error = (middle.d - cubic.at(middle.at).d).abs();
            depth += 1;
            self.search.halves.push((b, error, depth));
            cubic.b = middle;
        }
        None
    }

    /// The end of a flight that ends at a touch: a contact that closes at the instant of opening still gets a short flight (s), so
    /// that time advances; a shorter one where it would close with a force.
    fn prolonged(&mut self, sought: &Sought, touch: Instant, mut shortest: f64) -> Instant {
        while touch.at < shortest {
            let end = self.inside(sought.index, shortest);
            if sought.link.force_at(end.d, end.rate) <= self.whole.model.tolerance.at_event
                || shortest <= self.resolution
            {
                return end;
            }
            shortest *= 0.1;
        }
        touch
    }

    /// The instant of closing between an open and a closed sample: where their cubic closes, which then has a sample there.
    fn crossing(&mut self, sought: &Sought, mut cubic: Cubic) -> Instant {
        // Not before the touch: from there a step as short as rounding would find the contact open once more. Half the shortest
        // step after it is soon enough.
        let risen = sought.engagement(&cubic.b) - sought.engagement(&cubic.a);
        let soon = 4.0 * self.resolution * risen / cubic.length();
        let Whole { model, state, .. } = self.whole;
        let aim = engagement_rounding(model, (sought.link, sought.start), state).max(soon);
        for iteration in 0..2 * HALVINGS {
            let Cubic { a, b } = cubic;
            // A flight starts at the opening itself, where rounding may give a positive engagement.
            let start = (sought.engagement(&a) - aim).min(-f64::MIN_POSITIVE);
            let end = sought.engagement(&b) - aim;
            if end <= aim || cubic.length() <= self.resolution {
                break;
            }
            let value = |at: f64| sought.engagement(&cubic.at(at)) - aim;
            let found = roots::between(value, (a.at, start), (b.at, end), 0.0);
            let found = found.filter(|at| iteration < HALVINGS && a.at < *at && *at < b.at);
            let now = self.inside(sought.index, found.unwrap_or(f64::midpoint(a.at, b.at)));
            let value = sought.engagement(&now) - aim;
            if value.abs() <= aim {
                return now;
            }
            *(if value > 0.0 { &mut cubic.b } else { &mut cubic.a }) = now;
        }
        cubic.b
    }
}
