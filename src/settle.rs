//! What follows from the motion of the modes: the links of a state.

use crate::contact::friction::{Friction, Phase, Slip};
use crate::contact::law::Law;
use crate::link::{CONTACT, LinkLaw};
use crate::math::simd::Separate;
use crate::model::Model;
use crate::state::{LinkState, State};

impl Model {
    /// Sets approaches, forces, and whether contacts are closed, stick or slip, as they follow from the motion of the modes.
    pub fn settle(&self, state: &mut State) {
        for (link, at) in self.links.iter().zip(&mut state.links) {
            let Some(port) = self.ports.get(link.port) else { continue };
            let (y, rate) = port.motion::<Separate>(&state.modes);
            at.approach = link.offset(&state.displacements) - link.sense * y;
            at.rate = link.offset(&state.velocities) - link.sense * rate;
            match &link.law {
                LinkLaw::Contact(_) => {
                    at.force = link.force_at(at.approach, at.rate);
                    at.closed = link.engagement(at.approach, at.rate) > 0.0;
                }
                LinkLaw::Magnet(magnet) => at.force = magnet.force(link.approach + at.approach, state.coil).0,
                LinkLaw::Friction(_) | LinkLaw::Gauge => {}
            }
        }
        self.settle_friction(state);
    }

    /// Friction, the law of the contact that rubs, that contact in a state, and there the link of friction and the slip.
    fn rubbing<'a>(
        &self,
        state: &'a mut State,
    ) -> Option<(&Friction, &Law, LinkState, &'a mut LinkState, &'a mut Slip)> {
        let (index, friction) = self.friction()?;
        let contact = *state.links.get(CONTACT)?;
        let along = state.links.get_mut(index)?;
        Some((friction, &self.law, contact, along, &mut state.slip))
    }

    /// Sets friction force and phase as they follow from the motion: after a jump, a closing, or in another phase than
    /// before.
    pub(crate) fn settle_friction(&self, state: &mut State) {
        let Some((friction, law, contact, along, slip)) = self.rubbing(state) else { return };
        let (displacement, rate) = (-along.approach, -along.rate);
        if !contact.closed {
            (along.force, slip.way, slip.phase) = (0.0, displacement, Phase::Stick);
            return;
        }
        let d = self.preload.indentation + contact.approach;
        let trial = friction.trial(law, d, displacement - slip.way, rate).force;
        let limit = friction.coefficient * contact.force;
        let (slips, against) = if law.damping > 0.0 {
            // Over the tangential stiffness, which is zero as undeformed contacts touch.
            let lag = displacement - slip.way + law.damping * rate;
            let limit = friction.limit_deflection(law, 1.0, d, contact.rate);
            (lag.abs() > limit.abs(), -lag)
        } else if contact.force <= 0.0 {
            // As it closes both are zero: what they begin with decides.
            let rates = law.exponent * friction.ratio * rate.abs();
            (rates > friction.coefficient * contact.rate.abs(), -rate)
        } else {
            (trial.abs() > limit, trial)
        };
        if slips {
            slip.phase = Phase::slip(against);
            along.force = limit.copysign(against);
            if law.damping == 0.0 {
                slip.way = displacement - friction.limit_deflection(law, against.signum(), d, 0.0);
            }
        } else {
            slip.phase = Phase::Stick;
            along.force = trial;
        }
    }

    /// Begins or ends slip. Without a damper the tangential spring is at its limit then, to the last digit. With one it stays as it is:
    /// after a jump of the velocity its limit moves so fast that the rounding of time would deflect it.
    pub(crate) fn change_phase(&self, state: &mut State, phase: Phase) {
        let sign = phase.sign().or(state.slip.phase.sign()).unwrap_or_default();
        if let Some((friction, law, contact, along, slip)) = self.rubbing(state)
            && law.damping == 0.0
        {
            let d = self.preload.indentation + contact.approach;
            slip.way = -along.approach - friction.limit_deflection(law, sign, d, 0.0);
        }
        state.slip.phase = phase;
        self.set_friction_force(state);
        state.last_kink = state.time;
        state.kink_is_closing = false;
        state.slip.last_change = Some(state.time);
    }

    /// Sets the friction force of the phase of a state at its motion.
    pub(crate) fn set_friction_force(&self, state: &mut State) {
        let Some((friction, law, contact, along, slip)) = self.rubbing(state) else { return };
        along.force = match slip.phase.sign() {
            _ if !contact.closed => 0.0,
            Some(sign) => sign * friction.coefficient * contact.force,
            None => {
                let d = self.preload.indentation + contact.approach;
                friction.trial(law, d, -along.approach - slip.way, -along.rate).force
            }
        };
    }
}
