//! A step with an axial force that follows the deflection ([`Feedback`]): loads that couple all modes.
//!
//! The loads are collocation polynomials like the contact force, and weak compared with the modal stiffness. They are
//! found by fixed-point iteration: motion under the current forces, loads of that motion, contact forces under those
//! loads. The defect of the load polynomials at the start of the step enters the error estimate in the same way as that
//! of the base acceleration. If the iteration does not converge, the step is too long.
//!
//! In violent motion the axial force may temporarily exceed the buckling load: the beam then moves away from its
//! position until the sine in the law of the axial force turns to tension. Such motion is integrated like any other, in
//! shorter steps.

use crate::beam::axial::Feedback;
use crate::beam::mode::Modal;
use crate::integrator::collocation::coefficients::{ModeColumns, NodalMotion, StepCoefficients};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::trial::{AxialLoads, FreeResponse, Source, Trial};
use crate::integrator::constants::{FORCE_ROUNDING, ITERATIONS};
use crate::math::nodal::{Nodal, add, add_columns, dot};
use crate::math::simd::{Arithmetic, LANES};
use crate::model::Model;
use crate::state::State;

/// The iteration of forces and loads in a step.
pub(super) struct Rounds<'a, const S: usize> {
    model: &'a Model,
    axial: &'a Feedback,
    state: &'a State,
    step: StepCoefficients<'a, S>,
    collocation: &'a Collocation<S>,
    /// The free response without loads.
    free: FreeResponse<S>,
    /// Loads at the start.
    start: Modal,
    room: &'a mut AxialLoads<S>,
    count: u64,
}

impl<'a, const S: usize> Rounds<'a, S> {
    /// Begins with the loads at the start of the step.
    #[inline(always)]
    pub(super) fn new(
        (model, axial, state): (&'a Model, &'a Feedback, &'a State),
        (step, collocation): (StepCoefficients<'a, S>, &'a Collocation<S>),
        free: &FreeResponse<S>,
        room: &'a mut AxialLoads<S>,
    ) -> Self {
        let start = axial.loads(&model.modes, &state.modes);
        for (loads, start) in room.loads.iter_mut().zip(&start) {
            *loads = [*start; S];
        }
        Self {
            model,
            axial,
            state,
            step,
            collocation,
            free: free.clone(),
            start,
            room,
            count: 0,
        }
    }

    /// Sets the free response to that with the loads of the motion under the forces of a trial; once that changes the loads no more,
    /// with the loads under which the forces were found, and says so. `None` after too many rounds.
    #[inline(always)]
    pub(super) fn set_free_response<A: Arithmetic>(
        &mut self,
        source: Source,
        trial: &Trial<S>,
        free: &mut FreeResponse<S>,
    ) -> Option<bool> {
        let AxialLoads { loads, motion, next } = &mut *self.room;
        set_motion::<S, A>((self.model, self.state), self.step, trial, loads, motion);
        set_loads::<S, A>(self.model, self.axial, motion, next);
        let (change, size) = force_of_change(self.model, loads, next);
        let tolerance = match source {
            Source::Laws(newton) => newton,
            Source::Given => 0.0,
        };
        let settled = self.count > 0 && change <= tolerance + FORCE_ROUNDING * size;
        if !settled {
            self.count += 1;
            loads.copy_from_slice(next);
        }
        free.ports = self.free.ports;
        add_loads::<S, A>(self.model, self.step, loads, free);
        free.axial = Some(self.error::<A>());
        (self.count <= ITERATIONS).then_some(settled)
    }

    /// The loads of the last round.
    pub(super) fn loads(self) -> &'a [Nodal<S>] {
        &self.room.loads
    }

    /// Effect on the approach of the contact of the defects of base acceleration and loads at the start.
    #[inline(always)]
    fn error<A: Arithmetic>(&self) -> NodalMotion<S> {
        let mut error = NodalMotion::ZERO;
        error.add::<A>(self.free.start_defect, &self.step.acceleration(0).defect);
        let modes = self.model.modes.iter().zip(self.step.columns);
        for (((mode, columns), start), load) in modes.zip(&self.start).zip(&self.room.loads) {
            let ModeColumns { load: response, .. } = columns;
            let start_defect = -mode.tip * (start - dot::<S, A>(load, &self.collocation.at_start));
            error.add::<A>(start_defect, &response.defect);
        }
        error
    }
}

/// Computes the modal displacements at the nodes under the forces of a trial, base acceleration and loads.
#[inline(always)]
fn set_motion<const S: usize, A: Arithmetic>(
    (model, state): (&Model, &State),
    step: StepCoefficients<'_, S>,
    trial: &Trial<S>,
    loads: &[Nodal<S>],
    motion: &mut [Nodal<S>],
) {
    let modes = model.modes.iter().zip(&state.modes).zip(step.columns);
    for (i, ((moved, ((mode, at), columns)), load)) in motion.iter_mut().zip(modes).zip(loads).enumerate() {
        let mut load = *load;
        let mut q = [0.0; S];
        for (link, nodes) in model.links.iter().zip(&trial.links) {
            add::<S, A>(&mut load, link.sense * model.displacement(link.port, i), &nodes.forces);
        }
        add::<S, A>(&mut load, -mode.participation, &trial.accelerations);
        add::<S, A>(&mut q, at.q, &columns.q_from_q);
        add::<S, A>(&mut q, at.v, &columns.q_from_v);
        add_columns::<S, A>(&mut q, &columns.load.columns.displacement, &load);
        *moved = q;
    }
}

/// Computes the modal loads of a motion at the nodes.
#[inline(always)]
fn set_loads<const S: usize, A: Arithmetic>(
    model: &Model,
    axial: &Feedback,
    motion: &[Nodal<S>],
    loads: &mut [Nodal<S>],
) {
    let mut tip = [0.0; S];
    for (mode, q) in model.modes.iter().zip(motion) {
        add::<S, A>(&mut tip, mode.tip, q);
    }
    let change = tip.map(|y| axial.change(y));
    // Several independent rows at once.
    let blocks = loads.chunks_mut(LANES).zip(axial.slopes.chunks_exact(LANES));
    for (block, (loads, slopes)) in blocks.enumerate() {
        let mut sums = [[0.0; S]; LANES];
        for (row, q) in axial.geometric.iter().zip(motion) {
            for (sum, entry) in sums
                .iter_mut()
                .zip(row.chunks_exact(LANES).nth(block).unwrap_or_default())
            {
                add::<S, A>(sum, *entry, q);
            }
        }
        for ((load, sum), slope) in loads.iter_mut().zip(&sums).zip(slopes) {
            let (mut values, slope) = (change, *slope);
            for (value, sum) in values.iter_mut().zip(sum) {
                *value *= slope + sum;
            }
            *load = values;
        }
    }
}

/// Static tip force of the same strain energy as the change of the loads, and as the loads, N: the largest over the
/// nodes.
#[inline(always)]
fn force_of_change<const S: usize>(model: &Model, loads: &[Nodal<S>], next: &[Nodal<S>]) -> (f64, f64) {
    let (mut change, mut size, mut unit) = ([0.0; S], [0.0; S], f64::MIN_POSITIVE);
    for ((mode, load), next) in model.modes.iter().zip(loads).zip(next) {
        let compliance = 1.0 / mode.omega_squared;
        unit += mode.tip * mode.tip * compliance;
        for (((change, size), load), next) in change.iter_mut().zip(&mut size).zip(load).zip(next) {
            *change += (next - load) * (next - load) * compliance;
            *size += next * next * compliance;
        }
    }
    // Not `max`, which would hide NaN.
    let root = |values: Nodal<S>| {
        values
            .iter()
            .fold(0.0, |most, value| if most >= *value { most } else { *value })
    };
    ((root(change) / unit).sqrt(), (root(size) / unit).sqrt())
}

/// Adds the effect of the loads to a free response.
#[inline(always)]
fn add_loads<const S: usize, A: Arithmetic>(
    model: &Model,
    step: StepCoefficients<'_, S>,
    loads: &[Nodal<S>],
    free: &mut FreeResponse<S>,
) {
    for (port, motion) in model.ports.iter().zip(&mut free.ports) {
        for ((b, columns), load) in port.shape.iter().zip(step.columns).zip(loads) {
            motion.respond::<A>(&columns.load.columns, &load.map(|load| b * load));
        }
    }
}
