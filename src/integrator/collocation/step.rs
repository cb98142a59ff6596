//! A trial step: the nodal forces of the links ([`newton`](crate::integrator::collocation::newton)), the motion they cause, and
//! its error ([`error`](crate::integrator::collocation::error)).

use crate::excitation::drive::Drive;
use crate::integrator::collocation::axial_force::Rounds;
use crate::integrator::collocation::cache::Prepared;
use crate::integrator::collocation::coefficients::{NodalMotion, Pairs};
use crate::integrator::collocation::elimination::{Equations, Stacked, in_use};
use crate::integrator::collocation::error::{Judged, estimate_in_flight};
use crate::integrator::collocation::modal_end::{Group, load, load_each, move_freely, pairs, twice};
use crate::integrator::collocation::newton::{FEW, Linked, Solution, Tangent, Unknowns};
use crate::integrator::collocation::slip::{follow, follow_deviation};
use crate::integrator::collocation::trial::{
    AxialLoads, Estimate, FreeResponse, LinkEnd, Scratch, SlipNodes, Source, Trial,
};
use crate::link::{LinkLaw, MAX_PORTS, MAX_UNKNOWNS};
use crate::math::nodal::{Nodal, add, add_products, dot, end, greatest, scaled};
use crate::math::simd::{Arithmetic, LANES, compiled_for};
use crate::model::Model;
use crate::state::State;

/// Computes the prepared step from `state`, contacts closed or open as in `state`. `None` if the iteration for the forces does
/// not converge.
pub fn compute<const S: usize>(
    model: &Model,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source,
    trial: &mut Trial<S>,
    scratch: &mut Scratch<S>,
) -> Option<()> {
    let unknowns = match source {
        Source::Laws(_) => Unknowns::of(model, state),
        Source::Given => Unknowns::default(),
    };
    let step = Step { model, state, drive, prepared, source, unknowns };
    match unknowns.count {
        0 | 1 => compiled_for!(model.simd, A => step.compute::<1, A>(trial, scratch, &mut Equations::new(1))),
        2 => compiled_for!(model.simd, A => step.compute::<2, A>(trial, scratch, &mut Equations::new(2))),
        FEW => compute_few(&step, trial, scratch),
        _ => compute_many(&step, trial, scratch),
    }
}

/// Of a few unknowns, whose equations take room on the stack that others need not have.
#[inline(never)]
fn compute_few<const S: usize>(step: &Step<S>, trial: &mut Trial<S>, scratch: &mut Scratch<S>) -> Option<()> {
    let mut equations = Equations::<S, FEW>::new(FEW);
    compiled_for!(step.model.simd, A => step.compute::<FEW, A>(trial, scratch, &mut equations))
}

/// Of many unknowns, whose equations are on the heap: on the stack they would fill that of a small thread.
#[inline(never)]
fn compute_many<const S: usize>(step: &Step<S>, trial: &mut Trial<S>, scratch: &mut Scratch<S>) -> Option<()> {
    let mut equations = scratch.many.take()?;
    equations.count = step.unknowns.count;
    let done = compiled_for!(step.model.simd, A => step.compute::<MAX_UNKNOWNS, A>(trial, scratch, &mut equations));
    scratch.many = Some(equations);
    done
}

/// What a step is computed from.
struct Step<'a, const S: usize> {
    model: &'a Model,
    state: &'a State,
    drive: &'a Drive,
    prepared: Prepared<'a, S>,
    source: Source,
    unknowns: Unknowns,
}

impl<const S: usize> Step<'_, S> {
    #[inline(always)]
    fn compute<const L: usize, A: Arithmetic>(
        &self,
        trial: &mut Trial<S>,
        scratch: &mut Scratch<S>,
        equations: &mut Equations<S, L>,
    ) -> Option<()> {
        let Self { model, state, .. } = *self;
        let Prepared { step, collocation, .. } = self.prepared;
        let Scratch { free, joined, axial, .. } = scratch;
        self.set_free_response::<A>(trial, free);
        self.guess::<A>(trial);
        let linked = Linked::<S, L>::new::<A>((model, state), step, &self.unknowns, joined);
        let mut rounds = model
            .axial
            .as_deref()
            .map(|feedback| Rounds::new((model, feedback, state), (step, collocation), free, axial));
        loop {
            let settled = match &mut rounds {
                Some(rounds) => rounds.set_free_response::<A>(self.source, trial, free)?,
                None => true,
            };
            if self.unknowns.count > 0 {
                let solution = self.solve::<L, A>(&linked, free, trial, equations)?;
                if settled {
                    self.judge::<L, A>(&linked, free, &solution, trial);
                    self.deviate::<L, A>(&linked, Some(&solution), rounds.as_mut(), trial);
                    break;
                }
            } else if settled {
                self.judge_flight::<A>(free, trial);
                self.deviate::<L, A>(&linked, None, rounds.as_mut(), trial);
                break;
            }
        }
        let loads = rounds.map(Rounds::loads);
        self.set_end::<A>(trial, loads);
        if let Some((rubbing, friction)) = model.friction() {
            follow::<S, A>(model, state, (step, collocation), (rubbing, friction), trial);
        }
        Some(())
    }

    /// Sets estimates and motion of a step of which the forces have been found.
    #[inline(always)]
    fn judge<const L: usize, A: Arithmetic>(
        &self,
        linked: &Linked<S, L>,
        free: &FreeResponse<S>,
        solution: &Solution<'_, S, L>,
        trial: &mut Trial<S>,
    ) {
        let Self { model, state, .. } = *self;
        let Prepared { step, collocation, .. } = self.prepared;
        let judged =
            Judged { linked, step, collocation, free, bent: self.drive.has_just_changed(state.time, step.length) };
        self.set_motion::<A>(&free.ports, &solution.motions, trial);
        judged.estimate::<A>(solution, trial);
        if !state.is_closed() {
            // A magnet alone: what flies is judged as well.
            let (error, inside) = (trial.error, trial.inner_error);
            estimate_in_flight(model, step, free, trial);
            (trial.error, trial.inner_error) = (trial.error.or(error), trial.inner_error.or(inside));
        }
    }

    /// The same of a step in which no force is unknown.
    #[inline(always)]
    fn judge_flight<A: Arithmetic>(&self, free: &FreeResponse<S>, trial: &mut Trial<S>) {
        trial.iterations = 0;
        estimate_in_flight(self.model, self.prepared.step, free, trial);
        if let Source::Given = self.source {
            (trial.error, trial.inner_error) = (Estimate::default(), Estimate::default());
            trial.slip_deviation = SlipNodes::ZERO;
        }
        self.set_motion::<A>(&free.ports, &[], trial);
    }

    /// Motion of the ports under what is known: the state of the modes, the base acceleration, and forces that do not depend on
    /// the motion, which are set.
    #[inline(always)]
    fn set_free_response<A: Arithmetic>(&self, trial: &mut Trial<S>, free: &mut FreeResponse<S>) {
        let Self { model, state, .. } = *self;
        let Prepared { step, collocation, generated } = self.prepared;
        let driven = self.drive.acceleration(state.time);
        let accelerations = &mut trial.accelerations;
        *accelerations = generated.nodes;
        add::<S, A>(accelerations, self.drive.jerk * step.length, &collocation.nodes);
        for acceleration in accelerations.iter_mut() {
            *acceleration += driven;
        }
        let start_defect = driven + generated.start - dot::<S, A>(accelerations, &collocation.at_start);
        let largest = greatest(accelerations).max(f64::MIN_POSITIVE);

        let pushed = scaled(accelerations, -1.0);
        for (p, (port, motion)) in model.ports.iter().zip(&mut free.ports).enumerate() {
            *motion = step.free_motion::<A>(p, port.part(&state.modes));
            motion.respond::<A>(&step.acceleration(p).columns, &pushed);
        }
        self.set_known::<A>(trial, &mut free.ports);
        free.start_defect = start_defect;
        free.missed_mean = collocation.quadrature * start_defect * start_defect / largest;
        free.axial = None;
    }

    /// Sets the forces that the deviation makes, linearised about the motion, and the loads of an axial force that follows it.
    #[inline(always)]
    fn deviate<const L: usize, A: Arithmetic>(
        &self,
        linked: &Linked<S, L>,
        solution: Option<&Solution<'_, S, L>>,
        mut rounds: Option<&mut Rounds<'_, S>>,
        trial: &mut Trial<S>,
    ) {
        if !self.state.force_error.deviates() {
            return;
        }
        let mut left = rounds.as_mut().map_or(0, |rounds| rounds.begin_deviation::<A>());
        loop {
            if let Some(solution) = solution {
                self.set_deviation::<L, A>(linked, solution, rounds.as_deref(), trial);
            }
            match &mut rounds {
                Some(rounds) if left > 0 => rounds.deviate::<A>(trial),
                _ => break,
            }
            left -= 1;
        }
    }

    /// Sets these forces, under the loads as they are.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links and ports of the model, and unknowns in use")]
    fn set_deviation<const L: usize, A: Arithmetic>(
        &self,
        linked: &Linked<S, L>,
        solution: &Solution<'_, S, L>,
        rounds: Option<&Rounds<'_, S>>,
        trial: &mut Trial<S>,
    ) {
        let Self { model, state, .. } = *self;
        let Prepared { step, collocation, .. } = self.prepared;
        let mut own = [NodalMotion::ZERO; L];
        for (own, unknown) in own.iter_mut().zip(self.unknowns.iter()) {
            let link = &model.links[unknown.link];
            let port = &model.ports[link.port];
            let mut motion = step.free_motion::<A>(link.port, port.part(&state.force_error.deviation));
            if let Some(rounds) = rounds {
                rounds.add_deviation::<A>(port, &mut motion);
            }
            own.add::<A>(-link.sense, &motion);
            if let LinkLaw::Friction(_) = link.law {
                // Where it sticks.
                own.d = own.d.map(|d| d + state.force_error.slip);
            }
        }
        let forces = linked.answer::<A>(solution, &own);
        if state.slip.phase.sign().is_some() {
            let contact = linked.under::<A>(&own, &forces)[0];
            follow_deviation::<S, A>(model, state, (step, collocation), &contact, trial);
        }
        for (forces, unknown) in forces.iter().zip(self.unknowns.iter()) {
            trial.links[unknown.link].deviation = *forces;
            if let Some((follower, share)) = unknown.follower {
                trial.links[follower].deviation = scaled(forces, share);
            }
        }
    }

    /// Sets the forces that do not depend on the motion, and adds the motion that they cause.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn set_known<A: Arithmetic>(&self, trial: &mut Trial<S>, ports: &mut [NodalMotion<S>; MAX_PORTS]) {
        for (index, link) in self.model.links.iter().enumerate() {
            let nodes = &mut trial.links[index];
            nodes.deviation = [0.0; S];
            if self.unknowns.iter().any(|unknown| unknown.link == index) {
                continue;
            }
            nodes.tangent = Tangent::default();
            let followed = self.unknowns.iter().find_map(|unknown| {
                let (follower, share) = unknown.follower?;
                (follower == index).then(|| share * self.model.links[unknown.link].force)
            });
            match (followed, self.source) {
                // The share of the contact's preload; that of its deviation is unknown.
                (Some(force), _) => nodes.forces = [force - link.force; S],
                // Of an open contact zero, of a magnet that of its gap.
                (None, Source::Laws(_)) => nodes.forces = [self.state.links[index].force - link.force; S],
                (None, Source::Given) => {}
            }
            if nodes.forces != [0.0; S] {
                for (p, motion) in ports.iter_mut().take(self.model.ports.len()).enumerate() {
                    self.respond::<A>(p, (index, 1.0), &nodes.forces, motion);
                }
            }
        }
    }

    /// First guesses of the unknown forces, as they went on in the last step.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn guess<A: Arithmetic>(&self, trial: &mut Trial<S>) {
        let Self { model, state, .. } = *self;
        let Prepared { step, collocation, .. } = self.prepared;
        for unknown in self.unknowns.iter() {
            let (link, at) = (&model.links[unknown.link], &state.links[unknown.link]);
            let bent = link.contact().is_none() && state.slip.last_change == Some(state.time);
            trial.links[unknown.link].forces = if state.lengths.last > 0.0 && !bent {
                collocation.guess::<A>(&at.course, step.length / state.lengths.last)
            } else {
                [at.force - link.force; S]
            };
        }
    }

    /// Solves for the unknown forces from the guesses in the trial.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model, and unknowns in use")]
    fn solve<'e, const L: usize, A: Arithmetic>(
        &self,
        linked: &Linked<S, L>,
        free: &FreeResponse<S>,
        trial: &mut Trial<S>,
        equations: &'e mut Equations<S, L>,
    ) -> Option<Solution<'e, S, L>> {
        let Source::Laws(newton) = self.source else { return None };
        let mut motions = [NodalMotion::ZERO; L];
        let mut forces: Stacked<S, L> = [[0.0; S]; L];
        for a in 0..in_use::<L>(self.unknowns.count) {
            let unknown = self.unknowns.get(a);
            motions[a] = self.approach::<A>(unknown.link, &free.ports[self.model.links[unknown.link].port]);
            forces[a] = trial.links[unknown.link].forces;
        }
        let solution = linked.solve::<A>(&motions, forces, newton, equations)?;
        trial.iterations = solution.iterations;
        for a in 0..in_use::<L>(self.unknowns.count) {
            let unknown = self.unknowns.get(a);
            trial.links[unknown.link].forces = solution.forces[a];
            if let Some((follower, share)) = unknown.follower {
                add::<S, A>(&mut trial.links[follower].forces, share, &solution.forces[a]);
            }
        }
        Some(solution)
    }

    /// Approach of a link from the motion of its port.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn approach<A: Arithmetic>(&self, index: usize, port: &NodalMotion<S>) -> NodalMotion<S> {
        let Prepared { step, collocation, .. } = self.prepared;
        let link = &self.model.links[index];
        let speed = link.offset(&self.drive.velocities);
        let mut motion = NodalMotion { d: [link.offset(&self.state.displacements); S], rate: [speed; S] };
        add::<S, A>(&mut motion.d, speed * step.length, &collocation.nodes);
        add::<S, A>(&mut motion.d, -link.sense, &port.d);
        add::<S, A>(&mut motion.rate, -link.sense, &port.rate);
        motion
    }

    /// Sets the approaches of all links at the nodes, from the motion of the ports without the forces that were unknown, and
    /// that of the links whose forces were.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links and ports of the model, and unknowns in use")]
    fn set_motion<A: Arithmetic>(
        &self,
        free: &[NodalMotion<S>; MAX_PORTS],
        motions: &[NodalMotion<S>],
        trial: &mut Trial<S>,
    ) {
        for (index, link) in self.model.links.iter().enumerate() {
            let unknown = self.unknowns.iter().position(|unknown| unknown.link == index);
            let NodalMotion { d, rate } = if let Some(a) = unknown {
                motions[a]
            } else {
                let mut motion = free[link.port];
                for unknown in self.unknowns.iter() {
                    let forces = trial.links[unknown.link].forces;
                    self.respond::<A>(link.port, (unknown.link, 1.0), &forces, &mut motion);
                    if let Some(follower) = unknown.follower {
                        self.respond::<A>(link.port, follower, &forces, &mut motion);
                    }
                }
                self.approach::<A>(index, &motion)
            };
            let nodes = &mut trial.links[index];
            (nodes.approaches, nodes.rates) = (d, rate);
        }
    }

    /// Adds the motion of a port under a share of forces, that acts at a link.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn respond<A: Arithmetic>(
        &self,
        port: usize,
        (index, share): (usize, f64),
        forces: &Nodal<S>,
        motion: &mut NodalMotion<S>,
    ) {
        let link = &self.model.links[index];
        let response = self.prepared.step.response(port, link.port);
        motion.respond::<A>(&response.columns, &scaled(forces, link.sense * share));
    }

    /// Moves the modes to the end of the step, with the loads of an axial force on each where there are such; and sets the links
    /// there.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links and ports of the model")]
    fn set_end<A: Arithmetic>(&self, trial: &mut Trial<S>, on_modes: Option<&AxialLoads<S>>) {
        let Self { model, state, .. } = *self;
        let Prepared { step, .. } = self.prepared;
        let ends = trial.modes.as_chunks_mut().0;
        move_freely::<S, A>(step.end, &state.modes, ends);
        // Load by load, so that its values stay in registers.
        load::<S, A>(step.end, ends, &model.participations, &scaled(&trial.accelerations, -1.0));
        self.load_ports::<A>(trial.links.iter().map(|nodes| &nodes.forces), ends);
        if state.force_error.deviates() {
            let ends = trial.deviation.as_chunks_mut().0;
            move_freely::<S, A>(step.end, &state.force_error.deviation, ends);
            self.load_ports::<A>(trial.links.iter().map(|nodes| &nodes.deviation), ends);
            if let Some(on_modes) = on_modes {
                load_each::<S, A>(step.end, ends, &on_modes.deviation);
            }
        }
        if let Some(on_modes) = on_modes {
            load_each::<S, A>(step.end, ends, &on_modes.loads);
        }
        let mut sums: [Pairs; MAX_PORTS] = [[0.0; 2 * LANES]; MAX_PORTS];
        for (port, sum) in model.ports.iter().zip(&mut sums) {
            for (end, (shape, _)) in ends.iter().zip(port.shape.as_chunks().0.iter().zip(step.end)) {
                add_products::<{ 2 * LANES }, A>(sum, &twice(shape), &pairs(end));
            }
        }
        for (index, link) in model.links.iter().enumerate() {
            let of_modes = sums[link.port].as_chunks().0.iter();
            let (y, rate) = of_modes.fold((0.0, 0.0), |(y, rate), [q, v]| (y + q, rate + v));
            let speed = link.offset(&self.drive.velocities);
            let offset = link.offset(&state.displacements) + speed * step.length;
            let nodes = &mut trial.links[index];
            nodes.end = LinkEnd {
                force: end(&nodes.forces),
                approach: offset - link.sense * y,
                rate: speed - link.sense * rate,
            };
        }
    }

    /// Adds to modes at the end what nodal forces of the links do.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "ports of the model")]
    fn load_ports<'n, A: Arithmetic>(&self, forces: impl Iterator<Item = &'n Nodal<S>>, ends: &mut [Group]) {
        let mut loads = [[0.0; S]; MAX_PORTS];
        for (link, forces) in self.model.links.iter().zip(forces) {
            add::<S, A>(&mut loads[link.port], link.sense, forces);
        }
        for (port, forces) in self.model.ports.iter().zip(&loads) {
            load::<S, A>(self.prepared.step.end, ends, &port.shape, forces);
        }
    }
}
