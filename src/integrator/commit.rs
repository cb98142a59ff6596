//! An accepted step as the new state.

use crate::contact::friction::Slip;
use crate::excitation::drive::Drive;
use crate::integrator::collocation::cache::Cache;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::trial::Trial;
use crate::integrator::constants::MANY_STEPS;
use crate::integrator::dense_output::DenseSlip;
use crate::integrator::deviation;
use crate::integrator::grid::Target;
use crate::link::{CONTACT, LinkLaw};
use crate::math::nodal::end;
use crate::model::Model;
use crate::state::{State, copy_first};

/// Moves a state, of which the recorder has taken what it needs, to the end of an accepted step; returns the course of slip over it.
pub(crate) fn commit<const S: usize>(
    model: &Model,
    state: &mut State,
    drive: &Drive,
    cache: &Cache<S>,
    trial: &Trial<S>,
    target: &Target,
) -> Option<DenseSlip> {
    let slip = state.slip;
    deviation::advance(model, state, trial, target.length);
    copy_first(&mut state.modes, &trial.modes, model.modes.len());
    state.time = target.time;
    state.displacements = drive.moved(state.displacements, target.length);
    for ((link, at), nodes) in model.links.iter().zip(&mut state.links).zip(&trial.links) {
        (at.approach, at.rate) = (nodes.end.approach, nodes.end.rate);
        match &link.law {
            LinkLaw::Contact(law) if at.closed => {
                at.force = law.without_pull(link.force + nodes.end.force);
                if link.circuit.is_some() {
                    state.force_error.greatest = state.force_error.greatest.max(at.force);
                }
            }
            LinkLaw::Magnet(magnet) => at.force = magnet.force(link.approach + at.approach, state.coil).0,
            _ => {}
        }
    }
    if state.steps.is_multiple_of(MANY_STEPS.into()) {
        let conducting = model.links.iter().zip(&state.links).filter(|(link, _)| link.circuit.is_some());
        let stiffnesses =
            conducting.filter_map(|(link, at)| Some(link.contact()?.stiffness(link.approach + at.approach)));
        let stiffness = stiffnesses.fold(0.0, f64::max);
        let error = model.resolution.error_of(&state.modes, stiffness);
        state.force_error.note_unresolved(error, model.force_scale);
    }
    state.lengths.last = target.length;
    state.steps += 1;
    state.iterations += trial.iterations;
    follow_slip(model, (slip, state), cache.collocation, trial, target.length)
}

/// Slip at the end of an accepted step of `length` seconds, which began with a `start`: distance and energy; and the courses of slip
/// and energy over the step.
fn follow_slip<const S: usize>(
    model: &Model,
    (start, state): (Slip, &mut State),
    collocation: &Collocation<S>,
    trial: &Trial<S>,
    length: f64,
) -> Option<DenseSlip> {
    let (index, _) = model.friction()?;
    let (link, nodes) = model.links.get(index).zip(trial.links.get(index))?;
    let mut slips = nodes.approaches;
    let damping = model.law.damping;
    let left = collocation.nodes.map(|x| trial.slip.left(x * length, damping));
    for (slip, (deflection, left)) in slips.iter_mut().zip(trial.slip.deflections.iter().zip(&left)) {
        *slip = -*slip - deflection - left;
    }
    let forces = (state.links.get(index)?.force, nodes.forces.map(|force| link.force + force));
    let dissipated = trial.slip.dissipated(collocation, forces, &left, length);
    let dissipated = dissipated.map(|energy| start.dissipated + energy);
    let contact = *state.links.get(CONTACT)?;
    let growing = model.unstable_slip.iter().find(|unstable| unstable.slip == start.phase);
    let growth = growing.map(|unstable| unstable.growth(contact.force));
    state.force_error.note_slip(growth, length);
    let displacement = -state.links.get(index)?.approach;
    if !contact.closed {
        state.slip.way = displacement;
    } else if start.phase.sign().is_some() {
        state.slip.way = displacement - end(&trial.slip.deflections) - end(&left);
        state.slip.distance += (state.slip.way - start.way).abs();
        state.slip.dissipated = start.dissipated.max(end(&dissipated));
    }
    model.set_friction_force(state);
    Some(DenseSlip {
        slip: collocation.through(model.simd, start.way, &slips),
        dissipated: collocation.through(model.simd, start.dissipated, &dissipated),
    })
}
