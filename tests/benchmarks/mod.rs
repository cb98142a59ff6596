//! Published and closed-form problems, a file each with its source and its digits.
//!
//! A contact force wrong by `e` (N) for a time `t` moves a free mass `m` by at most `e t^2 / (2 m)` and its velocity by
//! `e t / m`: from this and the tolerance asked follow the tolerances here.

mod forced_shock;
mod hertz_impact;
mod linear_scene;
mod opening_threshold;
mod restitution;
mod shock;
mod sphere_on_beam;

use testing::near;

/// All digits given, the last one rounded, and `error` beside it.
fn digits(value: f64, published: f64, last_digit: f64, error: f64) {
    near("published", value, published, 0.5001 * last_digit + error);
}
