//! What the modes left out do.
//!
//! The modes are found in a space of functions of ever finer bends, orthonormal in strain energy. The coefficients of a motion
//! fall exponentially once it is resolved, and the last ones show what the next would be (J. P. Boyd, Chebyshev and Fourier
//! Spectral Methods, 2001, chapter 2). Let `c` be these of the motion and `c_1(s)` those under a unit force at the contact, as
//! functions of time and of the complex rate `s`. By reciprocity the contact lacks the displacement `c_1 c`. A contact of
//! stiffness `K = k (1 + beta_c s)`, on a spring of flexibility `H`, makes of it the force
//!
//! ```text
//! K c_1 c / (1 + K H),     H(s) = sum T_i^2 / (s^2 + c_i s + omega_i^2)
//! ```
//!
//! at most: with the largest factor at any frequency, and the largest `c` so far. Where modes are given, but not all of them used,
//! the highest in use stand for the last functions. Each spring has functions of its own; what they lack adds up.
//!
//! The damping `beta` of the spring resists the strain of the missing functions as its stiffness does: `c + beta c'` stands for `c`.
//! What `c` makes counts in the next blow. What `beta c'` makes is over by then: it counts in the ratio of the contact's stiffness to
//! that in a blow.

use nalgebra::Complex;

use crate::beam::mode::{Last, Mode, ModeStates, SPRINGS};
use crate::beam::mode_count::Blow;
use crate::beam::spring::Basis;
use crate::math::free_motion::Roots;
use crate::math::simd::LANES;

/// Decay of a vibration in the time in which its phase passes 1 rad, 1: with less, a resonance would count as what it reaches
/// after more periods than there are between blows.
const DECAY: f64 = 0.05;

/// Error of the contact force over this bound, grown as a deviation does where contacts open and close, 1: in all but 2 of 108 runs of
/// random relays with 8 to 44 modes it is smaller.
const OF_BOUND: f64 = 0.25;

/// Factor on it where the moving spring has no rivet, 1. Such a tip follows a jump of a velocity at once: the coefficients of the motion fall as a power
/// of their number, and the last ones show less of what is missing. Pinned: without it `tests/promise.rs` finds relays above their
/// tolerance in silence.
const BARE: f64 = 4.0;

/// What the modes left out do, of each spring.
#[derive(Clone, Debug, Default)]
pub struct Resolution {
    parts: Vec<Part>,
    /// Whether one mode has to do for a spring: a closed contact holds it, and nothing is seen of what is missing.
    is_blind: bool,
}

/// Coefficients of the last functions of the space of a spring, and what they mean for the contact force.
#[derive(Clone, Debug)]
struct Part {
    /// Coefficients of each mode, sqrt(J) per displacement.
    rows: Vec<Last>,
    /// Time in which the velocity of a mode counts as a displacement, per stiffness of the contact, s m/N.
    damping: f64,
    /// Contact force that is missing per coefficient, N / sqrt(J).
    force: f64,
}

impl Resolution {
    /// Of modes in a blow, with the damping beta of each spring, s.
    pub fn new(basis: &Basis, blow: &Blow, dampings: [f64; SPRINGS]) -> Self {
        let part = |(spring, damping): (usize, f64)| {
            let rows: Vec<_> = basis.last.iter().filter_map(|last| last.get(spring).copied()).collect();
            let bare = if blow.bare { BARE } else { 1.0 };
            let force = bare * OF_BOUND * greatest_force(&basis.modes, &rows, blow);
            (force > 0.0).then(|| Part { rows, damping: damping / blow.contact_stiffness, force })
        };
        let parts: Vec<_> = dampings.into_iter().enumerate().filter_map(part).collect();
        Self { is_blind: basis.modes.len() == 1 && !parts.is_empty(), parts }
    }

    /// Of motions in which each mode has these displacements.
    pub fn of_motions<'a>(&self, motions: &(impl Iterator<Item = impl Iterator<Item = &'a f64>> + Clone)) -> Self {
        let part = |part: &Part| {
            let row = |displacements| part.coefficients(Iterator::copied(displacements));
            let rows = motions.clone().map(row).collect();
            Part { rows, ..*part }
        };
        Self { parts: self.parts.iter().map(part).collect(), ..*self }
    }

    /// Error of the contact force in this motion of the modes, where the contact has this stiffness (N/m), N; the greatest number if it
    /// is not known.
    #[inline(always)]
    pub fn error_of(&self, modes: &ModeStates, stiffness: f64) -> f64 {
        let of = |part: &Part| {
            let damping = part.damping * stiffness;
            part.error(modes.iter().map(|mode| mode.q + damping * mode.v))
        };
        self.known(self.parts.iter().map(of).sum())
    }

    /// Error of the contact force in a motion with these displacements, N.
    #[inline(always)]
    pub fn error(&self, displacements: &(impl Iterator<Item = f64> + Clone)) -> f64 {
        self.known(self.parts.iter().map(|part| part.error(displacements.clone())).sum())
    }

    fn known(&self, error: f64) -> f64 {
        if self.is_blind { f64::MAX } else { error }
    }
}

impl Part {
    #[inline(always)]
    fn error(&self, displacements: impl Iterator<Item = f64>) -> f64 {
        let last = self.coefficients(displacements);
        self.force * last.iter().map(|last| last * last).sum::<f64>().sqrt()
    }

    #[inline(always)]
    fn coefficients(&self, displacements: impl Iterator<Item = f64>) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        for (row, displacement) in self.rows.iter().zip(displacements) {
            for (sum, entry) in sums.iter_mut().zip(row) {
                *sum += entry * displacement;
            }
        }
        sums
    }
}

/// The largest factor, at the rates of the modes and between them. That of an overdamped mode is its fast root: a jump of a velocity is
/// answered as fast, which a contact with a damper feels.
fn greatest_force(modes: &[Mode], rows: &[Last], blow: &Blow) -> f64 {
    let rates = modes.iter().map(|mode| {
        let Roots { fast: [fast], .. } = Roots::of([mode.omega_squared], [mode.damping]);
        fast
    });
    let between = rates.clone().zip(rates.clone().skip(1)).map(|(a, b)| (a * b).sqrt());
    let factor = |omega: f64| {
        let s = Complex::new(DECAY * omega, omega);
        let mut flexibility = Complex::new(0.0, 0.0);
        let mut last = [flexibility; LANES];
        for (mode, row) in modes.iter().zip(rows) {
            let moved = Complex::from(mode.tip) / (s * (s + mode.damping) + mode.omega_squared);
            flexibility += moved * mode.tip;
            for (sum, entry) in last.iter_mut().zip(row) {
                *sum += moved * *entry;
            }
        }
        let stiffness = (s * blow.contact_damping + 1.0) * blow.contact_stiffness;
        let last = last.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        (stiffness / (stiffness * flexibility + 1.0)).norm() * last
    };
    rates.chain(between).map(factor).fold(0.0, f64::max)
}
