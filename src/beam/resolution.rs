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
//! at most: with the largest factor at any frequency, and the largest `c` so far.
//!
//! A pusher loads the spring elsewhere. As its force jumps the contact feels what the missing functions do before any wave can
//! reach it, and the damping `beta` of the spring resists their strain as its stiffness does: `c + beta c'` stands for `c`. What
//! `c` makes counts in the next blow, what `beta c'` makes is over by then: it counts in the ratio of the contact's stiffness to that
//! in a blow. So it is where the other contact is on a spring, too: a blow between two springs is over when the waves have left, and
//! its maximum is made by what leaves last. Else the force of the contact itself jumps first, and what is missing in its course after
//! that is over before it shows.

use nalgebra::{Complex, DVector};

use crate::beam::mode::{Mode, ModeStates};
use crate::beam::mode_count::Blow;
use crate::beam::section::Section;
use crate::beam::spring::Basis;
use crate::math::simd::LANES;

/// Decay of a vibration in the time in which its phase passes 1 rad, 1: with less, a resonance would count as what it reaches
/// after more periods than there are between blows.
const DECAY: f64 = 0.05;

/// Error of the contact force over this bound, 1: of closed relays with 8 to 48 modes, 95 % have a smaller one.
const OF_BOUND: f64 = 0.25;

/// Coefficients of the last functions of the space, and what they mean for the contact force.
#[derive(Clone, Debug, Default)]
pub struct Resolution {
    /// Coefficients of each mode, sqrt(J) per displacement; none where the modes are given.
    rows: Vec<[f64; LANES]>,
    /// Time in which the velocity of a mode counts as a displacement, per stiffness of the contact, s m/N; 0 without jolts.
    damping: f64,
    /// Contact force that is missing per coefficient, N / sqrt(J).
    force: f64,
}

impl Resolution {
    /// Of the modes of a section and their shapes, in a blow; whether it jolts, from a pusher or another spring.
    pub fn new(section: &Section, basis: &Basis, blow: &Blow, jolts: bool) -> Self {
        let root = (8.0 * section.bending_stiffness / section.length.powi(3)).sqrt();
        let last = |shape: &DVector<f64>, k: usize| {
            let place = (shape.len() + k).checked_sub(LANES);
            place
                .and_then(|place| shape.get(place))
                .map_or(0.0, |entry| root * entry)
        };
        let rows: Vec<_> = basis
            .shapes
            .iter()
            .map(|shape| std::array::from_fn(|k| last(shape, k)))
            .collect();
        let force = OF_BOUND * greatest_force(&basis.modes, &rows, blow);
        Self {
            rows,
            damping: if jolts {
                blow.stiffness_damping / blow.contact_stiffness
            } else {
                0.0
            },
            force,
        }
    }

    /// Of motions in which each mode has these displacements.
    pub fn of_motions<'a>(&self, motions: impl Iterator<Item = impl Iterator<Item = &'a f64>>) -> Self {
        let rows = motions
            .map(|displacements| self.coefficients(displacements.copied()))
            .collect();
        Self { rows, ..*self }
    }

    /// Error of the contact force in this motion of the modes, where the contact has this stiffness (N/m), N.
    #[inline(always)]
    pub fn error_of(&self, modes: &ModeStates, stiffness: f64) -> f64 {
        let damping = self.damping * stiffness;
        self.error(modes.iter().map(|mode| mode.q + damping * mode.v))
    }

    /// Error of the contact force in a motion with these displacements, N.
    #[inline(always)]
    pub fn error(&self, displacements: impl Iterator<Item = f64>) -> f64 {
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

/// The largest factor, at the frequencies of the modes and between them.
fn greatest_force(modes: &[Mode], rows: &[[f64; LANES]], blow: &Blow) -> f64 {
    let rates = modes.iter().map(|mode| mode.omega_squared.sqrt());
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
