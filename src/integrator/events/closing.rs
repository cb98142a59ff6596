//! Event location of closing: the first instant within a step of free flight at which there is a contact force.
//!
//! Sign changes alone would miss a grazing contact. Between two samples of indentation and velocity the indentation is
//! approximated by the Hermite cubic, whose error is estimated at a sample between them. If the maximum of the cubic
//! stays below first touch by more than this error there is no contact; otherwise the interval is bisected. Modes that
//! oscillate faster than the interval resolves are added with their amplitudes.

use crate::beam::mode::Mode;
use crate::integrator::collocation::part::Instant;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::{DEPTH, HALVINGS, SHORTEST_FLIGHT, UNSEEN};
use crate::integrator::events::{Cut, motion_rounding};
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::LONG;

impl Integration<'_> {
    /// Locates the closing in the trial of free flight of `length` seconds; `None` if the contact stays open.
    pub(crate) fn closing<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let samples = self.samples(trial, length);
        let samples = samples.get(..S + 1).unwrap_or_default();
        let unsure = self.unsure();
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
            [a, b] => self.touch_between((trial, length), (*a, *b), (error, unsure)),
            _ => None,
        })?;
        Some(self.cut(touch, true))
    }

    /// Samples at the start and the nodes of a step.
    fn samples<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> [Instant; LONG + 1]
    where
        Workspace: Room<S>,
    {
        let start = Instant {
            at: 0.0,
            d: self.state.indentation,
            rate: self.state.indentation_rate,
        };
        let mut samples = [start; LONG + 1];
        let nodes = self.collocation::<S>().nodes;
        for (entry, ((node, &d), &rate)) in samples
            .iter_mut()
            .skip(1)
            .zip(nodes.iter().zip(&trial.indentations).zip(&trial.rates))
        {
            *entry = Instant {
                at: node * length,
                d,
                rate,
            };
        }
        samples
    }

    /// Whether the contact certainly stays open between two open samples, whose cubic is wrong by `error` (m).
    fn is_clear(&self, a: &Instant, b: &Instant, error: f64, unsure: f64) -> bool {
        // A contact whose force is far below the tolerance need not be found.
        let negligible = self.model.law.overlap(1e-3 * self.tolerance);
        let (ripple, ripple_rate) = self.ripple(b.at - a.at);
        let (least, unseen) = (negligible.max(unsure), (error + ripple, ripple_rate));
        // A cubic wrong by this much in the middle has a slope wrong by four times that over its length at most.
        let steeper = 4.0 * error / (b.at - a.at);
        self.is_clear_along(a, b, unseen, least, 0)
            || self.is_clear_along(a, b, (unseen.0, unseen.1 + steeper), least, HALVINGS)
    }

    /// Whether the engagement stays below `least` (m) along the cubic of two samples, with `unseen` displacement (m) and
    /// velocity (m/s) beside it.
    fn is_clear_along(&self, a: &Instant, b: &Instant, unseen: (f64, f64), least: f64, halvings: u32) -> bool {
        let (d, rate) = (highest(a, b) + unseen.0, a.rate.max(b.rate) + unseen.1);
        if self.model.engagement(d, rate) < least {
            return true;
        }
        let middle = halfway(a, b);
        halvings > 0
            && self.is_clear_along(a, &middle, unseen, least, halvings - 1)
            && self.is_clear_along(&middle, b, unseen, least, halvings - 1)
    }

    /// Engagement that does not count as contact, m. Just after an opening: what the resolution of time has left of it
    /// there, and what rounding makes of the motion. Without it the contact would close as it opens, again and again.
    fn unsure(&self) -> f64 {
        let Self { model, state, .. } = self;
        if !self.released() {
            return 0.0;
        }
        let left = model.engagement(state.indentation, state.indentation_rate).max(0.0);
        left + motion_rounding(model, state)
    }

    /// Whether the flight begins here.
    fn released(&self) -> bool {
        self.state.last_opening == Some(self.state.time)
    }

    /// Whether oscillations faster than the interval between two samples are negligible.
    fn is_resolved(&self, a: &Instant, b: &Instant) -> bool {
        let (ripple, ripple_rate) = self.ripple(b.at - a.at);
        let [from, to] = [a, b].map(|sample| self.model.engagement(sample.d, sample.rate));
        ripple + self.model.law.damping() * ripple_rate <= UNSEEN * (to - from).abs()
    }

    /// Bound of tip displacement (m) and velocity (m/s) of the modes that oscillate within `interval` seconds or less.
    fn ripple(&self, interval: f64) -> (f64, f64) {
        let Self {
            model, state, drive, ..
        } = self;
        let swings = |mode: &Mode| mode.damping * mode.damping < 4.0 * mode.omega_squared;
        let fast = |mode: &Mode| mode.omega_squared * interval * interval > 1.0 && swings(mode);
        let acceleration = drive.acceleration(state.time);
        let (mut displacement, mut velocity) = (0.0, 0.0);
        for (mode, at) in model.modes.iter().zip(&state.modes).filter(|(mode, _)| fast(mode)) {
            let omega = mode.omega_squared.sqrt();
            let load = -mode.tip * model.preload.force - mode.participation * acceleration;
            let swing = mode.tip.abs() * (at.q - load / mode.omega_squared).hypot(at.v / omega);
            displacement += swing;
            velocity += omega * swing;
        }
        (displacement, velocity)
    }

    /// The first instant of closing between two samples; `error` (m) is the error of their cubic. Where that cannot tell, the
    /// interval is bisected, and the second half waits.
    fn touch_between<const S: usize>(
        &mut self,
        (trial, length): (&Trial<S>, f64),
        (mut a, b): (Instant, Instant),
        (error, unsure): (f64, f64),
    ) -> Option<Instant>
    where
        Workspace: Room<S>,
    {
        self.workspace.halves.clear();
        let (mut b, mut error, mut depth) = (b, error, 0);
        while !self.budget.is_exhausted(self.workspace) {
            if self.is_open(&b, unsure) {
                if self.is_clear(&a, &b, error, unsure) || depth > DEPTH {
                    a = b;
                    (b, error, depth) = self.workspace.halves.pop()?;
                    continue;
                }
            } else if a.rate >= 0.0 && highest(&a, &b) <= b.d && self.is_resolved(&a, &b) || depth > DEPTH {
                let touch = self.crossing((trial, length), &a, &b);
                // A contact that closes at the instant of opening still gets a short flight, so that time advances.
                let shortest = SHORTEST_FLIGHT * b.at;
                return Some(if self.released() && touch.at < shortest {
                    self.inside(trial, length, shortest)
                } else {
                    touch
                });
            }
            let middle = self.inside(trial, length, f64::midpoint(a.at, b.at));
            error = (middle.d - cubic(&a, &b, middle.at)).abs();
            depth += 1;
            self.workspace.halves.push((b, error, depth));
            b = middle;
        }
        None
    }

    /// The instant of closing between an open and a closed sample.
    fn crossing<const S: usize>(&mut self, (trial, length): (&Trial<S>, f64), a: &Instant, b: &Instant) -> Instant
    where
        Workspace: Room<S>,
    {
        let model = self.model;
        // Not before the touch: from there a step as short as rounding would find the contact open once more.
        let rounding = motion_rounding(model, self.state);
        let engagement = |d, rate| model.engagement(d, rate) - rounding;
        // A flight starts at the opening itself, where rounding may give a positive engagement.
        let start = engagement(a.d, a.rate).min(-f64::MIN_POSITIVE);
        self.instant(trial, length, engagement, (a.at, start), b.at, rounding)
    }

    fn is_open(&self, sample: &Instant, unsure: f64) -> bool {
        self.model.engagement(sample.d, sample.rate) <= unsure
    }
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
