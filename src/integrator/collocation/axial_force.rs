//! A step with an axial force that follows the deflection ([`Feedback`]): loads that couple all modes.
//!
//! The loads are collocation polynomials like the contact force, and weak compared with the modal stiffness. They are
//! found by fixed-point iteration: motion under the current forces, loads of that motion, contact forces under those
//! loads. The defect of the load polynomials at the start of the step enters the error estimate in the same way as that
//! of the base acceleration. If the iteration does not converge, the step is too long. What a deviation of the motion adds to the
//! loads ([`deviation`](crate::integrator::deviation)) is found in the same way, with the loads linearised about the motion.
//!
//! In violent motion the axial force may temporarily exceed the buckling load: the beam then moves away from its
//! position until the sine in the law of the axial force turns to tension. Such motion is integrated like any other, in
//! shorter steps.

use crate::beam::axial::Feedback;
use crate::beam::mode::{Modal, ModeState};
use crate::integrator::collocation::coefficients::{ModeColumns, NodalMotion, StepCoefficients};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::trial::{AxialLoads, FreeResponse, Source, Trial};
use crate::integrator::constants::{FORCE_ROUNDING, ITERATIONS};
use crate::link::{MAX_LINKS, Port};
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
    /// Axial force above that of the preload at the nodes, N, once the loads have settled.
    change: Nodal<S>,
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
        Self { model, axial, state, step, collocation, free: free.clone(), start, room, count: 0, change: [0.0; S] }
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
        let AxialLoads { loads, motion, next, .. } = &mut *self.room;
        let forces = trial.links.each_ref().map(|nodes| &nodes.forces);
        set_motion::<S, A>(self.model, self.step, &self.state.modes, forces, (&trial.accelerations, loads), motion);
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
        for (port, motion) in self.model.ports.iter().zip(&mut free.ports) {
            add_loads::<S, A>(port, self.step, loads, motion);
        }
        free.axial = Some(self.error::<A>());
        (self.count <= ITERATIONS).then_some(settled)
    }

    /// Begins with a deviation without loads, once those of the motion have settled; returns how many rounds that took: those of the
    /// deviation settle in as many.
    #[inline(always)]
    pub(super) fn begin_deviation<A: Arithmetic>(&mut self) -> u64 {
        let AxialLoads { motion, next, deviation, .. } = &mut *self.room;
        deviation.fill([0.0; S]);
        let tip = tip::<S, A>(self.model, motion);
        self.change = tip.map(|y| self.axial.change(y));
        let per_deflection = tip.map(|y| self.axial.slope(y));
        let blocks = next.chunks_mut(LANES).zip(self.axial.slopes.chunks_exact(LANES));
        for (block, (next, slopes)) in blocks.enumerate().take(deviation.len().div_ceil(LANES)) {
            let coupled = coupled::<S, A>(self.axial, motion, block);
            for ((next, slope), coupled) in next.iter_mut().zip(slopes).zip(&coupled) {
                *next = per_deflection;
                for (next, coupled) in next.iter_mut().zip(coupled) {
                    *next *= slope + coupled;
                }
            }
        }
        self.count
    }

    /// One of these rounds: the loads that the deviation adds, linearised about the motion, under the forces that it makes.
    #[inline(always)]
    pub(super) fn deviate<A: Arithmetic>(&mut self, trial: &Trial<S>) {
        let AxialLoads { motion, next, deviation, .. } = &mut *self.room;
        let motion = motion.get_mut(..deviation.len()).unwrap_or_default();
        let (starts, forces) =
            (&self.state.force_error.deviation, trial.links.each_ref().map(|nodes| &nodes.deviation));
        set_motion::<S, A>(self.model, self.step, starts, forces, (&[0.0; S], deviation), motion);
        let tip = tip::<S, A>(self.model, motion);
        for (block, (loads, next)) in deviation.chunks_mut(LANES).zip(next.chunks(LANES)).enumerate() {
            let coupled = coupled::<S, A>(self.axial, motion, block);
            for ((load, next), coupled) in loads.iter_mut().zip(next).zip(&coupled) {
                let of_nodes = load.iter_mut().zip(tip.iter().zip(next)).zip(self.change.iter().zip(coupled));
                for ((load, (y, per_deflection)), (change, coupled)) in of_nodes {
                    *load = y * per_deflection + change * coupled;
                }
            }
        }
    }

    /// Adds the motion of a port under the loads of the deviation.
    #[inline(always)]
    pub(super) fn add_deviation<A: Arithmetic>(&self, port: &Port, motion: &mut NodalMotion<S>) {
        add_loads::<S, A>(port, self.step, &self.room.deviation, motion);
    }

    /// The loads of the last round.
    pub(super) fn loads(self) -> &'a AxialLoads<S> {
        self.room
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

/// Computes the modal displacements at the nodes from these starts under forces of the links, base acceleration and loads.
#[inline(always)]
fn set_motion<const S: usize, A: Arithmetic>(
    model: &Model,
    step: StepCoefficients<'_, S>,
    starts: &[ModeState],
    forces: [&Nodal<S>; MAX_LINKS],
    (accelerations, loads): (&Nodal<S>, &[Nodal<S>]),
    motion: &mut [Nodal<S>],
) {
    let modes = model.modes.iter().zip(starts).zip(step.columns);
    for (i, ((moved, ((mode, at), columns)), load)) in motion.iter_mut().zip(modes).zip(loads).enumerate() {
        let mut load = *load;
        let mut q = [0.0; S];
        for (link, forces) in model.links.iter().zip(forces) {
            add::<S, A>(&mut load, link.sense * model.displacement(link.port, i), forces);
        }
        add::<S, A>(&mut load, -mode.participation, accelerations);
        add::<S, A>(&mut q, at.q, &columns.q_from_q);
        add::<S, A>(&mut q, at.v, &columns.q_from_v);
        add_columns::<S, A>(&mut q, &columns.load.columns.displacement, &load);
        *moved = q;
    }
}

/// Deflection of the tip in a motion at the nodes, m, as deviation from the preload.
#[inline(always)]
fn tip<const S: usize, A: Arithmetic>(model: &Model, motion: &[Nodal<S>]) -> Nodal<S> {
    let mut tip = [0.0; S];
    for (mode, q) in model.modes.iter().zip(motion) {
        add::<S, A>(&mut tip, mode.tip, q);
    }
    tip
}

/// What the rows of a block of modes make of a motion at the nodes ([`Feedback::geometric`]): several independent rows at once.
#[inline(always)]
fn coupled<const S: usize, A: Arithmetic>(axial: &Feedback, motion: &[Nodal<S>], block: usize) -> [Nodal<S>; LANES] {
    let mut sums = [[0.0; S]; LANES];
    for (row, q) in axial.geometric.iter().zip(motion) {
        for (sum, entry) in sums.iter_mut().zip(row.chunks_exact(LANES).nth(block).unwrap_or_default()) {
            add::<S, A>(sum, *entry, q);
        }
    }
    sums
}

/// Computes the modal loads of a motion at the nodes.
#[inline(always)]
fn set_loads<const S: usize, A: Arithmetic>(
    model: &Model,
    axial: &Feedback,
    motion: &[Nodal<S>],
    loads: &mut [Nodal<S>],
) {
    let change = tip::<S, A>(model, motion).map(|y| axial.change(y));
    let blocks = loads.chunks_mut(LANES).zip(axial.slopes.chunks_exact(LANES));
    for (block, (loads, slopes)) in blocks.enumerate() {
        let coupled = coupled::<S, A>(axial, motion, block);
        for ((load, coupled), slope) in loads.iter_mut().zip(&coupled).zip(slopes) {
            let (mut values, slope) = (change, *slope);
            for (value, coupled) in values.iter_mut().zip(coupled) {
                *value *= slope + coupled;
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
    let root = |values: Nodal<S>| values.iter().fold(0.0, |most, value| if most >= *value { most } else { *value });
    ((root(change) / unit).sqrt(), (root(size) / unit).sqrt())
}

/// Adds the motion of a port under loads on the modes.
#[inline(always)]
fn add_loads<const S: usize, A: Arithmetic>(
    port: &Port,
    step: StepCoefficients<'_, S>,
    loads: &[Nodal<S>],
    motion: &mut NodalMotion<S>,
) {
    for ((b, columns), load) in port.shape.iter().zip(step.columns).zip(loads) {
        motion.respond::<A>(&columns.load.columns, &load.map(|load| b * load));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excitation::drive::Drive;
    use crate::integrator::collocation::cache::{Cache, OF_LONG};
    use crate::integrator::collocation::polynomial::LONG_BY_TIME;
    use crate::integrator::collocation::step::compute;
    use crate::integrator::collocation::trial::Scratch;
    use crate::link::CONTACT;
    use crate::math::nodal::LONG;
    use crate::scene::Scene;
    use crate::state::State;
    use crate::variables::AxialForceKind;

    /// A spring bent by half its length against a soft contact, without damping, pushed at the tip.
    fn pushed() -> (Model, State) {
        let mut scene = Scene::default();
        scene.effects.axial_force = AxialForceKind::FromDeflection;
        scene.contact.overtravel = 8e-3;
        scene.contact.curvature_radius = 1e-4;
        scene.contact.moving.youngs_modulus = 1e8;
        scene.contact.fixed.youngs_modulus = 1e8;
        scene.contact.damping = 0.0;
        scene.beam.stiffness_damping = 0.0;
        scene.solver.modes = 4;
        let model = Model::new(&scene, 0.0).unwrap();
        let mut state = model.initial_state(0.0);
        for (at, mode) in state.modes.iter_mut().zip(&model.modes) {
            at.v = 0.5 * mode.participation;
        }
        model.settle(&mut state);
        (model, state)
    }

    #[test]
    fn energy_changes_by_the_work_of_the_axial_force() {
        for (source, given) in [(Source::Laws(1e-12), 0.0), (Source::Given, 0.3)] {
            let (model, mut state) = pushed();
            let mut cache = Cache::new(&model, &OF_LONG, &LONG_BY_TIME);
            let (mut most, mut wrong) = (0.0_f64, 0.0_f64);
            let start = model.energy(&state);
            let length = 1e-5;
            let collocation = &LONG_BY_TIME;
            let axial = model.axial.as_ref().unwrap();
            let mut scratch = Scratch::<LONG>::new(&model);
            for _ in 0..100 {
                let mut moved = |length| {
                    let mut trial: Box<Trial<LONG>> = bytemuck::zeroed_box();
                    trial.links[CONTACT].forces = [given; LONG];
                    let prepared = cache.prepare(state.time, length, true, &model);
                    let drive = Drive::default();
                    compute(&model, &state, &drive, prepared, source, &mut trial, &mut scratch).unwrap();
                    trial
                };
                // Radau quadrature of the power, from steps to the nodes.
                let powers = collocation.nodes.map(|node| {
                    let modes = moved(node * length).modes;
                    let loads = axial.loads(&model.modes, &modes);
                    loads.iter().zip(&modes).map(|(load, at)| load * at.v).sum()
                });
                let work = length * collocation.mean(&powers);
                let trial = moved(length);
                let mut before = model.energy(&state);
                let from = state.contact().approach;
                state.modes = trial.modes;
                model.settle(&mut state);
                let (after, to) = (model.energy(&state), state.contact().approach);
                if let Source::Given = source {
                    // The given force does the work on the tip in place of the contact.
                    let contact = |d| model.law.energy_above_tangent(model.preload.indentation, d);
                    before += contact(to) - contact(from) - given * (to - from);
                }
                wrong = wrong.max((after - before - work).abs());
                most = most.max(work.abs());
            }
            assert!(most > 1e-3 * start, "{most:e} of {start:e} J");
            // The phase of the fastest mode advances by x = 1.3 rad per step: polynomials of degree 8 have an error of
            // at most x^9 / 9!, some 1e-5, of its motion, and of the order of the square of that in the mean of its
            // work.
            assert!(wrong < 1e-8 * most, "{wrong:e} of {most:e} J");
        }
    }
}
