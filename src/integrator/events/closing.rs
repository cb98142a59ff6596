//! Event location of closing: the first instant within a step of free flight at which there is a contact force.
//!
//! Sign changes alone would miss a grazing contact. Between two samples of indentation and velocity the indentation is
//! approximated by the Hermite cubic, whose error is estimated at a sample between them. If the maximum of the cubic
//! stays below first touch by more than this error there is no contact; otherwise the interval is bisected. Modes that
//! oscillate faster than the interval resolves are added with their amplitudes.

use crate::beam::mode::Mode;
use crate::contact::law::Law;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::constants::{DISTANT, HALVINGS, SHORTEST_FLIGHT, UNSEEN};
use crate::integrator::events::{Cut, Event, Locator, motion_rounding};
use crate::link::Link;
use crate::math::nodal::LONG;
use crate::state::LinkState;

/// Halvings of the cubic between two samples before the motion in their middle is computed.
const ON_CUBIC: u32 = 3;

/// An open contact in which a touch is sought.
#[derive(Clone, Copy)]
struct Sought<'a> {
    index: usize,
    link: &'a Link,
    law: &'a Law,
    start: &'a LinkState,
    /// Engagement that does not count as contact, m.
    unsure: f64,
}

impl<const S: usize> Locator<'_, S> {
    /// Locates the closing of an open contact; `None` if it stays open.
    pub(crate) fn closing(&mut self, index: usize) -> Option<Cut> {
        let (link, start) = self.link(index)?;
        let sought = Sought {
            index,
            link,
            law: link.contact()?,
            start,
            unsure: self.unsure(link, start),
        };
        let samples = self.samples(&sought)?;
        let samples = samples.get(..S + 1)?;
        if self.is_distant(&sought, samples) {
            return None;
        }
        // The cubic over two intervals is wrong by more than that over each.
        let mut errors = [0.0_f64; LONG + 1];
        for (k, triple) in samples.windows(3).enumerate() {
            if let [a, b, c] = triple {
                let error = (b.d - cubic(a, c, b.at)).abs();
                for entry in errors.iter_mut().skip(k).take(2) {
                    *entry = entry.max(error);
                }
            }
        }
        let touch = samples.windows(2).zip(errors).find_map(|(pair, error)| match pair {
            [a, b] => self.touch_between(&sought, (*a, *b), error),
            _ => None,
        })?;
        Some(Cut {
            at: touch.at,
            time: self.whole.state.time + touch.at,
            event: Event::Switches(index),
        })
    }

    /// Samples at the start and the nodes of the trial.
    fn samples(&self, sought: &Sought) -> Option<[Instant; LONG + 1]> {
        let Whole {
            collocation,
            trial,
            length,
            ..
        } = self.whole;
        let start = Instant {
            at: 0.0,
            d: sought.start.approach,
            rate: sought.start.rate,
        };
        let mut samples = [start; LONG + 1];
        let nodes = trial.links.get(sought.index)?;
        let motion = nodes.approaches.iter().zip(&nodes.rates);
        for (entry, (node, (&d, &rate))) in samples.iter_mut().skip(1).zip(collocation.nodes.iter().zip(motion)) {
            *entry = Instant {
                at: node * length,
                d,
                rate,
            };
        }
        Some(samples)
    }

    /// Whether the contact is so far that no search is needed.
    fn is_distant(&self, sought: &Sought, samples: &[Instant]) -> bool {
        let (mut lowest, mut highest, mut fastest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for Instant { d, rate, .. } in samples {
            (lowest, highest, fastest) = (lowest.min(*d), highest.max(*d), fastest.max(rate.abs()));
        }
        let reach = DISTANT * (highest - lowest + fastest * self.whole.length);
        sought.link.engagement(highest + reach, DISTANT * fastest) < 0.0
    }

    /// Whether the contact certainly stays open between two open samples, whose cubic is wrong by `error` (m).
    fn is_clear(&self, sought: &Sought, a: &Instant, b: &Instant, error: f64) -> bool {
        // A contact whose force is far below the tolerance need not be found.
        let negligible = sought.law.overlap(self.tolerance.located);
        let (ripple, ripple_rate) = self.ripple(sought, b.at - a.at);
        let (least, unseen) = (negligible.max(sought.unsure), (error + ripple, ripple_rate));
        // A cubic wrong by this much in the middle has a slope wrong by four times that over its length at most.
        let steeper = 4.0 * error / (b.at - a.at);
        is_clear_along(sought.link, a, b, unseen, least, 0)
            || is_clear_along(sought.link, a, b, (unseen.0, unseen.1 + steeper), least, ON_CUBIC)
    }

    /// Engagement that does not count as contact, m. Just after an opening: what the resolution of time has left of it
    /// there, and what rounding makes of the motion. Without it the contact would close as it opens, again and again.
    fn unsure(&self, link: &Link, start: &LinkState) -> f64 {
        let Whole { model, state, .. } = self.whole;
        if start.last_opening != Some(state.time) {
            return 0.0;
        }
        let left = link.engagement(start.approach, start.rate).max(0.0);
        left + motion_rounding(model, link, state)
    }

    /// Whether oscillations faster than the interval between two samples are negligible.
    fn is_resolved(&self, sought: &Sought, a: &Instant, b: &Instant) -> bool {
        let (ripple, ripple_rate) = self.ripple(sought, b.at - a.at);
        let [from, to] = [a, b].map(|sample| sought.link.engagement(sample.d, sample.rate));
        ripple + sought.law.damping() * ripple_rate <= UNSEEN * (to - from).abs()
    }

    /// Bound of displacement (m) and velocity (m/s) of a contact by the modes that oscillate within `interval` seconds or less.
    fn ripple(&self, sought: &Sought, interval: f64) -> (f64, f64) {
        let Whole {
            model, state, drive, ..
        } = self.whole;
        let swings = |mode: &Mode| mode.damping * mode.damping < 4.0 * mode.omega_squared;
        let fast = |mode: &Mode| mode.omega_squared * interval * interval > 1.0 && swings(mode);
        let acceleration = drive.acceleration(state.time);
        let (mut displacement, mut velocity) = (0.0, 0.0);
        let modes = model.modes.iter().zip(&state.modes).enumerate();
        for (i, (mode, at)) in modes.filter(|(_, (mode, _))| fast(mode)) {
            let factor = |port: usize| {
                let shape = model.ports.get(port).map(|port| &port.shape);
                shape.and_then(|shape| shape.get(i)).copied().unwrap_or_default()
            };
            let omega = mode.omega_squared.sqrt();
            let links = model.links.iter().zip(&state.links);
            let load = links.fold(-mode.participation * acceleration, |load, (link, at)| {
                load + link.sense * factor(link.port) * (at.force - link.force)
            });
            let swing = factor(sought.link.port).abs() * (at.q - load / mode.omega_squared).hypot(at.v / omega);
            displacement += swing;
            velocity += omega * swing;
        }
        (displacement, velocity)
    }

    /// The first instant of closing between two samples; `error` (m) is the error of their cubic. Where that cannot tell, the
    /// interval is bisected, and the second half waits.
    fn touch_between(&mut self, sought: &Sought, (mut a, b): (Instant, Instant), error: f64) -> Option<Instant> {
        let released = sought.start.last_opening == Some(self.whole.state.time);
        self.search.halves.clear();
        let (mut b, mut error, mut depth) = (b, error, 0);
        while !self.budget.is_exhausted(self.search) {
            if sought.link.engagement(b.d, b.rate) <= sought.unsure {
                if self.is_clear(sought, &a, &b, error) || depth > HALVINGS {
                    a = b;
                    (b, error, depth) = self.search.halves.pop()?;
                    continue;
                }
            } else if a.rate >= 0.0 && highest(&a, &b) <= b.d && self.is_resolved(sought, &a, &b) || depth > HALVINGS {
                let touch = self.crossing(sought, &a, &b);
                // A contact that closes at the instant of opening still gets a short flight, so that time advances.
                let shortest = SHORTEST_FLIGHT * b.at;
                return Some(if released && touch.at < shortest {
                    self.inside(sought.index, shortest)
                } else {
                    touch
                });
            }
            let middle = self.inside(sought.index, f64::midpoint(a.at, b.at));
            error = (middle.d - cubic(&a, &b, middle.at)).abs();
            depth += 1;
            self.search.halves.push((b, error, depth));
            b = middle;
        }
        None
    }

    /// The instant of closing between an open and a closed sample.
    fn crossing(&mut self, sought: &Sought, a: &Instant, b: &Instant) -> Instant {
        let Whole { model, state, .. } = self.whole;
        let link = sought.link;
        // Not before the touch: from there a step as short as rounding would find the contact open once more.
        let rounding = motion_rounding(model, link, state);
        let engagement = |d, rate| link.engagement(d, rate) - rounding;
        // A flight starts at the opening itself, where rounding may give a positive engagement.
        let start = engagement(a.d, a.rate).min(-f64::MIN_POSITIVE);
        self.instant(sought.index, engagement, (a.at, start), b.at, rounding)
    }
}

/// Whether the engagement of a contact stays below `least` (m) along the cubic of two samples, with `unseen` displacement (m) and
/// velocity (m/s) beside it.
fn is_clear_along(link: &Link, a: &Instant, b: &Instant, unseen: (f64, f64), least: f64, halvings: u32) -> bool {
    let (d, rate) = (highest(a, b) + unseen.0, a.rate.max(b.rate) + unseen.1);
    if link.engagement(d, rate) < least {
        return true;
    }
    let middle = halfway(a, b);
    halvings > 0
        && is_clear_along(link, a, &middle, unseen, least, halvings - 1)
        && is_clear_along(link, &middle, b, unseen, least, halvings - 1)
}

/// The Hermite cubic of two samples at an instant, m.
fn cubic(a: &Instant, b: &Instant, at: f64) -> f64 {
    let h = b.at - a.at;
    let x = (at - a.at) / h;
    let y = 1.0 - x;
    a.d * (y * y * (1.0 + 2.0 * x))
        + b.d * (x * x * (1.0 + 2.0 * y))
        + h * (a.rate * (x * y * y) - b.rate * (x * x * y))
}

/// The Hermite cubic of two samples halfway.
fn halfway(a: &Instant, b: &Instant) -> Instant {
    let at = f64::midpoint(a.at, b.at);
    Instant {
        at,
        d: cubic(a, b, at),
        rate: 1.5 * (b.d - a.d) / (b.at - a.at) - 0.25 * (a.rate + b.rate),
    }
}

/// Maximum of the Hermite cubic between the two samples, m.
fn highest(a: &Instant, b: &Instant) -> f64 {
    let h = b.at - a.at;
    let ends = a.d.max(b.d);
    // Slope of the cubic: h d' = p x^2 + q x + r.
    let rise = b.d - a.d;
    let p = 3.0 * (h * (a.rate + b.rate) - 2.0 * rise);
    let q = 6.0 * rise - 2.0 * h * (2.0 * a.rate + b.rate);
    let r = h * a.rate;
    let root = (q * q - 4.0 * p * r).max(0.0).sqrt();
    let larger = -0.5 * (q + root.copysign(q));
    [larger / p, r / larger]
        .into_iter()
        .filter(|x| 0.0 < *x && *x < 1.0)
        .fold(ends, |high, x| high.max(cubic(a, b, a.at + x * h)))
}
