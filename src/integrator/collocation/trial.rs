//! A trial step, computed as the scene asks: with constant axial force, with one that follows the deflection, or with friction.

use crate::excitation::drive::Drive;
use crate::integrator::collocation::coefficients::Prepared;
use crate::integrator::collocation::end::End;
use crate::integrator::collocation::friction;
use crate::integrator::collocation::newton::Source;
use crate::integrator::collocation::step::{self, Trial};
use crate::math::simd::compiled_for;
use crate::model::Model;
use crate::state::State;

/// Computes the prepared step from `state`, contact closed or open as in `state`. `None` if the iteration for contact or
/// axial force does not converge.
pub fn trial<const S: usize>(
    model: &Model,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source<S>,
    end: &mut End<S>,
) -> Option<Trial<S>> {
    match (model.axial(), model.friction()) {
        (None, None) => {
            compiled_for!(model.simd, A => step::compute::<S, A>(model, state, drive, prepared, source, end))
        }
        (Some(axial), _) => compiled_for!(model.simd, A =>
            step::compute_with_axial_force::<S, A>(model, axial, state, drive, prepared, source, end)),
        (None, Some(friction)) => compiled_for!(model.simd, A =>
            friction::compute::<S, A>(model, friction, state, drive, prepared, source, end)),
    }
}
