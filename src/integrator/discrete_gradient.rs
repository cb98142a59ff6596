//! The discrete-gradient step, used where the collocation fails: it always has a solution.
//!
//! The contact force is constant over the step: the discrete gradient of the elastic energy between the ends of the
//! step, plus a damping force against the displacement between them (O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449). With
//! exact modes the energy is conserved exactly without damping and never grows with damping, for any step length;
//! opening and closing need no event location. The indentation at the end decreases linearly with the constant force
//! and the law's mean force increases with the indentation: one monotone scalar equation, solved by a bracketing
//! method.

use crate::error::{StepError, StepErrorCause};
use crate::integrator::collocation::newton::Source;
use crate::integrator::collocation::step::Trial;
use crate::integrator::collocation::trial::trial;
use crate::integrator::grid::Target;
use crate::integrator::integration::{Integration, StepOutcome};
use crate::integrator::workspace::{Room, work};
use crate::math::nodal::{SHORT, end};
use crate::math::roots;

impl Integration<'_> {
    /// Takes a discrete-gradient step to the target.
    pub(crate) fn take_with_constant_force(&mut self, target: &Target) -> Result<StepOutcome, StepError> {
        let trial = self
            .constant_step(target)
            .ok_or_else(|| self.error(StepErrorCause::NotFinite))?;
        let mean = self.model.preload.force + end(&trial.forces);
        let passages = self.passages(&trial, target.length, true).unwrap_or_default();
        self.take(&trial, target, passages)?;
        let d = self.model.preload.indentation + trial.indentation;
        let closed = self.model.engagement(trial.indentation, trial.rate) > 0.0;
        let switched = closed != self.state.closed;
        if switched {
            self.switch(closed);
        }
        if closed {
            // The velocity at the end belongs to a constant force: if the contact is nearly a rigid dashpot, the law
            // would overestimate the force.
            let law = self.model.law.closed_branch(d, trial.rate);
            let rigid = law.damping * self.model.mobility() * target.length > 1.0;
            self.state.force = if rigid { mean } else { law.force };
        }
        self.model.settle_friction(self.state);
        // No polynomial to predict the next step with.
        self.state.last_step = 0.0;
        Ok(StepOutcome {
            taken: true,
            switched,
            growth: 2.0,
            length: target.length,
        })
    }

    /// Solves for the constant force of the step to the target.
    fn constant_step(&mut self, target: &Target) -> Option<Trial<SHORT>> {
        let Self {
            model,
            state,
            workspace,
            drive,
            ..
        } = self;
        let mut trials = 0;
        let (cache, end, _) = Room::<SHORT>::parts(*workspace);
        let prepared = cache.prepare(state.time, target.length, target.recurring, model);
        if let Some(friction) = model.friction() {
            // It is constant too.
            end.tangential.forces = [state.tangential.force - friction.preload; SHORT];
        }
        let preload = model.preload;
        let from = preload.indentation + state.indentation;
        let mut under = |force: f64| {
            trials += 1;
            let source = Source::Given([force - preload.force; SHORT]);
            trial(model, state, drive, prepared, source, end)
        };
        let law_force = |trial: &Trial<SHORT>| {
            let speed = (trial.indentation - state.indentation) / target.length;
            model
                .law
                .mean_force(from, preload.indentation + trial.indentation, speed)
        };
        // Bracket: zero force gives the largest indentation and so the largest force of the law.
        let most = Some(law_force(&under(0.0)?)).filter(|most| most.is_finite())?;
        let mut excess = |force: f64| under(force).map_or(f64::NAN, |trial| force - law_force(&trial));
        let bracket = ((0.0, -most), (most, excess(most)));
        let force = roots::between(excess, bracket.0, bracket.1, 0.0).unwrap_or(most);
        let trial = under(force);
        workspace.work += trials * work::<SHORT>(model, true);
        trial
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excitation::drive::Drive;
    use crate::integrator::grid::Grid;
    use crate::integrator::workspace::{Budget, Workspace};
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
            state.indentation_rate -= mode.tip * at.v;
        }
        (model, state)
    }

    /// Takes steps with a constant force alone; energies after each, and how often the contact closed.
    fn energies(model: &Model, state: &mut State, step: f64, count: u32) -> (Vec<f64>, u32) {
        let mut workspace = Workspace::new(model);
        let (mut closings, mut last) = (0, None);
        let energies = (0..count).map(|k| {
            let mut integration = Integration {
                model,
                other: None,
                state,
                budget: Budget::new(&workspace),
                workspace: &mut workspace,
                drive: Drive::default(),
                grid: Grid::over(step * f64::from(k), step),
                dense: None,
                extremes: None,
                tolerance: 1e-6,
                allowed: 1e-8,
                refusals: 0,
                before_event: false,
                changes: 0,
                driven: false,
                conserves: false,
            };
            let target = integration.grid.target(step, integration.state.time, None);
            integration.take_with_constant_force(&target).unwrap();
            closings += u32::from(state.last_closing > last);
            last = state.last_closing;
            model.energy(&state.modes, state.indentation)
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
                let start = model.energy(&state.modes, state.indentation);
                let (energies, closings) = energies(&model, &mut state, step, 20_000);
                assert!(closings > 0, "{step} s, {damping} s");
                let mut before = start;
                for (k, energy) in energies.into_iter().enumerate() {
                    // Each step rounds displacement and velocity of each mode, sums of two products and a load.
                    let rounding = 4.0 * f64::EPSILON * model.modes.len() as f64 * start;
                    let made = energy - before;
                    assert!(
                        made <= rounding,
                        "{step} s, {damping} s, step {k}: {made:e} J of {start:e} J made"
                    );
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
