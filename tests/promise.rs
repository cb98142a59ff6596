//! The promise of `solver.tolerance` on random plausible relays ([`testing::relays`]): contact force and extremes are right
//! to the tolerance, relative to the larger of the force scale and the largest force so far. The reference is the same
//! relay at the tightest tolerance with the most modes. `cargo run --release --package benches --bin promise` judges 2,000
//! others.

use testing::promise::{Judged, Outcome, judge, judge_all};

/// Relays judged.
const COUNT: u64 = 60;

#[test]
fn relays_keep_their_tolerance_or_say_that_they_may_not() {
    let judged = judge_all(0, COUNT);
    assert_eq!(judged.len() as u64, COUNT, "a relay does not run");
    for judged in judged.iter().filter(|judged| judged.outcome != Outcome::Kept) {
        println!("{judged:?}");
    }
    let number = |is: fn(&Judged) -> bool| judged.iter().filter(|judged| is(judged)).count() as u64;
    let opening = number(|judged| judged.opens);
    assert!(opening > COUNT / 3 && COUNT - opening > COUNT / 5);
    let above = number(|judged| !judged.opens && judged.error > judged.tolerance);
    assert_eq!(above, 0, "closed contacts above the tolerance");
    // Ill-conditioned ones may be above it, but not in silence.
    let silent = number(|judged| judged.error > judged.tolerance.max(judged.estimate));
    assert!(
        100 * silent < opening,
        "{silent} opening contacts above the tolerance in silence"
    );
    assert!(100 * number(|judged| judged.outcome == Outcome::NotRun) < 5 * COUNT);
    // The factor of the estimate is that with which 95 % of many relays have a smaller error: three standard deviations.
    let safe = number(|judged| judged.error <= judged.estimate) as f64 / COUNT as f64;
    assert!(safe > 0.95 - 3.0 * (0.05 * 0.95 / COUNT as f64).sqrt(), "{safe}");
}

/// Relays above their tolerance in earlier versions: where a half sine ends, inside a long step, and through the quadrature of
/// a random acceleration in flight.
#[test]
fn former_excesses_are_within_the_tolerance() {
    for number in [10_144, 10_769, 10_244] {
        assert_eq!(judge(number).outcome, Outcome::Kept);
    }
}
