//! The measurements: which integrators on which scenes at which settings.

use std::rc::Rc;

use anyhow::{Result, anyhow};
use relay_contact::scene::Solver;

use crate::component::Component;
use crate::cvode::Cvode;
use crate::diffsol::Diffsol;
use crate::generalised_alpha::GeneralisedAlpha;
use crate::integrator::{Integrator, Setting};
use crate::problem::Problem;
use crate::radau::Reference;
use crate::study::Case;
use crate::{scenes, table};

/// The integrators compared, the component first.
pub fn integrators() -> [Rc<dyn Integrator>; 6] {
    [
        Rc::new(Component),
        Rc::new(Cvode::new()),
        Rc::new(Diffsol::Bdf),
        Rc::new(Diffsol::Esdirk34),
        Rc::new(GeneralisedAlpha::newmark()),
        Rc::new(GeneralisedAlpha::with_spectral_radius(0.8)),
    ]
}

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

/// All measurements: each scene by all integrators, and by the component alone.
///
/// # Errors
/// If a scene cannot be simulated or its reference fails; the same for all functions here.
pub fn all(quick: bool) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for problem in scenes::all()? {
        cases.extend(peers(&problem, quick)?);
        cases.extend(own(&problem, quick)?);
    }
    Ok(cases)
}

/// All integrators with the number of modes that the component chooses at its default tolerance.
fn peers(problem: &Problem, quick: bool) -> Result<Vec<Case>> {
    let reference = reference(problem, quick)?;
    let problem = Rc::new(problem.clone());
    let mut cases = Vec::new();
    for integrator in integrators() {
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

/// The component compared with a reference of many modes: with automatic modes, and the error of modes and time steps
/// separately.
fn own(problem: &Problem, quick: bool) -> Result<Vec<Case>> {
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
        let mut chosen = problem.model.scene().clone();
        chosen.solver.modes = 0;
        chosen.solver.tolerance = setting.value();
        let chosen = scenes::modes_chosen(&chosen)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Failure;

    /// Second order at steps of 1 us leaves about (omega h)^2 / 12 of the motion, omega the highest frequency that moves the
    /// contact, some 1e5 1/s: 1e-3. Tolerances are far below that.
    #[test]
    fn all_integrate_the_same_equations() -> Result<(), Box<dyn std::error::Error>> {
        for mut problem in [scenes::paper()?, scenes::linear()?] {
            problem.end = 2e-3;
            problem.cells = 20;
            let reference = Reference::new(&problem, 1e-6).map_err(|failure| failure.to_string())?;
            for integrator in integrators() {
                let setting = if integrator.fixed_step() {
                    Setting::Step(1e-6)
                } else {
                    Setting::Tolerance(1e-7)
                };
                match integrator.run(&problem, setting) {
                    Ok(run) => {
                        assert_eq!(run.forces.len(), reference.forces.len());
                        for (force, exact) in run.forces.iter().zip(&reference.forces) {
                            let error = (force - exact).abs() / problem.model.force_scale();
                            assert!(error < 1e-3, "{}, {}: {error}", problem.name, integrator.name());
                        }
                    }
                    Err(Failure::Unavailable(why)) => eprintln!("{}: {why}", integrator.name()),
                    Err(failure) => return Err(failure.to_string().into()),
                }
            }
        }
        Ok(())
    }
}
