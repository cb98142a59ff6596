//! Motion of the tip at the nodes of a step, across the contact and along the spring, under both forces.

use crate::integrator::collocation::coefficients::{ErrorColumn, StepCoefficients, TangentialCoefficients, TipColumns};
use crate::integrator::collocation::newton::FreeResponse;
use crate::math::nodal::{Nodal, add, add_columns, scaled};
use crate::math::simd::Arithmetic;
use crate::state::State;

/// Motion of the tip at the nodes: indentation and displacement along the spring, with their velocities.
#[derive(Clone, Copy)]
pub(super) struct Motion<const S: usize> {
    pub(super) d: Nodal<S>,
    pub(super) d_rate: Nodal<S>,
    pub(super) v: Nodal<S>,
    pub(super) v_rate: Nodal<S>,
}

/// What acts on the step beside both forces.
pub(super) struct Unforced<'a, const S: usize> {
    pub(super) step: &'a StepCoefficients<S>,
    pub(super) tangential: &'a TangentialCoefficients<S>,
    pub(super) free: FreeResponse<'a, S>,
    pub(super) motion: Motion<S>,
}

/// Motion at the nodes without a change of both forces.
#[inline(always)]
pub(super) fn along<const S: usize, A: Arithmetic>(
    state: &State,
    tangential: &TangentialCoefficients<S>,
    free: &FreeResponse<S>,
) -> Motion<S> {
    let (mut v, mut v_rate) = ([0.0; S], [0.0; S]);
    for (mode, row) in state.modes.iter().zip(&tangential.modes) {
        add::<S, A>(&mut v, mode.q, &row.tip_from_q);
        add::<S, A>(&mut v, mode.v, &row.tip_from_v);
        add::<S, A>(&mut v_rate, mode.q, &row.rate_from_q);
        add::<S, A>(&mut v_rate, mode.v, &row.rate_from_v);
    }
    let pushed = scaled(&free.accelerations, -1.0);
    add_columns::<S, A>(&mut v, &tangential.acceleration.displacement, &pushed);
    add_columns::<S, A>(&mut v_rate, &tangential.acceleration.velocity, &pushed);
    Motion {
        d: free.free,
        d_rate: free.free_rate,
        v,
        v_rate,
    }
}

impl<const S: usize> Unforced<'_, S> {
    /// Motion at the nodes under both forces, as deviations from those of the preload.
    #[inline(always)]
    pub(super) fn under<A: Arithmetic>(&self, forces: &Nodal<S>, loads: &Nodal<S>) -> Motion<S> {
        let Self { step, tangential, .. } = self;
        let mut motion = self.motion;
        let (less, less_loads) = (scaled(forces, -1.0), scaled(loads, -1.0));
        add_columns::<S, A>(&mut motion.d, &step.force.displacement, &less);
        add_columns::<S, A>(&mut motion.d, &tangential.cross.displacement, &less_loads);
        add_columns::<S, A>(&mut motion.d_rate, &step.force.velocity, &less);
        add_columns::<S, A>(&mut motion.d_rate, &tangential.cross.velocity, &less_loads);
        add_columns::<S, A>(&mut motion.v, &tangential.cross.displacement, forces);
        add_columns::<S, A>(&mut motion.v, &tangential.own.displacement, loads);
        add_columns::<S, A>(&mut motion.v_rate, &tangential.cross.velocity, forces);
        add_columns::<S, A>(&mut motion.v_rate, &tangential.own.velocity, loads);
        motion
    }

    /// Motion under unit contact force or friction force at one node.
    #[inline(always)]
    pub(super) fn by_nodes(&self) -> impl Iterator<Item = Motion<S>> {
        let Self { step, tangential, .. } = self;
        let pairs = |columns: &'_ TipColumns<S>| columns.displacement.into_iter().zip(columns.velocity);
        let by_force = pairs(&step.force).zip(pairs(&tangential.cross));
        let by_friction = pairs(&tangential.cross).zip(pairs(&tangential.own));
        by_force.chain(by_friction).map(|((d, d_rate), (v, v_rate))| Motion {
            d: scaled(&d, -1.0),
            d_rate: scaled(&d_rate, -1.0),
            v,
            v_rate,
        })
    }

    /// Motion per unit defect at the start: of contact force, friction force and base acceleration.
    #[inline(always)]
    pub(super) fn by_defects(&self) -> [Motion<S>; 3] {
        let Self {
            step, tangential, free, ..
        } = self;
        let of = |d: &ErrorColumn<S>, v: &ErrorColumn<S>, sign: f64| Motion {
            d: scaled(&d.displacement, -sign),
            d_rate: scaled(&d.velocity, -sign),
            v: scaled(&v.displacement, sign),
            v_rate: scaled(&v.velocity, sign),
        };
        [
            of(&step.force_error, &tangential.cross_error, 1.0),
            of(&tangential.cross_error, &tangential.own_error, 1.0),
            of(free.error, &tangential.acceleration_error, -1.0),
        ]
    }
}
