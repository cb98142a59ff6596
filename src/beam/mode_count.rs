//! How many modes a tolerance needs.
//!
//! A smooth motion needs few. A blow excites all of them, and what a cut-off sum misses shows in the force of the blow
//! and in what rings on. A wave of length `2 pi L / x` on the spring is excited as long as the contact is stiffer than
//! the spring in that wave: with time in `L^2 sqrt(rho A / E I)`, stiffness in `E I / L^3` and mass in `rho A L`,
//!
//! ```text
//! x^4 = s^2 / (1 + beta s)                                  waves of the damped beam at the rate s
//! k_j (1 + beta_c s) = (1 + beta s) x^3 + m s^2             contact = end of a long beam with its rivet
//! ```
//!
//! Beyond the `x` that solves both, damping and inertia win. The number of polynomials that a digit takes grows like
//! the root of that `x`: found on 70 random relays that open, and checked on others by `tests/promise.rs`. Where the spring
//! rings on, the errors of as many blows add up as fall within its decay.

use crate::beam::mode::Rayleigh;
use crate::beam::section::Section;
use crate::math::roots;
use crate::math::simd::LANES;

/// Digits that a tolerance of 1 takes already, 1. Chosen with [`PER_DIGIT`]: the least squares of those relays, and a fifth more (3.1 and
/// 0.47), left six of 2,000 relays not drawn before above tight tolerances for want of modes. Pinned: with those such relays among the
/// former excesses fail `tests/promise.rs`.
const FIRST_DIGITS: f64 = 2.0;

/// Modes per digit and root of `x`, 1. Pinned: the number that fits only the specimen's damping fails `tests/promise.rs`.
const PER_DIGIT: f64 = 0.6;

/// Least wave number, 1 / L: a jump of the base acceleration excites waves of the spring too, however soft the contact is. Pinned: without
/// it a closed soft contact among the former excesses fails `tests/promise.rs`.
const LEAST_WAVE_NUMBER: f64 = 10.0;

/// Damping of the first mode, relative to critical, below which a blow meets what is left of those before. Pinned:
/// without it the lightly damped relays among the former excesses fail `tests/promise.rs`.
const RINGING: f64 = 0.01;

/// Factor on them where the load is less smooth than in an impact of Hertz. Friction: as slip begins or ends its force bends,
/// and its lever excites a mode in proportion to its slope, which grows with its number. A contact stiffer at first touch: its
/// damping force begins more steeply than with the root of time, at a linear spring with a jump. Pinned: without it six relays
/// with friction among the former excesses, and those with linear springs, fail `tests/promise.rs`.
const STEEP: f64 = 1.5;

/// Most modes of a spring. Without damping no number is enough, and steps are as short as the period of the highest: 128 take more of
/// them than a communication step may.
pub const MOST: usize = 64;

/// A contact as the number of modes depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Blow {
    /// Stiffness of the contact in the blow, N/m.
    pub contact_stiffness: f64,
    /// beta_c of the contact, s.
    pub contact_damping: f64,
    /// Whether the moving spring has no rivet.
    pub bare: bool,
    /// Whether the load is less smooth than in an impact of Hertz: by friction, or by a contact that is stiffer at first touch.
    pub steep: bool,
}

impl Blow {
    /// Number of modes for a tolerance: a multiple of what the vectors of a step hold, at least three times that.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count, saturating")]
    pub fn modes(&self, section: &Section, damping: Rayleigh, tolerance: f64) -> usize {
        let first = 3.516 * section.rate();
        let ratio = 0.5 * (damping.alpha / first + damping.beta * first);
        // Undamped springs ring for ever, and no number of modes is right for that.
        let ringing = if ratio > 0.0 { RINGING / ratio } else { 1.0 };
        let digits = FIRST_DIGITS + ringing.log10().clamp(0.0, 1.0) - tolerance.log10();
        let steepness = if self.steep { STEEP } else { 1.0 };
        let per_digit = steepness * PER_DIGIT * self.wave_number(section, damping).max(LEAST_WAVE_NUMBER).sqrt();
        let count = digits * per_digit;
        (LANES * (count / LANES as f64).ceil().max(3.0) as usize).min(MOST)
    }

    /// The largest wave number `x` that the blow excites, 1 / L.
    fn wave_number(&self, section: &Section, damping: Rayleigh) -> f64 {
        let rate = section.rate();
        let stiffness = self.contact_stiffness * section.length.powi(3) / section.bending_stiffness;
        let mass = section.tip_mass / (section.mass_per_length * section.length);
        let (beam, contact) = (damping.beta * rate, self.contact_damping * rate);
        let wave = |s: f64| (s * s / (1.0 + beam * s)).sqrt().sqrt();
        let stiffer = |s: f64| stiffness * (1.0 + contact * s) - (1.0 + beam * s) * wave(s).powi(3) - mass * s * s;
        // In the logarithm of s, which may be anything. A rigid contact excites all modes.
        roots::bracketed(|logarithm| stiffer(logarithm.exp()), -100.0, 100.0).map_or(f64::INFINITY, |s| wave(s.exp()))
    }
}
