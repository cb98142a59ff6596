//! What is kept of each step for those who read: dense output, extremes, interruptions.

use crate::contact::law::Law;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::trial::Trial;
use crate::integrator::course::{Places, turning_points};
use crate::integrator::dense_output::DenseOutput;
use crate::integrator::events::interruption::Passages;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::Target;
use crate::link::LinkLaw;
use crate::math::prediction::value_at;
use crate::model::Model;
use crate::state::State;

/// Who reads.
#[derive(Debug, Default)]
pub(crate) struct Recorder<'a> {
    /// The instant from which on the dense output of a free step is read, s.
    pub(crate) read: Option<f64>,
    pub(crate) dense: Option<&'a mut DenseOutput>,
    /// The state at the start of that step.
    pub(crate) start: Option<&'a mut State>,
    /// Extremes of the contact forces, if requested.
    pub(crate) extremes: Option<&'a mut Extremes>,
}

impl Recorder<'_> {
    /// Whether a step that ends at an instant (s) is read inside.
    pub(crate) fn reads_before(&self, end: f64) -> bool {
        self.read.is_some_and(|read| read < end)
    }

    /// Records the present contact forces in the extremes, and interruptions that begin or end with them.
    pub(crate) fn note_forces(&mut self, model: &Model, state: &mut State) {
        if let Some(extremes) = &mut self.extremes {
            for (index, (link, at)) in model.links.iter().zip(&state.links).enumerate() {
                if link.contact().is_some() {
                    extremes.of(index).add(at.force);
                }
            }
            extremes.add_pair_at(model, |index| state.links.get(index).map_or(0.0, |at| at.force));
        }
        let State { links, circuits, time, .. } = state;
        circuits.note(&model.links, links.iter().map(|link| link.force), *time);
    }

    /// Records an accepted step from `state`, and what its forces do to the next: their courses, interruptions that begin or end
    /// inside it.
    pub(crate) fn note_step<const S: usize>(
        &mut self,
        (model, state): (&Model, &mut State),
        collocation: &Collocation<S>,
        trial: &Trial<S>,
        target: &Target,
        passages: &Passages,
    ) {
        let second = model.roles.second;
        let touches = state.touches_now();
        let read = self.reads_before(target.time) || self.dense.is_some() && second.is_some();
        let mut is_course = true;
        for (index, (link, at)) in model.links.iter().zip(&mut state.links).enumerate() {
            let (Some(nodes), Some(passages)) = (trial.links.get(index), passages.get(index)) else { continue };
            // The mean force of a step of the fallback, which may be mere rounding: extremes are then those of its ends.
            let is_constant = nodes.forces.windows(2).all(|pair| matches!(pair, [a, b] if a == b));
            is_course &= !(is_constant && at.closed);
            // Of an open contact nobody reads the force.
            if at.closed || link.contact().is_none() {
                // Through an instant at which the force all but jumps a polynomial would overshoot; so it would to a constant one.
                let jumps = touches && link.contact().is_some_and(Law::is_steep_at_touch);
                let start = if jumps || is_constant {
                    collocation.interpolate(&nodes.forces, 0.0)
                } else {
                    at.force - link.force
                };
                at.course = collocation.through(model.simd, start, &nodes.forces);
            }
            let turns = if model.scene.effects.extremes && at.closed {
                turning_points(model.simd, &at.course)
            } else {
                Places::default()
            };
            let through = |start: f64, values| collocation.through(model.simd, start, values);
            if let Some(dense) = self.dense.as_mut().and_then(|dense| dense.links.get_mut(index)) {
                (dense.force, dense.turns, dense.passages) = (at.course, turns, *passages);
                if read && !matches!(link.law, LinkLaw::Friction(_)) {
                    dense.approach = through(at.approach, &nodes.approaches);
                    dense.rate = through(at.rate, &nodes.rates);
                }
            }
            if let Some(extremes) = &mut self.extremes {
                if at.closed && !is_constant {
                    extremes.add_course(link, index, (&at.course, &turns), -1.0, 0.0);
                }
                if second == Some(index) {
                    let mut highest = nodes.approaches.iter().copied().fold(at.approach, f64::max);
                    let before = [at.rate].into_iter().chain(nodes.rates);
                    if before.zip(nodes.rates).any(|(before, now)| before > 0.0 && now <= 0.0) {
                        let polynomial = through(at.approach, &nodes.approaches);
                        for y in turning_points(model.simd, &polynomial).iter() {
                            highest = highest.max(value_at(&polynomial, y));
                        }
                    }
                    extremes.approach(link.approach + highest);
                }
            }
        }
        if let Some(extremes) = self.extremes.as_mut().filter(|_| is_course) {
            let course = |index: usize| {
                let at = state.links.get(index).filter(|at| at.closed)?;
                Some((&at.course, turning_points(model.simd, &at.course)))
            };
            extremes.add_pair(model, course, (-1.0, 0.0));
        }
        let passages = passages.each_ref();
        state.circuits.pass(&model.links, &passages, (target.time, target.length), 0.0);
    }
}
