//! Event location of closing: the first instant within a step of free flight at which there is a contact force.
//!
//! Sign changes alone would miss a grazing contact. Between two samples of indentation and velocity the indentation is
//! approximated by the Hermite cubic, whose error is estimated at a sample between them. If the maximum of the cubic
//! stays below first touch by more than this error there is no contact; otherwise the interval is bisected. Modes that
//! oscillate faster than the interval resolves are added with their amplitudes.

use crate::beam::mode::Mode;
use crate::integrator::collocation::step::{Trial, sum_rounding};
use crate::integrator::constants::{DEPTH, SHORTEST_FLIGHT, UNSEEN};
use crate::integrator::events::Cut;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::LONG;
use crate::math::roots;

/// Indentation and its velocity at an instant of the step.
#[derive(Clone, Copy, Debug)]
struct Sample {
    /// From the start of the step, s.
    at: f64,
    /// Indentation as deviation from the preload, m.
    d: f64,
    /// Its velocity, m/s.
    rate: f64,
}

impl Integration<'_> {
    /// Where in the step of free flight of `length` seconds the contact may first close, 0 to 1: the start of the first
    /// interval between samples in which closing cannot be excluded.
    pub(crate) fn first_near<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let (samples, error) = self.samples(trial, length);
        let samples = samples.get(..S + 1).unwrap_or_default();
        let unsure = self.unsure();
        samples.windows(2).find_map(|pair| match pair {
            [a, b] => (!self.is_open(b, unsure) || !self.is_clear(a, b, error, unsure)).then_some(a.at / length),
            _ => None,
        })
    }

    /// Locates the closing in the step of free flight of `length` seconds; `None` if the contact stays open.
    pub(crate) fn closing<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let (samples, error) = self.samples(trial, length);
        let samples = samples.get(..S + 1).unwrap_or_default();
        let unsure = self.unsure();
        let length = samples.windows(2).find_map(|pair| match pair {
            [a, b] => self.touch_between::<S>(a, b, error, unsure, 0),
            _ => None,
        })?;
        Some(Cut {
            length,
            switches: true,
            mirrors: false,
        })
    }

    /// Samples at the start and the nodes of a step, and the error of the cubics between them, m.
    fn samples<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> ([Sample; LONG + 1], f64)
    where
        Workspace: Room<S>,
    {
        let start = Sample {
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
            *entry = Sample {
                at: node * length,
                d,
                rate,
            };
        }
        let error = samples
            .windows(3)
            .take(S - 1)
            .filter_map(|triple| match triple {
                [a, b, c] => Some((b.d - cubic(a, c, b.at)).abs()),
                _ => None,
            })
            .fold(0.0, f64::max);
        (samples, error)
    }

    /// Whether the contact certainly stays open between two open samples.
    fn is_clear(&self, a: &Sample, b: &Sample, error: f64, unsure: f64) -> bool {
        // A contact whose force is far below the tolerance need not be found.
        let negligible = self.model.law.overlap(1e-3 * self.tolerance);
        let (ripple, ripple_rate) = self.ripple(b.at - a.at);
        let (d, rate) = (highest(a, b) + ripple, a.rate.max(b.rate) + ripple_rate);
        self.model.engagement(d, rate) + error < negligible.max(unsure)
    }

    /// Engagement that does not count as contact, m. Just after an opening: what the resolution of time has left of it
    /// there, and what rounding makes of the motion. Without it the contact would close as it opens, again and again.
    fn unsure(&self) -> f64 {
        let Self { model, state, .. } = self;
        if !self.released() {
            return 0.0;
        }
        let (displacement, velocity) = sum_rounding(model, state);
        let left = model.engagement(state.indentation, state.indentation_rate).max(0.0);
        left + displacement + model.law.damping() * velocity
    }

    /// Whether the flight begins here.
    fn released(&self) -> bool {
        self.state.last_opening == self.state.time
    }

    /// Whether oscillations faster than the interval between two samples are negligible.
    fn is_resolved(&self, a: &Sample, b: &Sample) -> bool {
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

    /// The first instant of closing between two samples, s from the start of the step; `error` (m) is the error of
    /// their cubic.
    fn touch_between<const S: usize>(
        &mut self,
        a: &Sample,
        b: &Sample,
        error: f64,
        unsure: f64,
        depth: u32,
    ) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        if self.is_open(b, unsure) {
            if self.is_clear(a, b, error, unsure) || depth > DEPTH {
                return None;
            }
        } else if a.rate >= 0.0 && highest(a, b) <= b.d && self.is_resolved(a, b) || depth > DEPTH {
            let touch = self.crossing::<S>(a, b);
            // A contact that closes at the instant of opening still gets a short flight, so that time advances.
            return Some(if self.released() {
                touch.max(SHORTEST_FLIGHT * b.at)
            } else {
                touch
            });
        }
        let middle = self.sample::<S>(f64::midpoint(a.at, b.at));
        let error = (middle.d - cubic(a, b, middle.at)).abs();
        self.touch_between::<S>(a, &middle, error, unsure, depth + 1)
            .or_else(|| self.touch_between::<S>(&middle, b, error, unsure, depth + 1))
    }

    /// The instant of closing between an open and a closed sample, s from the start of the step.
    fn crossing<const S: usize>(&mut self, a: &Sample, b: &Sample) -> f64
    where
        Workspace: Room<S>,
    {
        let model = self.model;
        let engagement = |sample: &Sample| model.engagement(sample.d, sample.rate);
        // A flight starts at the opening itself, where rounding may give a positive engagement.
        let start = engagement(a).min(-f64::MIN_POSITIVE);
        let resolution = self.resolution();
        let overlap = |at| engagement(&self.sample::<S>(at));
        roots::between(overlap, (a.at, start), (b.at, engagement(b)), resolution).unwrap_or(b.at)
    }

    fn is_open(&self, sample: &Sample, unsure: f64) -> bool {
        self.model.engagement(sample.d, sample.rate) <= unsure
    }

    fn sample<const S: usize>(&mut self, at: f64) -> Sample
    where
        Workspace: Room<S>,
    {
        let (d, rate) = self
            .probe(at)
            .map_or((f64::NAN, f64::NAN), |trial| (trial.indentation, trial.rate));
        Sample { at, d, rate }
    }
}

/// The Hermite cubic of two samples at an instant, m.
fn cubic(a: &Sample, b: &Sample, at: f64) -> f64 {
    let h = b.at - a.at;
    let x = (at - a.at) / h;
    let y = 1.0 - x;
    a.d * (y * y * (1.0 + 2.0 * x))
        + b.d * (x * x * (1.0 + 2.0 * y))
        + h * (a.rate * (x * y * y) - b.rate * (x * x * y))
}

/// Maximum of the Hermite cubic between the two samples, m.
fn highest(a: &Sample, b: &Sample) -> f64 {
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
