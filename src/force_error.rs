//! Estimate of the error of the contact force so far (`solver.forceError`): the state.
//!
//! The largest error that a step has added, times a factor, times the growth of a small deviation of the motion since the
//! contact first opened or closed ([`crate::integrator::deviation`]). The factor is the least with which 95 % of random
//! relays have a smaller error (`tests/promise.rs`).

use serde::{Deserialize, Serialize};

use crate::beam::mode::ModeState;

/// Modes of the deviation: the lowest ones, which decay least.
pub const MODES: usize = 8;

/// Error of the contact force over the largest estimate of a step, 1. Fitted to 800 random relays.
const PER_STEP: f64 = 26.0;

/// What is known of the error so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceError {
    /// Largest estimate of the error that a step has added, N.
    pub largest: f64,
    /// The deviation, of size 1; zero until the contact first opens or closes.
    pub deviation: [ModeState; MODES],
    /// Contact force that it causes.
    pub force: f64,
    /// Logarithm of its size, were it not brought back to 1.
    pub growth: f64,
    /// The largest growth of it in flight.
    pub largest_growth: f64,
}

impl ForceError {
    /// Estimate of the error of the contact force so far, relative to the force scale (N); 1 at most: the force is
    /// not known at all.
    pub fn relative(&self, force_scale: f64) -> f64 {
        (PER_STEP * self.largest / force_scale * self.largest_growth.exp()).min(1.0)
    }

    /// A step has added an error (N).
    pub fn add(&mut self, error: f64) {
        self.largest = self.largest.max(error);
    }

    /// Whether there is a deviation, as the contact has opened or closed.
    pub fn deviates(&self) -> bool {
        self.deviation != [ModeState::default(); MODES]
    }

    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            largest,
            deviation,
            force,
            growth,
            largest_growth,
        } = self;
        deviation.iter().all(|mode| mode.q.is_finite() && mode.v.is_finite())
            && force.is_finite()
            && growth.is_finite()
            && (0.0..f64::INFINITY).contains(largest)
            && (0.0..f64::INFINITY).contains(largest_growth)
    }
}
