//! The first part of a step that has been computed: the exact motion of the modes under the polynomials of the whole step.
//! A step ends at an event inside it without new coefficients and without another solution for the nodal forces.

use std::array;

use crate::beam::mode::{MAX_MODES, Mode, ModeState, ModeStates};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::{Load, Shapes};
use crate::integrator::collocation::side_by_side::Loads;
use crate::integrator::collocation::trial::{LinkEnd, Trial};
use crate::link::{MAX_LINKS, MAX_PORTS};
use crate::math::nodal::{Nodal, add, dot, end, scaled};
use crate::math::prediction::value_at;
use crate::math::simd::{Arithmetic, Separate, compiled_for};
use crate::model::Model;
use crate::state::State;

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
    pub(crate) axial: &'a [Nodal<S>],
    /// Length of the trial, s.
    pub(crate) length: f64,
}

impl<const S: usize> Whole<'_, S> {
    /// The modes `at` seconds after the start.
    pub(crate) fn modes(&self, at: f64, ends: &mut ModeStates) {
        compiled_for!(self.model.simd, A => self.compute::<A>(at, ends));
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "ports of the model")]
    fn compute<A: Arithmetic>(&self, at: f64, ends: &mut ModeStates) {
        let Self {
            model,
            state,
            collocation,
            trial,
            ..
        } = *self;
        let shapes = &collocation.shapes;
        let mut rows = [[0.0; S]; S];
        for (row, node) in rows.iter_mut().zip(&collocation.nodes) {
            *row = collocation.lagrange(node * (at / self.length));
        }
        let base = load_on::<S, A>(shapes, &rows, &trial.accelerations);
        let flies = !state.is_closed() && model.links.iter().all(|link| link.contact().is_some());
        if flies && model.modes.first().is_some_and(|slowest| slowest.omega_squared > 0.0) {
            // About the equilibrium under the forces that are missing.
            let (mut starts, mut leans) = (state.modes, [0.0; MAX_MODES]);
            for (link, nodes) in model.links.iter().zip(&trial.links) {
                let force = link.sense * nodes.forces[0];
                for (lean, shape) in leans.iter_mut().zip(&model.ports[link.port].shape) {
                    *lean += force * shape;
                }
            }
            for ((lean, mode), at) in leans.iter_mut().zip(&model.modes).zip(&mut starts) {
                *lean /= mode.omega_squared;
                at.q -= *lean;
            }
            let loads = Loads {
                shapes,
                length: at,
                polynomials: [&base],
            };
            loads.move_all::<A>(&model.modes, |_, mode| [-mode.participation], &starts, ends);
            for (end, lean) in ends.iter_mut().zip(&leans).take(model.modes.len()) {
                end.q += lean;
            }
        } else if let ([link], [port]) = (&*model.links, &*model.ports) {
            let force = load_on::<S, A>(shapes, &rows, &scaled(&trial.links[0].forces, link.sense));
            let loads = Loads {
                shapes,
                length: at,
                polynomials: [&base, &force],
            };
            let factors = |i: usize, mode: &Mode| [-mode.participation, port.shape[i]];
            loads.move_all::<A>(&model.modes, factors, &state.modes, ends);
        } else {
            let mut at_ports = [[0.0; S]; MAX_PORTS];
            for (link, nodes) in model.links.iter().zip(&trial.links) {
                add::<S, A>(&mut at_ports[link.port], link.sense, &nodes.forces);
            }
            let at_ports = at_ports.map(|forces| load_on::<S, A>(shapes, &rows, &forces));
            let polynomials: [&Load; MAX_PORTS + 1] = array::from_fn(|p| if p == 0 { &base } else { &at_ports[p - 1] });
            let loads = Loads {
                shapes,
                length: at,
                polynomials,
            };
            let factors = |i: usize, mode: &Mode| -> [f64; MAX_PORTS + 1] {
                array::from_fn(|p| match p {
                    0 => -mode.participation,
                    _ => model.ports.get(p - 1).map_or(0.0, |port| port.shape[i]),
                })
            };
            loads.move_all::<A>(&model.modes, factors, &state.modes, ends);
        }
        if model.axial().is_some() {
            self.add_axial::<A>(&rows, at, ends);
        }
    }

    /// Adds the motion under an axial force, which loads each mode in its own way.
    #[inline(always)]
    fn add_axial<A: Arithmetic>(&self, rows: &[Nodal<S>; S], at: f64, ends: &mut ModeStates) {
        let shapes = &self.collocation.shapes;
        for ((mode, own), end) in self.model.modes.iter().zip(self.axial).zip(ends.iter_mut()) {
            let loads = Loads {
                shapes,
                length: at,
                polynomials: [&load_on::<S, A>(shapes, rows, own)],
            };
            let mut by_axial = [ModeState::default()];
            loads.moved::<A, 1>(array::from_ref(mode), &[[1.0]], &[ModeState::default()], &mut by_axial);
            let [ModeState { q, v }] = by_axial;
            (end.q, end.v) = (end.q + q, end.v + v);
        }
    }

    /// A link `at` seconds after the start, where the modes are these.
    pub(crate) fn link(&self, index: usize, at: f64, modes: &ModeStates) -> Instant {
        let (model, state) = (self.model, self.state);
        let Some((link, port)) = model
            .links
            .get(index)
            .and_then(|link| Some((link, model.ports.get(link.port)?)))
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

/// The load of these nodal values up to an instant, at which the Lagrange polynomials take the nodes to `rows`. Not a closure,
/// which may not be inlined and would then be compiled for the generic processor.
#[inline(always)]
fn load_on<const S: usize, A: Arithmetic>(shapes: &Shapes<S>, rows: &[Nodal<S>; S], values: &Nodal<S>) -> Load {
    let mut nodal = [0.0; S];
    for (value, row) in nodal.iter_mut().zip(rows) {
        *value = dot::<S, A>(row, values);
    }
    shapes.load::<A>(&nodal)
}

/// Shortens a trial from `state` to a `part` of it, which ends with these links and modes.
pub(crate) fn shorten<const S: usize>(
    (model, state): (&Model, &State),
    collocation: &Collocation<S>,
    (trial, axial): (&mut Trial<S>, &mut [Nodal<S>]),
    part: f64,
    (ends, modes): (&[Instant; MAX_LINKS], &ModeStates),
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
    if model.axial().is_some() {
        for load in axial.iter_mut() {
            *load = nodal(load);
        }
    }
    if let Some((rubbing, _)) = model.friction() {
        let start = state
            .links
            .get(rubbing)
            .map_or(0.0, |along| -along.approach - state.slip.way);
        trial.slip.deflections = with_start(start, &trial.slip.deflections);
        trial.slip.rates = nodal(&trial.slip.rates);
    }
    trial.modes = *modes;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::cache::{Cache, OF_LONG};
    use crate::integrator::collocation::polynomial::LONG_BY_TIME;
    use crate::integrator::collocation::step::compute;
    use crate::integrator::collocation::trial::{Scratch, Source};
    use crate::math::nodal::LONG;
    use crate::scene::Scene;
    use crate::variables::ExcitationKind;

    /// At its end a look sees what the coefficients of the step make of it, in flight and closed, at any damping and length, with one
    /// contact and with two.
    #[test]
    #[expect(clippy::indexing_slicing, reason = "a spring has modes")]
    fn a_look_at_the_end_is_the_end_of_the_step() {
        for (lifted, second) in [(0.0, false), (5e-6, false), (5e-6, true)] {
            for damping in [0.0, 0.01, 0.3, 3.0] {
                let mut scene = Scene::default();
                scene.effects.second_contact = second;
                scene.second.gap = 5e-3;
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
                        axial: &scratch.axial.loads,
                        length,
                    };
                    let mut looked = [ModeState::default(); MAX_MODES];
                    whole.modes(length, &mut looked);
                    for (mode, (seen, end)) in model.modes.iter().zip(looked.iter().zip(&trial.modes)) {
                        let omega = mode.omega_squared.sqrt();
                        // With what it leans under the preload, and what the acceleration gives it.
                        let leans = (model.preload.force * mode.tip / omega).abs();
                        let size = (omega * end.q).abs().max(end.v.abs()) + leans + length * mode.participation.abs();
                        let wrong = (omega * (seen.q - end.q)).abs().max((seen.v - end.v).abs());
                        // Cancellation of power series and derivatives, as in the test of the responses.
                        assert!(
                            wrong <= 1e-11 * size,
                            "{lifted} m, {second}, {damping}, {length} s, {omega} 1/s: {seen:?}, not {end:?}"
                        );
                    }
                }
                // Some long steps in contact have no solution.
                assert!(steps >= 3, "{steps} steps");
            }
        }
    }
}
