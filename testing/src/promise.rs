//! Whether a random relay keeps the promise of `solver.tolerance`, and what `solver.forceError` says of it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::thread;

use relay_contact::reference::MAX_MODES;
use relay_contact::scene::{Scene, Solver};

use crate::relays::{Course, Relay};

/// What became of a relay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Within its tolerance.
    Kept,
    /// Above it, but so is what a change of the input by the tolerance of a step does.
    IllConditioned,
    /// Above it.
    Above,
    /// Refused for a physical reason, or more work than a communication step may take.
    NotRun,
}

/// Part of the tolerance by which a single step may be wrong, 1: a change of the input by as much is not seen.
pub const OF_A_STEP: f64 = 0.004;

/// Difference of a reference from itself in shorter communication steps over what it says of its error, 1: a tenth of all it is used
/// for, tolerances of 1e-8 and more.
const UNSEEN: f64 = 100.0;

/// Makes a scene its own reference: all modes, a part of its tolerance but the tightest at least, shaken and curved more strongly by
/// a share.
pub fn tighten(scene: &mut Scene, part: f64, stronger: f64) {
    scene.solver.tolerance = f64::max(part * scene.solver.tolerance, Solver::TOLERANCE_FLOOR);
    scene.solver.modes = i32::try_from(MAX_MODES).unwrap_or(i32::MAX);
    scene.excitation.amplitude *= 1.0 + stronger;
    scene.excitation.spectral_density *= (1.0 + stronger).powi(2);
    let (first, second, parallel) = (&mut scene.contact, &mut scene.second, &mut scene.parallel);
    for radius in [&mut first.curvature_radius, &mut second.curvature_radius, &mut parallel.curvature_radius] {
        *radius *= 1.0 + stronger;
    }
}

fn reference(relay: &Relay, part: f64, stronger: f64) -> Option<Course> {
    match relay.run(|scene| tighten(scene, part, stronger)) {
        Ok((course, None)) => Some(course),
        _ => None,
    }
}

/// A relay, and its reference at a `part` of its tolerance, or at the tightest if that is 0; `None` if it has none.
pub fn beside_reference(relay: &Relay, part: f64) -> Option<(Course, Course)> {
    let expected = reference(relay, part, 0.0)?;
    let Ok((course, None)) = relay.run(|_| {}) else { panic!("does not run: {relay:?}") };
    Some((course, expected))
}

/// The reference of a relay beside itself in communication steps of a quarter.
#[derive(Clone, Copy, Debug)]
pub struct Disagreement {
    pub number: u64,
    pub kind: &'static str,
    /// Largest difference of force and extremes, relative as the tolerance.
    pub difference: f64,
    /// Numbers of openings and closings.
    pub events: [usize; 2],
    /// The larger `solver.forceError` at the end.
    pub estimate: f64,
}

impl Disagreement {
    /// Whether the reference is wrong without a word: what both differ by is [`UNSEEN`] times the estimate or the tightest tolerance,
    /// or there are more events in one of them though the force is known.
    pub fn is_silent(&self) -> bool {
        let known = UNSEEN * self.estimate.max(Solver::TOLERANCE_FLOOR);
        self.difference > known || known < 1e-3 && self.events[0] != self.events[1]
    }
}

/// Compares the reference of the relay of a number, drawn by a function such as [`Relay::draw`], with itself; `None` if it has none.
pub fn compare(number: u64, draw: fn(u64) -> Relay) -> Option<Disagreement> {
    let mut relay = draw(number);
    let whole = reference(&relay, 0.0, 0.0)?;
    relay.parts = 4;
    let parts = reference(&relay, 0.0, 0.0)?;
    Some(Disagreement {
        number,
        kind: relay.kind,
        difference: parts.error(&whole),
        events: [whole.events.len(), parts.events.len()],
        estimate: whole.estimate.max(parts.estimate),
    })
}

/// A relay judged.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    pub number: u64,
    pub kind: &'static str,
    /// Damping of the first mode of the spring without contact, relative to critical.
    pub damping: f64,
    pub opens: bool,
    pub tolerance: f64,
    /// Largest error of force and extremes, relative as the tolerance.
    pub error: f64,
    /// Largest error of an instant of opening or closing, s; `None` if there are more or fewer of them.
    pub instants: Option<f64>,
    /// `solver.forceError` at the end.
    pub estimate: f64,
    pub outcome: Outcome,
}

/// Judges the relay of a number, drawn by a function such as [`Relay::draw`], against itself at a `part` of its tolerance, or at the
/// tightest if that is 0.
pub fn judge(number: u64, draw: fn(u64) -> Relay, part: f64) -> Judged {
    let relay = draw(number);
    let tolerance = relay.scene.solver.tolerance;
    let mut judged = Judged {
        number,
        kind: relay.kind,
        damping: relay.damping,
        opens: true,
        tolerance,
        error: 0.0,
        instants: None,
        estimate: 0.0,
        outcome: Outcome::NotRun,
    };
    let Some((course, expected)) = beside_reference(&relay, part) else { return judged };
    judged.opens = expected.opens();
    judged.estimate = course.estimate;
    judged.error = course.error(&expected);
    judged.instants = course.error_of_instants(&expected);
    judged.outcome = if judged.error <= tolerance {
        Outcome::Kept
    } else {
        match reference(&relay, part, OF_A_STEP * tolerance) {
            Some(changed) if changed.error(&expected) > tolerance => Outcome::IllConditioned,
            _ => Outcome::Above,
        }
    };
    judged
}

/// Judges relays on all cores; in order.
pub fn judge_all(first: u64, count: u64, draw: fn(u64) -> Relay, part: f64) -> Vec<Judged> {
    let mut all = Vec::new();
    judge_each(first, count, draw, part, |judged| all.push(judged));
    all
}

/// Judges relays on all cores and tells each, in order, as soon as it and those before it are judged.
pub fn judge_each(first: u64, count: u64, draw: fn(u64) -> Relay, part: f64, tell: impl FnMut(Judged) + Send) {
    on_all_cores(first..first + count, |number| judge(number, draw, part), tell);
}

/// Compares references on all cores; in order.
pub fn compare_all(first: u64, count: u64, draw: fn(u64) -> Relay) -> Vec<Disagreement> {
    let mut all = Vec::new();
    on_all_cores(first..first + count, |number| compare(number, draw), |one| all.extend(one));
    all
}

fn on_all_cores<T: Send>(numbers: Range<u64>, of: impl Fn(u64) -> T + Sync, tell: impl FnMut(T) + Send) {
    let done = Mutex::new((numbers.clone(), BTreeMap::new(), tell));
    let left = Mutex::new(numbers);
    // Each thread takes the next once it has done one, as some take a hundred times as long as others.
    let next = || left.lock().unwrap().next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(number) = next() {
                    let one = of(number);
                    let (untold, found, tell) = &mut *done.lock().unwrap();
                    found.insert(number, one);
                    while let Some(one) = found.remove(&untold.start) {
                        tell(one);
                        untold.next();
                    }
                }
            });
        }
    });
}
