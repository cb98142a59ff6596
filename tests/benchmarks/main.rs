//! Published and closed-form problems, a file each with its source and its digits.
//!
//! A contact force wrong by `e` (N) for a time `t` moves a free mass `m` by at most `e t^2 / (2 m)` and its velocity by
//! `e t / m`: from this and the tolerance asked follow the tolerances here.

#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;

mod energy;
mod forced_shock;
mod hertz_impact;
mod linear_scene;
mod opening_threshold;
mod restitution;
mod shock;
mod sphere_on_beam;

use relay_contact::contact::law::Law;
use relay_contact::contact::linear::Linear;

/// All digits given, the last one rounded, and `error` beside it.
fn digits(value: f64, published: f64, last_digit: f64, error: f64) {
    assert!(
        (value - published).abs() <= 0.5001 * last_digit + error,
        "{value} against {published}, {:e}",
        value - published
    );
}

/// A spring (N/m) that only pushes.
pub fn penalty(stiffness: f64) -> Law {
    Law::Linear(Linear {
        stiffness,
        damping: 0.0,
        offset: 0.0,
        bonded: false,
    })
}
