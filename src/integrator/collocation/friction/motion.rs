//! Motion of the tip at the nodes of a step, across the contact and along the spring, under both forces.

use crate::friction::Friction;
use crate::integrator::collocation::coefficients::{ErrorColumn, StepCoefficients, TangentialCoefficients};
use crate::integrator::collocation::newton::FreeResponse;
use crate::integrator::collocation::polynomial::Collocation;
use crate::math::nodal::{Nodal, add, add_columns, dot, scaled};
use crate::math::simd::Arithmetic;
use crate::model::Model;
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

/// The nodal forces of a step.
pub(super) struct Solved<const S: usize> {
    /// Contact forces as deviation from the preload, N.
    pub(super) forces: Nodal<S>,
    /// Friction forces as deviation from that of the preload, N.
    pub(super) loads: Nodal<S>,
    pub(super) iterations: u64,
    /// Motion at the nodes under both.
    pub(super) motion: Motion<S>,
    /// Greatest stiffness (N/m) and damping (N s/m) of the contact at the nodes.
    pub(super) hardest: (f64, f64),
    /// See [`Unforced::defects`].
    pub(super) defects: [f64; 3],
    /// What the defects do to the contact forces, and to the friction forces, N.
    pub(super) wrong: Nodal<S>,
    /// See `wrong`.
    pub(super) wrong_loads: Nodal<S>,
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

    /// What the polynomials miss at the start: of contact force, friction force (N) and base acceleration (m/s2).
    #[inline(always)]
    pub(super) fn defects<A: Arithmetic>(
        &self,
        model: &Model,
        friction: &Friction,
        state: &State,
        collocation: &Collocation<S>,
        (forces, loads): (&Nodal<S>, &Nodal<S>),
    ) -> [f64; 3] {
        let missed = |start: f64, values: &Nodal<S>| start - dot::<S, A>(values, &collocation.at_start);
        [
            missed(state.force - model.preload.force, forces),
            missed(state.tangential.force - friction.preload, loads),
            self.free.start_defect,
        ]
    }

    /// Motion at the nodes that these defects make, with forces as they are.
    #[inline(always)]
    pub(super) fn under_defects<A: Arithmetic>(&self, [normal, along, base]: &[f64; 3]) -> Motion<S> {
        let Self {
            step, tangential, free, ..
        } = self;
        let (across, cross, own) = (&step.force_error, &tangential.cross_error, &tangential.own_error);
        let [d, d_rate] = sum::<S, A>([(across, -normal), (cross, -along), (free.error, *base)]);
        let [v, v_rate] = sum::<S, A>([(cross, *normal), (own, *along), (&tangential.acceleration_error, -base)]);
        Motion { d, d_rate, v, v_rate }
    }
}

/// Displacements and velocities, each of these times its factor.
#[inline(always)]
fn sum<const S: usize, A: Arithmetic>(parts: [(&ErrorColumn<S>, f64); 3]) -> [Nodal<S>; 2] {
    let mut sums = [[0.0; S]; 2];
    let [displacement, velocity] = &mut sums;
    for (column, factor) in parts {
        add::<S, A>(displacement, factor, &column.displacement);
        add::<S, A>(velocity, factor, &column.velocity);
    }
    sums
}
