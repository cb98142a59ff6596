//! A contact at rest needs no integration until its loads change.

use crate::contact::friction::Phase;
use crate::excitation::drive::Drive;
use crate::integrator::constants::{FORCE_ROUNDING, UNREST, WEAK};
use crate::link::{Link, LinkLaw, MAX_LINKS};
use crate::model::Model;
use crate::state::{LinkState, State};

/// The instant (s), at most `end`, until which the contact force stays within a hundredth of the tolerance of its
/// present value; `None` if the contact is not at rest. Requires constant base acceleration and a fixed contact that
/// does not move.
///
/// An energy bound: the potential energy is convex and each mode has at least its own stiffness, so a net load `r` on a
/// mode is worth at most `r^2 / (2 omega^2)` above the equilibrium. Together with the kinetic energy this bounds the
/// energy above the equilibrium, which never grows. A contact force that differs by `e` from that of the equilibrium
/// needs at least
/// `e^2 / (2 k)` of it, with `k` the greatest tangent stiffness in between.
///
/// Friction that sticks is one spring more, whose force at the present velocity is among the loads.
///
/// An axial force that follows the deflection adds its loads. It has no potential; but if it changes the modal
/// stiffness little and there is damping, the bound holds up to a factor near one, for which the hundredth leaves room.
/// Otherwise only the equilibrium to rounding counts as rest.
pub(crate) fn rests_until(model: &Model, state: &State, drive: &Drive, end: f64) -> Option<f64> {
    if state.slip.phase != Phase::Stick
        || state.with_contact
        || !drive.is_constant()
        || model.generator.is_active(state.time)
        || drive.coil != state.coil
    {
        return None;
    }
    // A magnet has no convex potential; against a stop, which is far stiffer, that does not count.
    let drawn = model.links.iter().find(|link| matches!(link.law, LinkLaw::Magnet(_)));
    if let Some(magnet) = drawn {
        let stops = |(link, at): (&Link, &LinkState)| at.closed && link.port == magnet.port;
        if !model.links.iter().zip(&state.links).any(stops) {
            return None;
        }
    }
    let mut forces = [0.0; MAX_LINKS];
    let change = UNREST * model.tolerance.force;
    let (mut least, mut at_equilibrium) = (f64::INFINITY, f64::INFINITY);
    for ((link, at), load) in model.links.iter().zip(&state.links).zip(&mut forces) {
        if let Some(law) = link.contact() {
            let force = link.force_at(at.approach, 0.0);
            *load = link.sense * (force - link.force);
            let worth = |change: f64, stiffness: f64| change * change / (2.0 * stiffness);
            least = least.min(worth(change, law.tangent_stiffness(force + change)));
            let rounding = FORCE_ROUNDING * force.max(link.force);
            at_equilibrium = at_equilibrium.min(worth(rounding, law.tangent_stiffness(force)));
        } else {
            *load = link.sense * (at.force - link.force);
        }
    }
    let acceleration = drive.acceleration(state.time);
    let mut axial = None;
    if let Some(feedback) = model.axial.as_deref() {
        let damped = model.law.damping > 0.0 || model.modes.iter().all(|mode| mode.damping > 0.0);
        if !damped || feedback.strength(&model.modes, &state.modes) > WEAK {
            least = at_equilibrium;
        }
        axial = Some(feedback.loads(&model.modes, &state.modes));
    }
    let mut axial = axial.iter().flatten();
    let mut energy = 0.0;
    for (i, (mode, at)) in model.modes.iter().zip(&state.modes).enumerate() {
        let by_links = model
            .links
            .iter()
            .zip(&forces)
            .fold(0.0, |sum, (link, force)| sum + force * model.displacement(link.port, i));
        let load = by_links - mode.participation * acceleration - mode.omega_squared * at.q
            + axial.next().copied().unwrap_or_default();
        let strain = if load == 0.0 { 0.0 } else { load * load / mode.omega_squared };
        energy += 0.5 * (strain + at.v * at.v);
        // The first modes reveal most motions: return early.
        if energy.is_nan() || energy > least {
            return None;
        }
    }
    let start = model.generator.next_break(state.time).unwrap_or(end);
    Some(start.min(end))
}
