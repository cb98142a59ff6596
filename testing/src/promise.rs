//! Whether a random relay keeps the promise of `solver.tolerance`, and what `solver.forceError` says of it.

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
pub const OF_A_STEP: f64 = 1.0 / 250.0;

/// Makes a scene its own reference: the tightest tolerance with all modes, shaken and curved more strongly by a share.
pub fn tighten(scene: &mut Scene, stronger: f64) {
    scene.solver.tolerance = Solver::TOLERANCE_FLOOR;
    scene.solver.modes = i32::try_from(MAX_MODES).unwrap_or(i32::MAX);
    scene.excitation.amplitude *= 1.0 + stronger;
    scene.excitation.spectral_density *= (1.0 + stronger).powi(2);
    scene.contact.curvature_radius *= 1.0 + stronger;
}

fn reference(relay: &Relay, stronger: f64) -> Option<Course> {
    match relay.run(|scene| tighten(scene, stronger)) {
        Ok((course, None)) => Some(course),
        _ => None,
    }
}

/// A relay judged.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// Its number.
    pub number: u64,
    /// Its kind.
    pub kind: &'static str,
    /// Damping of the first mode of the spring without contact, relative to critical.
    pub damping: f64,
    /// Whether it opens.
    pub opens: bool,
    /// Tolerance asked.
    pub tolerance: f64,
    /// Largest error of force and extremes, relative as the tolerance.
    pub error: f64,
    /// Largest error of an instant of opening or closing, s; `None` if there are more or fewer of them.
    pub instants: Option<f64>,
    /// `solver.forceError` at the end.
    pub estimate: f64,
    /// The verdict.
    pub outcome: Outcome,
}

/// Judges the relay of a number, drawn by a function such as [`Relay::draw`].
///
/// # Panics
/// If it can be simulated at the tightest tolerance, but not at its own.
pub fn judge(number: u64, draw: fn(u64) -> Relay) -> Judged {
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
    let Some(expected) = reference(&relay, 0.0) else {
        return judged;
    };
    let Ok((course, None)) = relay.run(|_| {}) else {
        panic!("relay {number} does not run");
    };
    let larger = |(force, extremes): (f64, f64)| force.max(extremes);
    judged.opens = expected.opens();
    judged.estimate = course.estimate;
    judged.error = larger(course.error(&expected));
    judged.instants = course.error_of_instants(&expected);
    judged.outcome = if judged.error <= tolerance {
        Outcome::Kept
    } else {
        match reference(&relay, OF_A_STEP * tolerance) {
            Some(changed) if larger(changed.error(&expected)) > tolerance => Outcome::IllConditioned,
            _ => Outcome::Above,
        }
    };
    judged
}

/// Judges relays on all cores; in order.
pub fn judge_all(first: u64, count: u64, draw: fn(u64) -> Relay) -> Vec<Judged> {
    let threads = thread::available_parallelism().map_or(1, usize::from) as u64;
    let mut judged: Vec<_> = thread::scope(|scope| {
        let part = |thread| {
            let own = (first..first + count).filter(move |number| number % threads == thread);
            own.map(move |number| judge(number, draw)).collect::<Vec<_>>()
        };
        let parts: Vec<_> = (0..threads).map(|thread| scope.spawn(move || part(thread))).collect();
        parts
            .into_iter()
            .flat_map(|part| part.join().unwrap_or_default())
            .collect()
    });
    judged.sort_by_key(|judged| judged.number);
    judged
}
