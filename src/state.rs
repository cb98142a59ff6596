//! The state: all numbers that change during a simulation, of fixed size, so that saving it is a copy.

use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

use crate::beam::mode::ModeStates;
use crate::chatter::Interruptions;
use crate::force_error::ForceError;
use crate::math::prediction::Predictions;

/// The state at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time, s.
    pub time: f64,
    /// The modes of the cantilever.
    #[serde(with = "BigArray")]
    pub modes: ModeStates,
    /// Whether, after exact steps, [`State::modes`] are instead those of beam and linear contact together
    /// ([`crate::closed_loop`]).
    pub with_contact: bool,
    /// Displacement of the fixed contact since the preload, m.
    pub support: f64,
    /// Its velocity over the last communication step, m/s.
    pub support_rate: f64,
    /// Indentation minus preload indentation, m.
    pub indentation: f64,
    /// Velocity of the indentation, m/s.
    pub indentation_rate: f64,
    /// Contact force, N.
    pub force: f64,
    /// Whether the contact force is positive.
    pub closed: bool,
    /// Time at which the force last reached zero, s; -1: not yet.
    pub last_opening: f64,
    /// Time at which the force last left zero, s; -1: not yet.
    pub last_closing: f64,
    /// Time at which the force last left zero or jumped, s: just after it, it varies as a root of time.
    pub last_kink: f64,
    /// Longest step with few nodes that the error estimate allows, s.
    pub short_step: f64,
    /// Longest step with many nodes that the error estimate allows while the contact is closed, s.
    pub long_step: f64,
    /// Force over the last step as deviation from the preload force, N; used to predict that of the next.
    pub predictions: Predictions,
    /// Length of that step, s; 0: none.
    pub last_step: f64,
    /// Longest step in flight that the error estimate allowed in the last one, s.
    pub flight_step: f64,
    /// Energy error of the steps so far that is not yet corrected, J, in scenes without damping.
    pub energy_surplus: f64,
    /// Energy supplied less stored less dissipated since initialisation, J, if requested.
    pub energy_balance: f64,
    /// Interruptions so far.
    pub interruptions: Interruptions,
    /// What is known of the error of the contact force so far.
    pub force_error: ForceError,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, repeated with a shorter step size.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub iterations: u64,
}

impl State {
    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            time,
            modes,
            with_contact: _,
            support,
            support_rate,
            indentation,
            indentation_rate,
            force,
            closed: _,
            last_opening,
            last_closing,
            last_kink,
            short_step,
            long_step,
            predictions,
            last_step,
            flight_step,
            energy_surplus,
            energy_balance,
            interruptions,
            force_error,
            steps: _,
            rejected_steps: _,
            iterations: _,
        } = self;
        let numbers = [
            time,
            support,
            support_rate,
            indentation,
            indentation_rate,
            force,
            last_opening,
            last_closing,
            last_kink,
            short_step,
            long_step,
            last_step,
            flight_step,
            energy_surplus,
            energy_balance,
        ];
        numbers.into_iter().all(|number| number.is_finite())
            && modes.iter().all(|mode| mode.q.is_finite() && mode.v.is_finite())
            && predictions.is_finite()
            && interruptions.is_sound(*time)
            && force_error.is_sound()
            && *short_step > 0.0
            && *long_step >= 0.0
            && *flight_step > 0.0
            && [last_opening, last_closing, last_kink]
                .iter()
                .all(|event| **event <= time.max(-1.0))
    }
}
