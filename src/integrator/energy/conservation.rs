//! Energy conservation in scenes without damping and without generator.
//!
//! The energy relative to the preload then changes only by the work of the base acceleration, known exactly from the
//! modal displacements, and of the moving fixed contact: its velocity times the impulse of the force, known exactly
//! from the polynomial. Any other change is an error of the step. It is corrected by a small impulse on the tip in this
//! step or in later ones, so that errors do not accumulate over any number of impacts.

use crate::excitation::drive::Drive;
use crate::excitation::generator::Generator;
use crate::integrator::collocation::part::Whole;
use crate::integrator::constants::RETURNED;
use crate::link::{Link, LinkLaw};
use crate::math::simd::Separate;
use crate::model::Model;
use crate::state::State;

/// Whether there is no dissipation and the work of the drive is known exactly.
pub(crate) fn conserves(model: &Model, drive: &Drive) -> bool {
    let undamped = model.modes.iter().all(|mode| mode.damping == 0.0);
    let exerting = model.links.iter().filter(|link| !matches!(link.law, LinkLaw::Gauge));
    let mut laws = exerting.map(Link::contact);
    // An axial force that follows the deflection has no potential, nor has friction.
    undamped
        && model.axial.is_none()
        && laws.all(|law| law.is_some_and(|law| law.damping == 0.0))
        && model.generator == Generator::None
        && drive.jerk == 0.0
}

/// Energy error of a trial (gain beyond the work done), and its rounding, J.
pub(crate) fn surplus<const S: usize>(whole: Whole<S>) -> (f64, f64) {
    let Whole { model, state, drive, collocation, trial, length, .. } = whole;
    let end = |index: usize| trial.links.get(index).map_or(0.0, |nodes| nodes.end.approach);
    let (start, finish) = (model.energy(state), model.energy_at(&trial.modes, state.coil, end));
    let moved = model.modes.iter().zip(state.modes.iter().zip(&trial.modes));
    let loads = moved.map(|(mode, (start, end))| mode.participation * (end.q - start.q));
    let by_base = -drive.acceleration(state.time) * loads.sum::<f64>();
    let (mut by_links, mut size) = (0.0, start.abs().max(finish.abs()));
    for ((link, at), nodes) in model.links.iter().zip(&state.links).zip(&trial.links) {
        let way = link.offset(&drive.velocities) * length;
        by_links += way * collocation.mean(&nodes.forces);
        size += (at.force + link.force.abs()) * ((nodes.end.approach - at.approach).abs() + way.abs());
    }
    // Rounding of displacement and velocity of each mode, sums of two products and a load, and of the forces.
    let rounding = 4.0 * f64::EPSILON * model.modes.len() as f64 * size;
    (finish - start - by_base - by_links, rounding)
}

/// Whether the energy error of a trial exceeds that of a force error of one tolerance along the path of the contacts that are
/// closed.
pub(crate) fn is_broken<const S: usize>(whole: Whole<S>) -> bool {
    let (surplus, rounding) = surplus(whole);
    let Whole { model, state, trial, length, .. } = whole;
    let links = model.links.iter().zip(&state.links).zip(&trial.links);
    let speeds = links.filter(|((_, at), _)| at.closed).map(|((link, at), nodes)| {
        let rate = link.offset(&state.velocities);
        (rate - at.rate).abs().max((rate - nodes.end.rate).abs())
    });
    surplus.abs() > rounding + model.tolerance.force * length * speeds.fold(0.0, f64::max)
}

/// Corrects the accumulated energy error by an impulse on a closed contact, limited to that of a small force error over the
/// step of `length` seconds just taken. The remainder is left to later steps.
pub(crate) fn settle(model: &Model, state: &mut State, length: f64) {
    if state.energy_surplus == 0.0 {
        return;
    }
    let closed = state.links.iter().position(|at| at.closed);
    let Some((link, port)) = closed.and_then(|index| model.links.get(index).zip(model.port_of(index))) else { return };
    let (_, velocity) = port.motion::<Separate>(&state.modes);
    let bound = RETURNED * model.tolerance.force * length;
    let impulse = (-state.energy_surplus / velocity).clamp(-bound, bound);
    if !impulse.is_finite() {
        return;
    }
    for (at, b) in state.modes.iter_mut().zip(&port.shape) {
        at.v += b * impulse;
    }
    let gained = port.mobility * impulse;
    for (other, at) in model.links.iter().zip(&mut state.links) {
        if other.port == link.port {
            at.rate -= other.sense * gained;
        }
    }
    state.energy_surplus += impulse * (velocity + 0.5 * gained);
}
