//! Estimate of the error of the contact force so far (`solver.forceError`): the state.
//!
//! While no contact has opened or closed, errors die out with the vibrations: it is the largest error that a step has added, times
//! a factor. Then a deviation of the motion is carried along ([`crate::integrator::deviation`]), which tells what force all errors
//! so far make if each has the direction that grows most: that counts, if it is more. What the modes left out do
//! ([`crate::beam::resolution`]) is added, grown as much as the deviation. Where slip is unstable ([`crate::slip_stability`]) all of
//! it grows, at the rate of such a contact force, until the contact sticks, opens or slips back. How often the estimate is too
//! small, and how often it exceeds the tolerance without need, is in docs/accuracy.md.

use serde::{Deserialize, Serialize};

use crate::beam::mode::ModeState;

/// Error of the contact force over the largest estimate of a step, 1. Fitted to 1,800 random relays of all kinds.
const PER_STEP: f64 = 50.0;

/// Modes of the deviation: the lowest ones, which decay least; a multiple of four. Of relay 32690 eight show a sixth of what errors grow
/// to, twelve as much as all.
pub const MODES: usize = 12;

/// A deviation of the motion.
pub type Deviation = [ModeState; MODES];

/// What is known of the error so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceError {
    /// Greatest force so far at the end of a step of a contact that conducts, N.
    pub greatest: f64,
    /// Largest estimate of the error that a step has added, relative to the larger of force scale and greatest force so far.
    pub largest: f64,
    /// The deviation, of size 1; zero until a contact first opens or closes.
    pub deviation: Deviation,
    /// What it adds to [the way slipped](crate::contact::friction::Slip::way), m.
    pub slip: f64,
    /// Logarithm of its size, were it not brought back to 1.
    pub growth: f64,
    /// The largest growth of it in flight.
    pub largest_growth: f64,
    /// Logarithm of what a deviation has grown by in unstable slip, since that began.
    pub by_slip: f64,
    /// The largest of it.
    pub largest_by_slip: f64,
    /// Its size with the errors of all steps, the root of its energy, J^(1/2).
    pub size: f64,
    /// Greatest force that it made so far, relative as `largest`.
    pub by_deviation: f64,
    /// Largest estimate of what modes left out would do ([`crate::beam::resolution`]), likewise.
    pub unresolved: f64,
}

impl ForceError {
    /// Estimate of the error of the contact force so far, relative as the tolerance is; 1 at most: the force is not known at all.
    pub fn relative(&self) -> f64 {
        let by_steps = (PER_STEP * self.largest).max(self.by_deviation);
        let by_all = by_steps + self.unresolved * self.largest_growth.exp();
        (by_all * self.largest_by_slip.exp()).min(1.0)
    }

    /// Over a step of `length` seconds, in which slip grows at this rate (1/s); `None`: it does not slip, or in a direction in
    /// which it is stable.
    pub(crate) fn note_slip(&mut self, growth: Option<f64>, length: f64) {
        self.by_slip = growth.map_or(0.0, |growth| self.by_slip + growth * length);
        self.largest_by_slip = self.largest_by_slip.max(self.by_slip);
    }

    /// A step has added an error (N).
    pub fn add(&mut self, error: f64, force_scale: f64) {
        self.largest = self.largest.max(error / force_scale.max(self.greatest));
    }

    /// Modes left out make an error (N).
    pub fn note_unresolved(&mut self, error: f64, force_scale: f64) {
        self.unresolved = self.unresolved.max((error / force_scale.max(self.greatest)).min(1.0));
    }

    /// Whether there is a deviation, as a contact has opened or closed.
    pub fn deviates(&self) -> bool {
        self.deviation != Deviation::default()
    }

    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            greatest,
            largest,
            deviation,
            slip,
            growth,
            largest_growth,
            by_slip,
            largest_by_slip,
            size,
            by_deviation,
            unresolved,
        } = self;
        let errors = [greatest, largest, largest_growth, by_slip].into_iter();
        let mut errors = errors.chain([largest_by_slip, size, by_deviation, unresolved]);
        let mut others = deviation.iter().flat_map(|at| [at.q, at.v]).chain([*slip, *growth]);
        others.all(f64::is_finite) && errors.all(|error| (0.0..f64::INFINITY).contains(error))
    }
}
