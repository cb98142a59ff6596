//! The discrete-gradient step, used where the collocation fails: it always has a solution.
//!
//! The contact force is constant over the step: the discrete gradient of the elastic energy `V` between the ends of the
//! step, `(V(d_1) - V(d_0)) / (d_1 - d_0)`, plus a damping force against the displacement between them (O. Gonzalez,
//! J. Nonlinear Sci. 6 (1996) 449). With
//! exact modes the energy is conserved exactly without damping and never grows with damping, for any step length;
//! opening and closing need no event location. The indentation at the end decreases linearly with the constant force
//! and the law's mean force increases with the indentation: one monotone scalar equation, solved by a bracketing
//! method.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::step::compute;
use crate::integrator::collocation::trial::{Source, Trial};
use crate::integrator::events::Event;
use crate::integrator::grid::Target;
use crate::integrator::rounding::motion_rounding;
use crate::integrator::step_length::StepOutcome;
use crate::integrator::stepper::Stepper;
use crate::integrator::workspace::{Room, Rooms, work};
use crate::math::nodal::SHORT;
use crate::math::roots;

/// Rounds over the contacts until each force is that of its law under those of the others. One round is enough for one contact.
const ROUNDS: u32 = 20;

impl Stepper<'_> {
    /// Takes a step with constant forces, which always has a solution.
    pub(super) fn take_with_constant_force(&mut self, target: &Target) -> Result<StepOutcome, StepError> {
        self.with_trial(|stepper, trial| stepper.try_with_constant_force(trial, target))
    }

    fn try_with_constant_force(&mut self, trial: &mut Trial<SHORT>, target: &Target) -> Result<StepOutcome, StepError> {
        self.solve(trial, target).ok_or_else(|| self.error(StepErrorCause::NotFinite))?;
        self.commit(trial, target, true)?;
        let mut switched = false;
        for index in 0..self.model.links.len() {
            switched |= self.switch_after_constant_force(trial, index, target.length);
        }
        self.model.settle_friction(self.state);
        // No polynomial to predict the next step with.
        self.state.lengths.last = 0.0;
        Ok(StepOutcome { accepted: true, switched, growth: 2.0, length: target.length })
    }

    /// Solves for the constant forces of the step to the target; friction keeps the force it has.
    fn solve(&mut self, trial: &mut Trial<SHORT>, target: &Target) -> Option<()> {
        let Self { model, state, workspace, drive, .. } = self;
        let (room, search) = Rooms::<SHORT>::parts(*workspace);
        search.looked = None;
        let Room { cache, scratch, .. } = room;
        let prepared = cache.prepare(state.time, target.length, target.recurring, model);
        let contacts = |index: &usize| model.links.get(*index).is_some_and(|link| link.contact().is_some());
        let contacts = || (0..model.links.len()).filter(contacts);
        for ((nodes, link), at) in trial.links.iter_mut().zip(&model.links).zip(&state.links) {
            nodes.forces = [at.force - link.force; SHORT];
        }
        let mut trials = 0;
        let mut under = |trial: &mut Trial<SHORT>, index: usize, force: f64| {
            trials += 1;
            let (link, nodes) = model.links.get(index).zip(trial.links.get_mut(index))?;
            nodes.forces = [force - link.force; SHORT];
            compute(model, state, drive, prepared, Source::Given, trial, scratch)?;
            // What its law gives between both ends.
            let (nodes, at) = trial.links.get(index).zip(state.links.get(index))?;
            let (moved, mean) = (nodes.end.approach - at.approach, 0.5 * (at.rate + nodes.end.rate));
            let (rounding, _) = motion_rounding(model, (link, at), state);
            // Of a step of femtoseconds a contact with much damping would make a force of that rounding.
            let speed = if (moved - mean * target.length).abs() <= rounding { mean } else { moved / target.length };
            let [from, to] = [at.approach, nodes.end.approach].map(|deviation| link.approach + deviation);
            Some(link.contact()?.mean_force(from, to, speed))
        };
        let rounds = if contacts().count() > 1 { ROUNDS } else { 1 };
        for _ in 0..rounds {
            let mut changed = false;
            for index in contacts() {
                let before = trial.links.get(index)?.forces;
                // Bracket: zero force gives the largest approach and so the largest force of the law.
                let most = Some(under(trial, index, 0.0)?).filter(|most| most.is_finite())?;
                let mut excess = |force: f64| under(trial, index, force).map_or(f64::NAN, |law| force - law);
                let bracket = ((0.0, -most), (most, excess(most)));
                let force = roots::between(excess, bracket.0, bracket.1, 0.0).unwrap_or(most);
                under(trial, index, force)?;
                changed |= trial.links.get(index)?.forces != before;
            }
            if !changed {
                break;
            }
        }
        search.work += trials * work::<SHORT>(model, true);
        Some(())
    }

    /// Opens or closes a contact as it is after a step of `length` seconds with constant forces, and sets its force; whether it
    /// opens or closes.
    fn switch_after_constant_force(&mut self, trial: &Trial<SHORT>, index: usize, length: f64) -> bool {
        let Some((link, nodes)) = self.model.links.get(index).zip(trial.links.get(index)) else { return false };
        let (Some(law), Some(port), end) = (link.contact(), self.model.port_of(index), &nodes.end) else {
            return false;
        };
        let closed = link.engagement(end.approach, end.rate) > 0.0;
        let switched = self.state.links.get(index).is_some_and(|at| at.closed != closed);
        if switched {
            self.happen(Event::Switches(index));
        }
        if closed && let Some(at) = self.state.links.get_mut(index) {
            // The velocity at the end belongs to a constant force: if the contact is nearly a rigid dashpot, the law
            // would overestimate the force.
            let branch = law.closed_branch(link.approach + end.approach, end.rate);
            let rigid = branch.damping * port.mobility * length > 1.0;
            at.force = if rigid { link.force + end.force } else { branch.force };
        }
        switched
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excitation::drive::Drive;
    use crate::integrator::grid::Grid;
    use crate::integrator::recorder::Recorder;
    use crate::integrator::workspace::Workspace;
    use crate::link::CONTACT;
    use crate::model::Model;
    use crate::scene::Scene;
    use crate::state::State;

    /// The specimen with a gap and without beam damping, thrown at the contact.
    fn thrown(contact_damping: f64) -> (Model, State) {
        let mut scene = Scene::default();
        scene.beam.stiffness_damping = 0.0;
        scene.contact.damping = contact_damping;
        scene.contact.overtravel = -1e-5;
        let model = Model::new(&scene, 0.0).unwrap();
        let mut state = model.initial_state(0.0);
        for (at, mode) in state.modes.iter_mut().zip(&model.modes) {
            at.v = -0.1 * mode.participation;
        }
        model.settle(&mut state);
        (model, state)
    }

    /// Takes steps with a constant force alone; energies after each, and how often the contact closed.
    fn energies(model: &Model, state: &mut State, step: f64, count: u32) -> (Vec<f64>, u32) {
        let mut workspace = Workspace::new(model);
        let (mut closings, mut last) = (0, None);
        let energies = (0..count).map(|k| {
            let grid = Grid::over(step * f64::from(k), step);
            let mut stepper = Stepper::new(model, state, &mut workspace, Drive::default(), grid, Recorder::default());
            let target = stepper.grid.target(step, stepper.state.time, None);
            stepper.take_with_constant_force(&target).unwrap();
            let closing = state.links[CONTACT].last_closing;
            closings += u32::from(closing > last);
            last = closing;
            model.energy(state)
        });
        let energies = energies.collect();
        (energies, closings)
    }

    #[test]
    fn energy_is_kept_without_damping_and_never_made_with_it() {
        // The contact lasts some microseconds.
        for step in [1e-8, 1e-6, 1e-5, 1e-4] {
            for damping in [0.0, 1e-7, 8e-5, 1.0] {
                let (model, mut state) = thrown(damping);
                let start = model.energy(&state);
                let (energies, closings) = energies(&model, &mut state, step, 20_000);
                assert!(closings > 0, "{step} s, {damping} s");
                let mut before = start;
                for (k, energy) in energies.into_iter().enumerate() {
                    // Each step rounds displacement and velocity of each mode, sums of two products and a load.
                    let rounding = 4.0 * f64::EPSILON * model.modes.len() as f64 * start;
                    let made = energy - before;
                    assert!(made <= rounding, "{step} s, {damping} s, step {k}: {made:e} J of {start:e} J made");
                    if damping == 0.0 {
                        assert!(made >= -rounding, "{step} s, step {k}: {made:e} J of {start:e} J lost");
                    }
                    before = energy;
                }
                if damping > 0.0 {
                    assert!(before < start, "{step} s, {damping} s");
                }
            }
        }
    }
}
