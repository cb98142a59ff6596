//! The first part of a step that has been computed: the exact motion of the modes under the polynomials of the whole step.
//! A step ends at an event inside it without new coefficients and without another solution for the nodal forces.

use crate::beam::mode::{Modal, ModeState, ModeStates, lanes};
use crate::excitation::drive::Drive;
use crate::force_error::Deviation;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::{Loads, Shapes};
use crate::integrator::collocation::side_by_side::Loaded;
use crate::integrator::collocation::trial::{AxialLoads, LinkEnd, Trial};
use crate::link::{MAX_LINKS, MAX_PORTS};
use crate::math::nodal::{Nodal, add, dot, end, scaled};
use crate::math::prediction::value_at;
use crate::math::simd::{Arithmetic, LANES, Separate, compiled_for};
use crate::model::Model;
use crate::state::State;

/// Base acceleration, forces at ports, and an axial force on each of the modes side by side.
const MOST_LOADS: usize = 1 + MAX_PORTS + LANES;

/// Modes that move over a step.
struct Moving<'a, const S: usize> {
    starts: &'a [ModeState],
    /// Forces of the links.
    forces: [Nodal<S>; MAX_LINKS],
    /// Base accelerations, m/s2.
    accelerations: Nodal<S>,
    /// Loads of an axial force on each mode; none, if empty.
    axial: &'a [Nodal<S>],
}

/// A link at an instant inside a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Instant {
    /// From the start of the step, s.
    pub(crate) at: f64,
    /// Approach as deviation from the preload, m.
    pub(crate) d: f64,
    /// Its velocity, m/s.
    pub(crate) rate: f64,
}

/// A trial that may end inside.
#[derive(Clone, Copy)]
pub(crate) struct Whole<'a, const S: usize> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a State,
    pub(crate) drive: &'a Drive,
    pub(crate) collocation: &'a Collocation<S>,
    pub(crate) trial: &'a Trial<S>,
    /// Loads of an axial force on the modes.
    pub(crate) axial: &'a AxialLoads<S>,
    /// Length of the trial, s.
    pub(crate) length: f64,
}

impl<const S: usize> Whole<'_, S> {
    /// The modes `at` seconds after the start.
    pub(crate) fn modes(&self, at: f64, ends: &mut ModeStates) {
        let Self { state, trial, .. } = *self;
        let forces = trial.links.each_ref().map(|nodes| nodes.forces);
        let (accelerations, axial) = (trial.accelerations, &self.axial.loads);
        self.motion(&Moving { starts: &state.modes, forces, accelerations, axial }, at, ends);
    }

    /// The deviation `at` seconds after the start.
    pub(crate) fn deviation(&self, at: f64, ends: &mut Deviation) {
        let Self { state, trial, .. } = *self;
        let forces = trial.links.each_ref().map(|nodes| nodes.deviation);
        let (starts, axial) = (&state.force_error.deviation, &self.axial.deviation);
        self.motion(&Moving { starts, forces, accelerations: [0.0; S], axial }, at, ends);
    }

    /// Modes `at` seconds after the start.
    fn motion(&self, moving: &Moving<'_, S>, at: f64, ends: &mut [ModeState]) {
        let Self { model, state, .. } = *self;
        let flies = !state.is_closed()
            && model.links.iter().all(|link| link.contact().is_some())
            && model.modes.first().is_some_and(|slowest| slowest.omega_squared > 0.0);
        match (model.ports.len(), moving.axial.is_empty()) {
            (1, true) => compiled_for!(model.simd, A => self.compute::<2, A>(moving, at, flies, ends)),
            _ => compiled_for!(model.simd, A => self.compute::<MOST_LOADS, A>(moving, at, flies, ends)),
        }
    }

    /// Where no force changes, as all contacts fly, it is about the equilibrium under the forces as they are: there are fewer loads then.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "ports of the model, and loads in use")]
    fn compute<const LOADS: usize, A: Arithmetic>(
        &self,
        moving: &Moving<'_, S>,
        at: f64,
        flies: bool,
        ends: &mut [ModeState],
    ) {
        let (model, collocation) = (self.model, self.collocation);
        let shapes = &collocation.shapes;
        let mut rows = [[0.0; S]; S];
        for (row, node) in rows.iter_mut().zip(&collocation.nodes) {
            *row = collocation.lagrange(node * (at / self.length));
        }
        let mut at_ports = [[0.0; S]; MAX_PORTS];
        for (link, forces) in model.links.iter().zip(&moving.forces) {
            add::<S, A>(&mut at_ports[link.port], link.sense, forces);
        }
        let (mut loads, mut parts) = (Loads::ZERO, [[0.0; LANES]; LOADS]);
        let part = (shapes, &rows);
        set::<S, LOADS, A>(part, &mut loads, 0, &scaled(&moving.accelerations, -1.0));
        let mut count = 1;
        if !flies {
            for forces in at_ports.iter().take(model.ports.len()) {
                set::<S, LOADS, A>(part, &mut loads, count, forces);
                count += 1;
            }
        }
        let of_ports = count;
        if !moving.axial.is_empty() {
            for i in 0..LANES {
                parts[count + i][i] = 1.0;
            }
            count += LANES;
        }
        let starts = moving.starts.as_chunks::<LANES>().0.iter();
        let ends = ends.as_chunks_mut::<LANES>().0.iter_mut();
        for (group, (roots, (starts, ends))) in model.roots.iter().zip(starts.zip(ends)).enumerate() {
            let of_group = |values: &Modal| *lanes(values, group);
            parts[0] = of_group(&model.participations);
            let (mut starts, mut leans) = (*starts, [0.0; LANES]);
            if flies {
                for (port, forces) in model.ports.iter().zip(&at_ports) {
                    add::<LANES, A>(&mut leans, forces[0], &of_group(&port.shape));
                }
                for ((lean, omega_squared), at) in leans.iter_mut().zip(&roots.omega_squared).zip(&mut starts) {
                    *lean /= omega_squared;
                    at.q -= *lean;
                }
            } else {
                for (parts, port) in parts[1..].iter_mut().zip(&model.ports) {
                    *parts = of_group(&port.shape);
                }
            }
            if !moving.axial.is_empty() {
                let own = moving.axial.chunks(LANES).nth(group).unwrap_or_default();
                for i in 0..LANES {
                    set::<S, LOADS, A>(part, &mut loads, of_ports + i, own.get(i).unwrap_or(&[0.0; S]));
                }
            }
            Loaded { shapes, length: at, loads: &loads, parts: &parts, count }.moved::<A>(roots, &starts, ends);
            for (end, lean) in ends.iter_mut().zip(&leans) {
                end.q += lean;
            }
        }
    }

    /// A link `at` seconds after the start, where the modes are these.
    pub(crate) fn link(&self, index: usize, at: f64, modes: &ModeStates) -> Instant {
        let (model, state) = (self.model, self.state);
        let Some((link, port)) = model.links.get(index).and_then(|link| Some((link, model.ports.get(link.port)?)))
        else {
            return Instant::default();
        };
        let speed = link.offset(&self.drive.velocities);
        let (y, rate) = compiled_for!(model.simd, A => port.motion::<A>(modes));
        Instant {
            at,
            d: link.offset(&state.displacements) + speed * at - link.sense * y,
            rate: speed - link.sense * rate,
        }
    }
}

/// Sets one of the loads to that of nodal values up to an instant, at which the Lagrange polynomials take the nodes to `rows`. Not a
/// closure, which may not be inlined and would then be compiled for the generic processor.
#[inline(always)]
fn set<const S: usize, const LOADS: usize, A: Arithmetic>(
    (shapes, rows): (&Shapes<S>, &[Nodal<S>; S]),
    loads: &mut Loads<LOADS>,
    n: usize,
    values: &Nodal<S>,
) {
    let mut nodal = [0.0; S];
    for (value, row) in nodal.iter_mut().zip(rows) {
        *value = dot::<S, A>(row, values);
    }
    shapes.set::<LOADS, A>(loads, n, &nodal);
}

/// Shortens a trial from `state` to a `part` of it, which ends with these links and modes.
pub(crate) fn shorten<const S: usize>(
    (model, state): (&Model, &State),
    collocation: &Collocation<S>,
    (trial, axial): (&mut Trial<S>, &mut [Nodal<S>]),
    part: f64,
    (ends, modes, deviation): (&[Instant; MAX_LINKS], &ModeStates, &Deviation),
) {
    let nodes = collocation.nodes.map(|node| node * part);
    let rows = nodes.map(|x| collocation.lagrange(x));
    let nodal = |values: &Nodal<S>| rows.map(|row| dot::<S, Separate>(&row, values));
    let with_start = |start: f64, values: &Nodal<S>| {
        let polynomial = collocation.through(model.simd, start, values);
        nodes.map(|x| value_at(&polynomial, x - 1.0))
    };
    let links = model.links.iter().zip(&state.links).zip(&mut trial.links);
    for (((link, start), nodes), Instant { d, rate, .. }) in links.zip(ends) {
        // Near the start the polynomial without it is the worse, the shorter the part.
        nodes.forces = if start.closed && !state.touches_now() {
            with_start(start.force - link.force, &nodes.forces)
        } else {
            nodal(&nodes.forces)
        };
        nodes.deviation = nodal(&nodes.deviation);
        nodes.approaches = with_start(start.approach, &nodes.approaches);
        nodes.rates = with_start(start.rate, &nodes.rates);
        nodes.end = LinkEnd {
            force: match link.contact().filter(|_| start.closed) {
                Some(law) => law.closed_branch(link.approach + d, *rate).force - link.force,
                None => end(&nodes.forces),
            },
            approach: *d,
            rate: *rate,
        };
    }
    trial.accelerations = nodal(&trial.accelerations);
    if model.axial.is_some() {
        for load in axial.iter_mut() {
            *load = nodal(load);
        }
    }
    if let Some((rubbing, _)) = model.friction() {
        let start = state.links.get(rubbing).map_or(0.0, |along| -along.approach - state.slip.way - trial.slip.fading);
        trial.slip.deflections = with_start(start, &trial.slip.deflections);
        trial.slip.rates = nodal(&trial.slip.rates);
        let start = state.force_error.tangential(model.port_of(rubbing)) - trial.slip_deviation.fading;
        trial.slip_deviation.deflections = with_start(start, &trial.slip_deviation.deflections);
    }
    trial.modes = *modes;
    trial.deviation = *deviation;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::mode::MAX_MODES;
    use crate::integrator::collocation::cache::{Cache, OF_LONG};
    use crate::integrator::collocation::polynomial::LONG_BY_TIME;
    use crate::integrator::collocation::step::compute;
    use crate::integrator::collocation::trial::{Scratch, Source};
    use crate::math::nodal::LONG;
    use crate::scene::Scene;
    use crate::variables::{AxialForceKind, ExcitationKind};

    /// At its end a look sees what the coefficients of the step make of it, in flight and closed, at any damping and length, with one
    /// contact and with two, and under an axial force on modes that do not fill their last group.
    #[test]
    #[expect(clippy::indexing_slicing, reason = "a spring has modes")]
    fn a_look_at_the_end_is_the_end_of_the_step() {
        for (lifted, second, modes) in
            [(0.0, false, 0), (5e-6, false, 0), (5e-6, true, 0), (0.0, false, 6), (5e-6, false, 6)]
        {
            for damping in [0.0, 0.01, 0.3, 3.0] {
                let mut scene = Scene::default();
                scene.effects.second_contact = second;
                scene.second.gap = 5e-3;
                if modes > 0 {
                    scene.effects.axial_force = AxialForceKind::FromDeflection;
                    scene.solver.modes = modes;
                }
                scene.beam.stiffness_damping *= damping;
                scene.effects.excitation = ExcitationKind::Sine;
                scene.excitation.amplitude = 300.0;
                let model = Model::new(&scene, 0.0).unwrap();
                let mut state = model.initial_state(0.0);
                for (k, at) in state.modes.iter_mut().take(model.modes.len()).enumerate() {
                    at.v += 1e-8 * (1.0 + k as f64).sin();
                }
                state.modes[0].q += lifted / model.modes[0].tip;
                model.settle(&mut state);
                assert_eq!(state.is_closed(), lifted == 0.0);
                let mut cache = Cache::new(&model, &OF_LONG, &LONG_BY_TIME);
                let mut scratch = Scratch::<LONG>::new(&model);
                let mut steps = 0;
                for length in [1e-9, 1e-7, 3e-6, 5e-5, 2e-4] {
                    let mut trial: Box<Trial<LONG>> = bytemuck::zeroed_box();
                    let prepared = cache.prepare(state.time, length, true, &model);
                    let drive = Drive::default();
                    let source = Source::Laws(1e-12);
                    if compute(&model, &state, &drive, prepared, source, &mut trial, &mut scratch).is_none() {
                        continue;
                    }
                    steps += 1;
                    let whole = Whole {
                        model: &model,
                        state: &state,
                        drive: &drive,
                        collocation: prepared.collocation,
                        trial: &trial,
                        axial: &scratch.axial,
                        length,
                    };
                    let mut looked = [ModeState::default(); MAX_MODES];
                    whole.modes(length, &mut looked);
                    assert_eq!(looked[model.modes.len()..], state.modes[model.modes.len()..]);
                    for (mode, (seen, end)) in model.modes.iter().zip(looked.iter().zip(&trial.modes)) {
                        let omega = mode.omega_squared.sqrt();
                        // With what it leans under the preload, and what the acceleration gives it.
                        let leans = (model.preload.force * mode.tip / omega).abs();
                        let size = (omega * end.q).abs().max(end.v.abs()) + leans + length * mode.participation.abs();
                        let wrong = (omega * (seen.q - end.q)).abs().max((seen.v - end.v).abs());
                        // Cancellation of power series and derivatives, as in the test of the responses.
                        assert!(
                            wrong <= 1e-11 * size,
                            "{lifted} m, {second}, {modes}, {damping}, {length} s, {omega} 1/s: {seen:?}, not {end:?}"
                        );
                    }
                }
                // Some long steps in contact have no solution.
                assert!(steps >= 3, "{steps} steps");
            }
        }
    }
}
