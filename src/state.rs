//! The state: all numbers that change during a simulation, of fixed size, so that saving it is a copy.

use std::mem::swap;

use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

use crate::beam::mode::ModeStates;
use crate::chatter::Interruptions;
use crate::force_error::ForceError;
use crate::friction::Tangential;
use crate::math::prediction::Prediction;

/// The state at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time, s.
    pub time: f64,
    /// The modes of the cantilever.
    #[serde(with = "BigArray")]
    pub modes: ModeStates,
    /// Whether all that follows is as the second contact sees it: [`State::mirror`].
    pub mirrored: bool,
    /// Whether, after exact steps, [`State::modes`] are instead those of beam and linear contact together
    /// ([`crate::closed_loop`]).
    pub with_contact: bool,
    /// Displacement of the fixed contact since the preload, m.
    pub support: f64,
    /// Its velocity over the last communication step, m/s.
    pub support_rate: f64,
    /// Displacement of the second fixed contact relative to the first, m; mirrored or not the same.
    pub second_support: f64,
    /// Indentation minus preload indentation, m.
    pub indentation: f64,
    /// Velocity of the indentation, m/s.
    pub indentation_rate: f64,
    /// Contact force, N.
    pub force: f64,
    /// Friction.
    pub tangential: Tangential,
    /// Whether the contact force is positive.
    pub closed: bool,
    /// Time at which the force last reached zero, s; `None`: not yet.
    pub last_opening: Option<f64>,
    /// Time at which the force last left zero, s; `None`: not yet.
    pub last_closing: Option<f64>,
    /// Time at which the force last left zero or jumped, s: just after it, it varies as a root of time.
    pub last_kink: f64,
    /// Longest step with few nodes that the error estimate allows, s.
    pub short_step: f64,
    /// Longest step with many nodes that the error estimate allows while the contact is closed, s.
    pub long_step: f64,
    /// Force over the last step as deviation from the preload force, N; that of the next is guessed from it.
    pub course: Prediction,
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
    /// What is kept of the other contact, which is open: the second one, or the first one while mirrored.
    pub other: Record,
    /// What is known of the error of the contact force so far.
    pub force_error: ForceError,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, repeated with a shorter step size.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub iterations: u64,
}

/// What is kept of an open contact while the other one is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// As [`State::last_opening`].
    pub last_opening: Option<f64>,
    /// As [`State::last_closing`].
    pub last_closing: Option<f64>,
    /// As [`State::interruptions`].
    pub interruptions: Interruptions,
}

impl State {
    /// From the view of one contact to that of the other ([`second_contact`](crate::second_contact)), whose fixed contact
    /// moves at `second_rate` (m/s) relative to the first.
    pub(crate) fn mirror(&mut self, second_rate: f64) {
        self.mirrored = !self.mirrored;
        for mode in &mut self.modes {
            (mode.q, mode.v) = (-mode.q, -mode.v);
        }
        self.support = self.second_support - self.support;
        self.support_rate = second_rate - self.support_rate;
        self.indentation = self.second_support - self.indentation;
        self.indentation_rate = second_rate - self.indentation_rate;
        swap(&mut self.last_opening, &mut self.other.last_opening);
        swap(&mut self.last_closing, &mut self.other.last_closing);
        swap(&mut self.interruptions, &mut self.other.interruptions);
    }

    /// What is known of the second contact, or of the first.
    pub(crate) fn record(&self, second: bool) -> Record {
        if second == self.mirrored {
            Record {
                last_opening: self.last_opening,
                last_closing: self.last_closing,
                interruptions: self.interruptions,
            }
        } else {
            self.other
        }
    }

    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            time,
            modes,
            mirrored: _,
            with_contact: _,
            support,
            support_rate,
            second_support,
            indentation,
            indentation_rate,
            force,
            tangential,
            closed: _,
            last_opening,
            last_closing,
            last_kink,
            short_step,
            long_step,
            course,
            last_step,
            flight_step,
            energy_surplus,
            energy_balance,
            interruptions,
            other,
            force_error,
            steps: _,
            rejected_steps: _,
            iterations: _,
        } = self;
        let numbers = [
            time,
            support,
            support_rate,
            second_support,
            indentation,
            indentation_rate,
            force,
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
            && course.iter().all(|number| number.is_finite())
            && interruptions.is_sound(*time)
            && other.interruptions.is_sound(*time)
            && force_error.is_sound()
            && tangential.is_sound()
            && *short_step > 0.0
            && *long_step >= 0.0
            && *flight_step > 0.0
            && [
                last_opening,
                last_closing,
                &other.last_opening,
                &other.last_closing,
                &tangential.last_change,
                &Some(*last_kink),
            ]
            .into_iter()
            .flatten()
            .all(|event| event.is_finite() && event <= time)
    }

    /// Whether the contact has opened or closed.
    pub(crate) fn has_switched(&self) -> bool {
        self.last_opening.is_some() || self.last_closing.is_some()
    }

    /// Whether the last kink of the force is the last closing.
    pub(crate) fn bent_by_closing(&self) -> bool {
        self.last_closing == Some(self.last_kink)
    }
}
