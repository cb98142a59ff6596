//! A deviation of the motion, which shows what errors grow to.
//!
//! In a closed contact errors die out with the vibrations. In one that opens, each closing turns an error of the motion
//! into another blow, and errors may grow from one to the next. So the lowest modes of a deviation are carried along, through the
//! collocation of each step with the laws linearised about its motion. Its direction soon is that which grows most. Its size is that
//! of the errors: each step adds what slow modes feel of its own, each opening and closing what a wrong force or a wrong instant
//! leaves in the motion, which would die out in a contact that stayed closed.
//!
//! In exact steps of a linear contact it rests.

use std::f64::consts::{PI, SQRT_2};

use crate::beam::mode::{Mode, ModeState};
use crate::force_error::{Deviation, ForceError};
use crate::integrator::collocation::trial::Trial;
use crate::integrator::constants::SEEN;
use crate::link::{CONTACT, Link, LinkLaw, Port};
use crate::math::nodal::end;
use crate::model::Model;
use crate::state::State;

/// Part of the energy of a deviation below which it does not show what happens there, 1. Chosen: one in ten of the amplitude.
const HIDDEN: f64 = 1e-2;

/// Force that all errors make over that of a deviation of their size, 1: each grows from where it was made on, and the deviation is not
/// always what grows most. Fitted to 4,000 random relays of all kinds: with 1 one of 60 that are above their tolerance was not told.
/// Pinned: 1, `an_armature_that_touches_nothing_does_not_change_what_is_announced`.
const BESIDE: f64 = 2.0;

/// Twice the energy of modes, J.
fn energy<'a>(modes: impl Iterator<Item = (&'a Mode, &'a ModeState)>) -> f64 {
    modes.map(|(mode, at)| mode.omega_squared * at.q * at.q + at.v * at.v).sum()
}

impl ForceError {
    /// A contact at this port opens or closes, which begins the deviation with a blow, or adds one where its modes have hardly any
    /// part in it: the other bodies' would hide how errors grow there.
    pub(crate) fn begin(&mut self, modes: &[Mode], port: &Port) {
        let of_port = modes.iter().zip(&self.deviation).zip(&port.shape).filter(|(_, shape)| **shape != 0.0);
        if port.mobility == 0.0 || energy(of_port.map(|(mode, _)| mode)) > HIDDEN {
            return;
        }
        let by_impulse = port.mobility.sqrt();
        let mut deviation = self.deviation;
        for (at, shape) in deviation.iter_mut().zip(&port.shape) {
            at.v += shape / by_impulse;
        }
        self.size *= self.set(modes, deviation, self.slip);
    }

    /// As a contact at this port closes its force jumps, by so much per velocity (N s/m): what is ahead feels it earlier.
    pub(crate) fn jump(&mut self, modes: &[Mode], port: &Port, damping: f64) {
        let mut deviation = self.deviation;
        let ahead = port.displacement(&deviation);
        for (at, shape) in deviation.iter_mut().zip(&port.shape) {
            at.v -= shape * damping * ahead;
        }
        self.grow(modes, deviation, self.slip);
    }

    /// As a contact at this port closes friction holds it, where the deviation takes it earlier or later; so far it goes along the spring
    /// per approach, 1.
    pub(crate) fn hold(&mut self, port: &Port, along: f64) {
        let slip = self.slip + along * port.displacement(&self.deviation);
        if slip.is_finite() {
            self.slip = slip;
        }
    }

    /// What the deviation adds to the deflection of the tangential spring of a contact that rubs at this port, m.
    pub(crate) fn tangential(&self, port: Option<&Port>) -> f64 {
        port.map_or(0.0, |port| port.displacement(&self.deviation)) - self.slip
    }

    /// A contact of this stiffness (N/m) and damping time (s) at this port opens or closes: of the energy of the largest error of its
    /// force the motion keeps what modes and contact share as springs in series, and what vibration of the contact has not lost in half a
    /// period; and as much in the velocity.
    pub(crate) fn keep(&mut self, (stiffness, damping): (f64, f64), port: &Port, force_scale: f64) {
        let error = self.largest * force_scale.max(self.greatest);
        let vibrates = (-PI * damping * (stiffness * port.mobility).sqrt()).exp();
        let kept = error * ((1.0 / (1.0 + stiffness * port.compliance) + vibrates) / stiffness).sqrt();
        self.size = (self.size + SQRT_2 * kept).min(f64::MAX);
    }

    /// A step was wrong by an impulse (N s) on a contact at this port; none is known where it is not a number, as in a step with
    /// constant forces after a collocation that has failed.
    fn disturb(&mut self, port: &Port, impulse: f64) {
        self.size += port.mobility.sqrt() * impulse.max(0.0);
    }

    /// The deviation makes a force (N) in a contact that conducts: part of the estimate.
    fn note_deviation(&mut self, force: f64, force_scale: f64) {
        let error = BESIDE * self.size * force / force_scale.max(self.greatest);
        self.by_deviation = self.by_deviation.max(error.min(f64::MAX));
    }

    /// The deviation becomes this: as much as it grows do the errors.
    fn grow(&mut self, modes: &[Mode], deviation: Deviation, slip: f64) {
        let size = self.set(modes, deviation, slip);
        self.size = (self.size * size).min(f64::MAX);
        self.growth += size.ln();
    }

    /// Sets the deviation to this, brought to size 1; returns what its size was, the root of its energy. Nothing changes where that is
    /// no number, as in a step without a solution.
    fn set(&mut self, modes: &[Mode], deviation: Deviation, slip: f64) -> f64 {
        let size = energy(modes.iter().zip(&deviation)).sqrt();
        let inverse = 1.0 / size;
        let slip = slip * inverse;
        if !(size > 0.0 && [size, inverse, slip].into_iter().all(f64::is_finite)) {
            return 1.0;
        }
        self.deviation = deviation.map(|at| ModeState { q: at.q * inverse, v: at.v * inverse });
        self.slip = slip;
        size
    }
}

/// Takes the deviation to the end of an accepted step of `length` seconds, from which the state has not moved.
pub(crate) fn advance<const S: usize>(model: &Model, state: &mut State, trial: &Trial<S>, length: f64) {
    let (closed, phase, error) = (state.contact().closed, state.slip.phase, &mut state.force_error);
    if !error.deviates() {
        return;
    }
    let links = || model.links.iter().zip(&trial.links);
    if let Some(port) = model.port_of(CONTACT) {
        error.disturb(port, trial.slow_error * length);
    }
    if length > SEEN * model.memory {
        let conducting = links().filter(|(link, _)| link.circuit.is_some());
        let most = conducting.fold(0.0_f64, |most, (_, nodes)| most.max(end(&nodes.deviation).abs()));
        error.note_deviation(most, model.force_scale);
    }
    let rubbing = model.friction().and_then(|(rubbing, _)| model.port_of(rubbing));
    let slip = rubbing.map_or(0.0, |port| {
        let (along, spring) = (port.displacement(&trial.deviation), &trial.slip_deviation);
        match phase.sign() {
            _ if !closed => along,
            Some(_) => along - end(&spring.deflections) - spring.left(length, model.law.damping),
            None => error.slip,
        }
    });
    error.grow(&model.modes, trial.deviation, slip);
    // Else part of its energy is in the contact.
    let draws = |link: &Link| matches!(link.law, LinkLaw::Magnet(_));
    let drawn = links().any(|(link, nodes)| draws(link) && nodes.deviation != [0.0; S]);
    if !closed || drawn {
        error.largest_growth = error.largest_growth.max(error.growth);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Once it were not a number, every relay would be announced from then on, and its saved state refused.
    #[test]
    fn a_step_of_unknown_error_leaves_the_estimate_sound() {
        let modes = [Mode { omega_squared: 1.0, tip: 1.0, ..Mode::default() }];
        let port = Port::new(&modes, |mode| mode.tip);
        let mut error = ForceError::default();
        error.begin(&modes, &port);
        for impulse in [f64::NAN, f64::INFINITY] {
            error.disturb(&port, impulse);
            error.grow(&modes, Deviation::default(), 0.0);
            error.note_deviation(0.0, 1.0);
            assert!(error.is_sound(), "{impulse}: {error:?}");
            // Nothing is known of the first, all is lost with the second.
            assert_eq!(error.size > 0.0, impulse.is_infinite());
        }
    }

    /// A mode that lasts, of another body, would hide what grows at a contact once its own have faded.
    #[test]
    fn a_deviation_that_has_faded_at_a_contact_begins_there_anew() {
        let of = |tip, armature| Mode { omega_squared: 1.0, tip, armature, ..Mode::default() };
        let modes = [of(1.0, 0.0), of(0.0, 1.0)];
        let [contact, armature] = [|mode: &Mode| mode.tip, |mode: &Mode| mode.armature].map(|at| Port::new(&modes, at));
        let mut error = ForceError { size: 1.0, ..ForceError::default() };
        let part = |error: &ForceError| energy(modes.iter().zip(&error.deviation).take(1));
        error.begin(&modes, &contact);
        error.begin(&modes, &armature);
        // Each as large as the other, and as all errors together were.
        assert!((part(&error) - 0.5).abs() < 1e-12 && (error.size - 2.0_f64.sqrt()).abs() < 1e-12);
        error.begin(&modes, &contact);
        assert!((part(&error) - 0.5).abs() < 1e-12);
        let mut faded = error.deviation;
        let [at, ..] = &mut faded;
        at.v *= 1e-4;
        error.grow(&modes, faded, 0.0);
        error.begin(&modes, &contact);
        assert!((part(&error) - 0.5).abs() < 1e-3, "{}", part(&error));
    }
}
