//! The contact closes: the first instant within a step of free flight at which the force leaves zero.
//!
//! Looking at signs alone would miss a grazing touch. Between neighbouring instants at which indentation and velocity
//! are known, the indentation is a cubic but for an error that the middle one of any three shows. Where the cubic's
//! highest point clears zero by more than that error there is no touch; elsewhere the interval is halved. Modes that
//! swing within the interval unseen count with their amplitudes.

use crate::beam::mode::Mode;
use crate::integrator::collocation::step::Trial;
use crate::integrator::events::Cut;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::LONG;
use crate::math::roots;

/// Halvings before an interval counts as an instant.
const DEPTH: u32 = 40;

/// Part of what the engagement changes by between two samples that may go unseen.
const UNSEEN: f64 = 1e-2;

/// Part of the flight looked at that a contact stays open at least.
const SHORTEST_FLIGHT: f64 = 1e-3;

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
    /// Where in the step of free flight of `length` seconds (in steps) the contact may first close: the start of the
    /// first interval between samples in which it is not clear of it.
    pub(crate) fn first_near<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let (samples, error) = self.samples(trial, length);
        let samples = samples.get(..S + 1).unwrap_or_default();
        samples.windows(2).find_map(|pair| match pair {
            [a, b] => (!self.is_open(b) || !self.is_clear(a, b, error)).then_some(a.at / length),
            _ => None,
        })
    }

    /// Where the step of free flight of `length` seconds has to end because the contact closes, if it does.
    pub(crate) fn closing<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let (samples, error) = self.samples(trial, length);
        let samples = samples.get(..S + 1).unwrap_or_default();
        let length = samples.windows(2).find_map(|pair| match pair {
            [a, b] => self.touch_between::<S>(a, b, error, 0),
            _ => None,
        })?;
        Some(Cut { length, switches: true })
    }

    /// Start and nodes of a step, and by how much the cubics between them are wrong, m.
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

    /// Whether the contact stays open between two open samples.
    fn is_clear(&self, a: &Sample, b: &Sample, error: f64) -> bool {
        // An overlap whose force is lost in the tolerance need not be found.
        let negligible = self.model.law.overlap(1e-3 * self.tolerance);
        let (ripple, ripple_rate) = self.ripple(b.at - a.at);
        let (d, rate) = (highest(a, b) + ripple, a.rate.max(b.rate) + ripple_rate);
        self.model.engagement(d, rate) + error < negligible
    }

    /// Whether no mode swings between two samples unseen.
    fn is_resolved(&self, a: &Sample, b: &Sample) -> bool {
        let (ripple, ripple_rate) = self.ripple(b.at - a.at);
        let [from, to] = [a, b].map(|sample| self.model.engagement(sample.d, sample.rate));
        ripple + self.model.law.damping() * ripple_rate <= UNSEEN * (to - from).abs()
    }

    /// How far and how fast at most the modes that swing within `interval` seconds or less move the tip, m and m/s.
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

    /// The first instant between two samples (s from the start of the step) at which the contact closes; their cubic is
    /// wrong by about `error` (m).
    fn touch_between<const S: usize>(&mut self, a: &Sample, b: &Sample, error: f64, depth: u32) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        if self.is_open(b) {
            if self.is_clear(a, b, error) || depth > DEPTH {
                return None;
            }
        } else if a.rate >= 0.0 && highest(a, b) <= b.d && self.is_resolved(a, b) || depth > DEPTH {
            let touch = self.crossing::<S>(a, b);
            // A contact that closes as it opens has been open all the same: the steps have to get on.
            let released = self.state.last_opening == self.state.time;
            return Some(if released {
                touch.max(SHORTEST_FLIGHT * b.at)
            } else {
                touch
            });
        }
        let middle = self.sample::<S>(f64::midpoint(a.at, b.at));
        let error = (middle.d - cubic(a, b, middle.at)).abs();
        self.touch_between::<S>(a, &middle, error, depth + 1)
            .or_else(|| self.touch_between::<S>(&middle, b, error, depth + 1))
    }

    /// The instant of closing between an open and a closed sample.
    fn crossing<const S: usize>(&mut self, a: &Sample, b: &Sample) -> f64
    where
        Workspace: Room<S>,
    {
        let model = self.model;
        let engagement = |sample: &Sample| model.engagement(sample.d, sample.rate);
        // A flight starts at the release itself; rounding must not make it look closed.
        let start = engagement(a).min(-f64::MIN_POSITIVE);
        let resolution = self.resolution();
        let overlap = |at| engagement(&self.sample::<S>(at));
        roots::between(overlap, (a.at, start), (b.at, engagement(b)), resolution).unwrap_or(b.at)
    }

    fn is_open(&self, sample: &Sample) -> bool {
        self.model.engagement(sample.d, sample.rate) <= 0.0
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

/// The cubic through two samples and their velocities, at an instant.
fn cubic(a: &Sample, b: &Sample, at: f64) -> f64 {
    let h = b.at - a.at;
    let x = (at - a.at) / h;
    let y = 1.0 - x;
    a.d * (y * y * (1.0 + 2.0 * x))
        + b.d * (x * x * (1.0 + 2.0 * y))
        + h * (a.rate * (x * y * y) - b.rate * (x * x * y))
}

/// Highest value of the cubic between the two samples.
fn highest(a: &Sample, b: &Sample) -> f64 {
    let h = b.at - a.at;
    let ends = a.d.max(b.d);
    // Slope of the cubic, h w' = p x^2 + q x + r.
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
