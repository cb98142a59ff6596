//! How accurate a trial is where it is read inside.

use std::iter;

use crate::integrator::collocation::error::of_rounding;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::constants::{FORCE_ROUNDING, FREE_ROUNDING, LOOKED, MOTION_ROUNDING};
use crate::integrator::events::cubic::Cubic;
use crate::integrator::rounding::magnitude;
use crate::link::CONTACT;
use crate::math::nodal::{Nodal, end, greatest};
use crate::math::prediction::{value_and_slope, value_at};

impl<const S: usize> Whole<'_, S> {
    /// Error allowed in what is read inside the trial, N: relative to the forces in it, where they are larger than the force scale. Nothing
    /// follows from what is read.
    pub(crate) fn readable(&self) -> f64 {
        let contacts = self.model.links.iter().zip(&self.state.links).zip(&self.trial.links);
        let contacts = contacts.filter(|((link, at), _)| at.closed && link.circuit.is_some());
        let largest = contacts.fold(0.0_f64, |most, ((link, at), nodes)| {
            most.max(at.force.abs()).max(greatest(&nodes.forces.map(|force| link.force + force)))
        });
        self.model.tolerance.read(largest)
    }

    /// Error of what is read inside the trial, in the error `allowed` there (N): of forces, and in flight of the indentation.
    pub(crate) fn inaccuracy(&self, allowed: f64) -> f64 {
        let flies = !self.state.contact().closed && self.collocation.variable != Variable::Root;
        let misread = if flies { self.misread() / allowed } else { 0.0 };
        // Not `max`, which would hide NaN.
        misread + if self.state.is_closed() { self.inaccuracy_of_forces(allowed) } else { 0.0 }
    }

    /// The same of forces alone, where a link is closed.
    pub(crate) fn inaccuracy_of_forces(&self, allowed: f64) -> f64 {
        let trial = self.trial;
        if self.collocation.variable == Variable::Root {
            // By the root of time the polynomial goes through the force at the start. At its first node it is as steep as the inverse
            // of a root there, beside the mean.
            let steepest = 0.5 / self.collocation.places.first().copied().unwrap_or(1.0);
            let rounding = of_rounding::<S>(self.model, self.state, trial, FREE_ROUNDING * steepest);
            (trial.next_terms - rounding).max(0.0) / allowed
        } else if trial.next_terms > allowed {
            trial.next_terms / allowed
        } else {
            // Next terms only reject: a length chosen by them would be too short by a twentieth.
            trial.start_defect / allowed
        }
    }

    /// The same of a short step, N, where a force turns; not of one that hardly changes, as the fastest vibrations need not be resolved.
    pub(crate) fn inaccuracy_of_turns(&self) -> f64 {
        let Self { model, state, collocation, trial, .. } = *self;
        let links = model.links.iter().zip(&state.links).zip(&trial.links);
        let closed = links.filter(|((_, at), _)| at.closed);
        let swings = closed.map(|((link, at), nodes)| swing(at.force - link.force, &collocation.places, &nodes.forces));
        let error = trial.inner_error.lasting.max(BETWEEN_NODES * trial.next_terms);
        error.min(swings.fold(0.0, f64::max))
    }

    /// What the forces of closed contacts differ from those of their laws where they turn, and halfway between the nodes of a step that
    /// is `read` inside, N, at the motion that also has the velocities at the nodes: polynomials through fewer nodes do not show how a
    /// law bends near zero force, and a fast vibration may be at its zero at all of them, or at the start. Not looked at where next
    /// terms are far below the error `allowed`, unless what drives the motion has just changed.
    pub(crate) fn law_residual(&self, allowed: f64, changed: bool, read: bool) -> f64 {
        let Self { model, state, collocation, trial, length, .. } = *self;
        if !changed && trial.next_terms < LOOKED * allowed || collocation.variable == Variable::Root {
            return 0.0;
        }
        let mut most = 0.0_f64;
        for ((link, at), nodes) in model.links.iter().zip(&state.links).zip(&trial.links) {
            let Some(law) = link.contact().filter(|_| at.closed) else { continue };
            let through = |start: f64, values: &Nodal<S>| collocation.through(model.simd, start, values);
            let force = through(at.force - link.force, &nodes.forces);
            let (approach, rate) = (through(at.approach, &nodes.approaches), through(at.rate, &nodes.rates));
            let (displacement, velocity) = magnitude(model, (link, at), state);
            // Of its slope: so much steeper than it is high a polynomial of degree S may be (Markov).
            let rounding = (2 * S * S) as f64 * MOTION_ROUNDING * displacement / length;
            let rates = || iter::once((0.0, at.rate)).chain(collocation.places.iter().copied().zip(nodes.rates));
            let missed = |(at, rate): (f64, f64)| {
                let rate = rate * length - value_and_slope(&approach, at - 1.0).1;
                Instant { at, d: 0.0, rate }
            };
            let turns = turns(at.force - link.force, &collocation.places, &nodes.forces).map(|(x, _)| x);
            let halfway = rates().zip(rates().skip(1)).map(|((before, _), (after, _))| 0.5 * (before + after));
            for x in turns.chain(halfway.filter(|_| read)) {
                let around = rates().zip(rates().skip(1)).find(|(_, (place, _))| *place >= x);
                let Some((before, after)) = around else { continue };
                let more = Cubic { a: missed(before), b: missed(after) }.at(x);
                let (d, slope) = value_and_slope(&approach, x - 1.0);
                let lawful = |speed: f64| law.closed_branch(link.approach + d + more.d, speed);
                let mut branch = lawful(value_at(&rate, x - 1.0));
                if branch.damping * rounding < LOOKED * allowed {
                    branch = lawful((slope + more.rate) / length);
                }
                let rounded = FREE_ROUNDING * (branch.stiffness * displacement + branch.damping * velocity);
                let residual = (link.force + value_at(&force, x - 1.0) - branch.force).abs();
                most = most.max(BY_THE_MOTION * (residual - rounded));
            }
        }
        most
    }

    /// Error of the indentation between the nodes of the trial as it would be read there, as the force that makes it of the spring, N.
    /// The polynomial through the indentations has slopes at the nodes that differ from the velocities there; between two nodes its
    /// error is the cubic with these slopes.
    fn misread(&self) -> f64 {
        let Self { model, collocation, length, .. } = *self;
        let (Some(start), Some(nodes)) = (self.state.links.get(CONTACT), self.trial.links.get(CONTACT)) else {
            return 0.0;
        };
        let Some(port) = model.port_of(CONTACT) else { return 0.0 };
        let polynomial = collocation.through(model.simd, start.approach, &nodes.approaches);
        let wrong = |x: f64, rate: f64| (rate * length - value_and_slope(&polynomial, x - 1.0).1).abs();
        let mut before = (0.0, wrong(0.0, start.rate));
        let mut most = 0.0_f64;
        for (x, rate) in collocation.nodes.iter().zip(&nodes.rates) {
            let now = (*x, wrong(*x, *rate));
            most = most.max(0.125 * (now.0 - before.0) * (now.1 + before.1));
            before = now;
        }
        if most <= FORCE_ROUNDING * greatest(&nodes.approaches).max(start.approach.abs()) {
            // Rounding of the polynomial, which no shorter step reduces.
            return 0.0;
        }
        most / port.compliance
    }
}

/// Error of a force between nodes over what it differs there from its law, 1: the motion is that of polynomials, too. Observed: 2.
/// Pinned: 1, `relays_that_once_exceeded_the_tolerance_keep_it`.
const BY_THE_MOTION: f64 = 2.0;

/// What the polynomial through the start and the nodes of a short step misses at most between them, in what the one without its last
/// term misses at the start, 1: greatest value of `x prod (1 - x / c_k)`.
const BETWEEN_NODES: f64 = 0.155;

/// How far a force that rises and falls from `start` (N) over the nodes of a step is from where it turns, N; 0 of one that does not.
fn swing<const S: usize>(start: f64, places: &Nodal<S>, forces: &Nodal<S>) -> f64 {
    let end = end(forces);
    turns(start, places, forces).fold(0.0, |most, (_, turn)| most.max((turn - start).abs().min((turn - end).abs())))
}

/// Where such a force turns, 0 to 1, and its value there, N: where a parabola through three neighbours does, which may be beyond all of
/// them.
fn turns<const S: usize>(start: f64, places: &Nodal<S>, forces: &Nodal<S>) -> impl Iterator<Item = (f64, f64)> {
    let points = || iter::once((0.0, start)).chain(places.iter().copied().zip(forces.iter().copied()));
    let triples = points().zip(points().skip(1)).zip(points().skip(2));
    triples.filter_map(|((before, middle), after)| {
        let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
        let (left, right) = (slope(before, middle), slope(middle, after));
        let curvature = (right - left) / (after.0 - before.0);
        let at_start = left - curvature * (middle.0 - before.0);
        let place = -at_start / (2.0 * curvature);
        let is_inside = (0.0..=after.0 - before.0).contains(&place);
        is_inside.then_some((before.0 + place, before.1 + 0.5 * at_start * place))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::polynomial::SHORT_BY_TIME;

    #[test]
    fn the_shape_between_the_nodes_of_short_steps_has_its_greatest_value() {
        let nodes = SHORT_BY_TIME.nodes;
        let shape = |x: f64| x * nodes.iter().map(|node| 1.0 - x / node).product::<f64>();
        let most = (0..1000).map(|k| shape(1e-3 * f64::from(k)).abs()).fold(0.0, f64::max);
        assert!((most / BETWEEN_NODES - 1.0).abs() < 0.01, "{most}");
    }

    /// Between its last two nodes this one lies lower than at any of them.
    #[test]
    fn a_force_turns_between_nodes() {
        let force = |x: f64| (x - 0.93).powi(2);
        let places = &SHORT_BY_TIME.places;
        let depth = swing(force(0.0), places, &places.map(force));
        assert!((depth - force(1.0)).abs() < 1e-15, "{depth}");
        assert_eq!(swing(0.0, places, places), 0.0);
    }
}
