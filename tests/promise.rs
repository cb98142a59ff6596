//! The promise of `solver.tolerance` on random plausible relays ([`testing::relays`]): contact force and extremes are right
//! to the tolerance, relative to the larger of the force scale and the largest force so far. The reference is the same
//! relay at the tightest tolerance with the most modes.
//!
//! `RELAYS=2000 cargo test --release --test promise -- --nocapture` draws that many others.

#![allow(clippy::unwrap_used)]

use std::{env, thread};

use relay_contact::reference::MAX_MODES;
use relay_contact::scene::Solver;
use testing::relays::{Course, Relay};

/// What became of a relay.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    /// Within its tolerance.
    Kept,
    /// Above it, but so is what a change of the input by the tolerance of a step does.
    IllConditioned,
    /// Above it, by this factor.
    Above(f64),
    /// Refused for a physical reason, or more work than a communication step may take.
    NotRun,
}

/// The relay at the tightest tolerance with all modes, shaken and curved more strongly by a share.
fn reference(relay: &Relay, stronger: f64) -> Option<Course> {
    let course = relay.run(|scene| {
        scene.solver.tolerance = Solver::TOLERANCE_FLOOR;
        scene.solver.modes = i32::try_from(MAX_MODES).unwrap();
        scene.excitation.amplitude *= 1.0 + stronger;
        scene.excitation.spectral_density *= (1.0 + stronger).powi(2);
        scene.contact.curvature_radius *= 1.0 + stronger;
    });
    match course {
        Ok((course, None)) => Some(course),
        _ => None,
    }
}

/// Whether it opens, and the outcome.
fn judge(number: u64) -> (bool, Outcome) {
    let relay = Relay::draw(number);
    let tolerance = relay.scene.solver.tolerance;
    let larger = |(force, extremes): (f64, f64)| force.max(extremes) / tolerance;
    let Some(expected) = reference(&relay, 0.0) else {
        return (true, Outcome::NotRun);
    };
    let (course, failure) = relay.run(|_| {}).unwrap();
    assert_eq!(failure, None, "relay {number}");
    let ratio = larger(course.error(&expected));
    // A step may be wrong by one part in 250 of the tolerance.
    let outcome = match ratio {
        ..=1.0 => Outcome::Kept,
        _ => match reference(&relay, tolerance / 250.0) {
            Some(changed) if larger(changed.error(&expected)) > 1.0 => Outcome::IllConditioned,
            _ => Outcome::Above(ratio),
        },
    };
    if outcome != Outcome::Kept {
        println!(
            "relay {number}, asked {tolerance:.1e}, opens {}: {outcome:?}, {ratio:.2}",
            expected.opens()
        );
    }
    (expected.opens(), outcome)
}

#[test]
fn relays_keep_their_tolerance() {
    let (first, count) = match env::var("RELAYS") {
        Ok(count) => (10_000, count.parse().unwrap()),
        Err(_) => (0, 60),
    };
    let threads = thread::available_parallelism().unwrap().get() as u64;
    let judged: Vec<_> = thread::scope(|scope| {
        let part = |thread| {
            (first..first + count)
                .filter(move |number| number % threads == thread)
                .map(judge)
        };
        let parts: Vec<_> = (0..threads)
            .map(|thread| scope.spawn(move || part(thread).collect::<Vec<_>>()))
            .collect();
        parts.into_iter().flat_map(|part| part.join().unwrap()).collect()
    });
    let number = |opens: bool, is: fn(&Outcome) -> bool| {
        judged
            .iter()
            .filter(|(open, outcome)| *open == opens && is(outcome))
            .count()
    };
    for opens in [false, true] {
        println!(
            "{}: {} kept, {} ill-conditioned, {} above, {} not run",
            if opens { "open" } else { "closed" },
            number(opens, |outcome| *outcome == Outcome::Kept),
            number(opens, |outcome| *outcome == Outcome::IllConditioned),
            number(opens, |outcome| matches!(outcome, Outcome::Above(_))),
            number(opens, |outcome| *outcome == Outcome::NotRun),
        );
    }
    let all = |opens| number(opens, |_| true);
    let above = |opens| {
        number(opens, |outcome| {
            matches!(outcome, Outcome::Above(_) | Outcome::IllConditioned)
        })
    };
    assert!(all(true) > judged.len() / 3 && all(false) > judged.len() / 5);
    assert_eq!(above(false), 0, "closed contacts above the tolerance");
    assert!(
        100 * above(true) < all(true).max(1),
        "{} opening contacts above the tolerance",
        above(true)
    );
    assert!(100 * number(true, |outcome| *outcome == Outcome::NotRun) < 5 * judged.len());
}

/// Relays above their tolerance in earlier versions: where a half sine ends, inside a long step, and through the quadrature of
/// a random acceleration in flight.
#[test]
fn former_excesses_are_within_the_tolerance() {
    for number in [10_144, 10_769, 10_244] {
        assert_eq!(judge(number).1, Outcome::Kept);
    }
}
