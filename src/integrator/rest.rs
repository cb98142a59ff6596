//! A contact at rest stays at rest until what drives it changes: nothing is integrated meanwhile.

use crate::excitation::drive::Drive;
use crate::model::Model;
use crate::state::State;

/// Change of the contact force, in tolerances, that a contact at rest may still have before it.
const UNREST: f64 = 1e-2;

/// Rounding of a contact force, relative to it.
const ROUNDING: f64 = 1e-14;

/// Change of the stiffness of the modes by an axial force that is small.
const WEAK: f64 = 0.1;

/// The instant (s), `end` at the latest, until which the contact force stays within a hundredth of `tolerance` (N)
/// of what it is, where it does: under a constant base acceleration, and with the fixed contact at rest.
///
/// The potential energy is convex, and each mode has at least its own stiffness: a net load `r` on it is at most
/// `r^2 / (2 omega^2)` above the equilibrium. With the kinetic energy this bounds the energy left, which never
/// grows; and a force that differs by `e` from that of the equilibrium takes at least `e^2 / (2 k)` of it, `k` the
/// greatest stiffness on the way.
///
/// An axial force that follows the deflection adds its loads. It has no potential, but where it changes the stiffness
/// of the modes little and something dissipates, the bound holds but for a factor near one, and the hundredth is
/// there for such. Elsewhere nothing but the equilibrium to rounding is rest.
pub(crate) fn rests_until(model: &Model, state: &State, drive: &Drive, tolerance: f64, end: f64) -> Option<f64> {
    if !drive.is_constant() || model.generator.is_active(state.time) {
        return None;
    }
    let d = model.preload.indentation + state.indentation;
    let force = model.law.force(d, 0.0);
    let change = UNREST * tolerance;
    let mut least = change * change / (2.0 * model.law.tangent_stiffness(force + change));
    let acceleration = drive.acceleration(state.time);
    let mut axial = None;
    if let Some(feedback) = model.axial() {
        let damped = model.law.damping() > 0.0 || model.modes.iter().all(|mode| mode.damping > 0.0);
        if !damped || feedback.strength(&model.modes, &state.modes) > WEAK {
            let rounding = ROUNDING * force.max(model.preload.force);
            least = rounding * rounding / (2.0 * model.law.tangent_stiffness(force));
        }
        axial = Some(feedback.loads(&model.modes, &state.modes));
    }
    let mut axial = axial.iter().flatten();
    let mut energy = 0.0;
    for (mode, at) in model.modes.iter().zip(&state.modes) {
        let load =
            mode.tip * (force - model.preload.force) - mode.participation * acceleration - mode.omega_squared * at.q
                + axial.next().copied().unwrap_or_default();
        let strain = if load == 0.0 {
            0.0
        } else {
            load * load / mode.omega_squared
        };
        energy += 0.5 * (strain + at.v * at.v);
        // The first modes tell of most motions.
        if energy.is_nan() || energy > least {
            return None;
        }
    }
    let start = model.generator.next_break(state.time).unwrap_or(end);
    Some(start.min(end))
}
