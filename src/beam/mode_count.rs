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
//! the root of that `x`: found, with its factors, on 70 random relays that open, and checked on others by
//! `tests/promise.rs`.

use crate::beam::section::Section;

/// Modes at no tolerance in digits, and modes per root of `x` and digit, 1: the least squares of those relays, and a fifth
/// more. Pinned: the number that fits only the specimen's damping, `tests/promise.rs`.
const FIRST_DIGITS: f64 = 3.1;
const PER_DIGIT: f64 = 0.47;

/// Contact and damping as the number of modes depends on them.
#[derive(Clone, Copy, Debug)]
pub struct Blow {
    /// beta of the spring, s.
    pub stiffness_damping: f64,
    /// Stiffness of the contact in the blow, N/m.
    pub contact_stiffness: f64,
    /// beta_c of the contact, s.
    pub contact_damping: f64,
}

impl Blow {
    /// Number of modes for a tolerance; the vectors of a step hold four, so a multiple of it.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive count, saturating"
    )]
    pub fn modes(&self, section: &Section, tolerance: f64) -> usize {
        let digits = FIRST_DIGITS - tolerance.log10();
        let count = PER_DIGIT * digits * self.wave_number(section).sqrt();
        4 * (count / 4.0).ceil().max(3.0) as usize
    }

    /// The largest wave number `x` that the blow excites, 1 / L.
    fn wave_number(&self, section: &Section) -> f64 {
        let Section {
            length,
            bending_stiffness,
            mass_per_length,
            tip_mass,
            ..
        } = *section;
        let rate = (bending_stiffness / mass_per_length).sqrt() / (length * length);
        let stiffness = self.contact_stiffness * length.powi(3) / bending_stiffness;
        let mass = tip_mass / (mass_per_length * length);
        let (beam, contact) = (self.stiffness_damping * rate, self.contact_damping * rate);
        let wave = |s: f64| (s * s / (1.0 + beam * s)).sqrt().sqrt();
        let stiffer = |s: f64| stiffness * (1.0 + contact * s) > (1.0 + beam * s) * wave(s).powi(3) + mass * s * s;
        // Both sides are smooth in the logarithm of s, of which a thousandth is plenty.
        let (mut low, mut high) = (-10.0_f64, 60.0_f64);
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            if stiffer(middle.exp()) {
                low = middle;
            } else {
                high = middle;
            }
        }
        wave(low.exp())
    }
}
