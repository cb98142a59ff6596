//! What is measured: which integrators on which scenes at which settings.

use std::rc::Rc;

use anyhow::{Result, anyhow};
use relay_contact::model::Model;
use relay_contact::scene::Solver;

use crate::component::Component;
use crate::integrator::{self, Integrator, Setting};
use crate::problem::Problem;
use crate::radau::Reference;
use crate::study::Case;
use crate::{scenes, table};

/// Longest step of the reference, s.
fn reference_step(problem: &Problem, quick: bool) -> f64 {
    if quick { 1e-6 } else { 2e-5 * problem.end }
}

fn reference(problem: &Problem, quick: bool) -> Result<Rc<Reference>> {
    let reference = Reference::new(problem, reference_step(problem, quick));
    Ok(Rc::new(
        reference.map_err(|failure| anyhow!("{}: {failure}", problem.name))?,
    ))
}

/// All integrators on the modes the component chooses at its default tolerance.
///
/// # Errors
/// Where a scene cannot be simulated or its reference fails, as for all here.
pub fn peers(problem: &Problem, quick: bool) -> Result<Vec<Case>> {
    let reference = reference(problem, quick)?;
    let problem = Rc::new(problem.clone());
    let mut cases = Vec::new();
    for integrator in integrator::all() {
        let integrator: Rc<dyn Integrator> = integrator.into();
        for setting in settings(integrator.fixed_step(), quick) {
            cases.push(Case {
                part: table::PEERS,
                problem: Rc::clone(&problem),
                reference: Rc::clone(&reference),
                integrator: Rc::clone(&integrator),
                setting,
            });
        }
    }
    Ok(cases)
}

/// The component against the motion with many modes: as delivered, and split into modes and time steps.
///
/// # Errors
/// See [`peers`].
pub fn own(problem: &Problem, quick: bool) -> Result<Vec<Case>> {
    let many = problem.with_modes(scenes::MANY_MODES)?;
    let reference = reference(&many, quick)?;
    let case = |part, problem: Problem, setting| Case {
        part,
        problem: Rc::new(problem),
        reference: Rc::clone(&reference),
        integrator: Rc::new(Component),
        setting,
    };
    let mut cases = Vec::new();
    for setting in settings(false, quick) {
        let mut chosen = problem.model.scene;
        chosen.solver.modes = 0;
        chosen.solver.tolerance = setting.value();
        let chosen = i32::try_from(Model::new(&chosen, 0.0)?.modes.len())?;
        cases.push(case(table::DELIVERED, problem.with_modes(chosen)?, setting));
        cases.push(case("steps", many.clone(), setting));
    }
    for modes in (2..=16).step_by(if quick { 4 } else { 1 }) {
        let finest = Setting::Tolerance(Solver::TOLERANCE_FLOOR);
        cases.push(case("modes", problem.with_modes(modes)?, finest));
    }
    Ok(cases)
}

fn settings(fixed_step: bool, quick: bool) -> Vec<Setting> {
    match (fixed_step, quick) {
        (true, true) => [1e-5, 1e-6].map(Setting::Step).to_vec(),
        (true, false) => [2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7, 5e-8]
            .map(Setting::Step)
            .to_vec(),
        (false, true) => [1e-3, 1e-6].map(Setting::Tolerance).to_vec(),
        (false, false) => (1..=12)
            .map(|digits| Setting::Tolerance(10_f64.powi(-digits)))
            .collect(),
    }
}
