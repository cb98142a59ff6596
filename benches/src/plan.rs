//! The measurements: which integrators on which scenes at which settings.

use std::rc::Rc;

use anyhow::{Result, anyhow};
use relay_contact::scene::Solver;

use crate::component::Component;
use crate::cvode::Cvode;
use crate::diffsol::Diffsol;
use crate::integrator::{Failure, Integrator, Setting};
use crate::newmark::Newmark;
use crate::problem::Problem;
use crate::radau::Reference;
use crate::study::{self, Case, Measured};
use crate::{scenes, table};

/// The integrators that the component is compared with.
pub fn peers() -> [Rc<dyn Integrator>; 3] {
    [Rc::new(Cvode::new()), Rc::new(Diffsol), Rc::new(Newmark)]
}

/// Numbers of modes tried with each of them.
const MODES: [i32; 11] = [3, 4, 5, 6, 7, 8, 10, 12, 16, 20, 24];

/// Runs of one search that cost up to this much more than another at equal or better error are timed again.
const NEARLY: f64 = 1.3;

/// All measurements: the component in each scene, and of its peers the runs that no other run of theirs beats.
///
/// # Errors
/// If a scene cannot be simulated or its reference fails; the same for all functions here.
pub fn all(quick: bool) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for problem in scenes::all()? {
        let many = problem.with_modes(scenes::MANY_MODES)?;
        let step = if quick { 1e-6 } else { 2e-5 * problem.end };
        let reference = Reference::new(&many, step).map_err(|failure| anyhow!("{}: {failure}", problem.name))?;
        let reference = Rc::new(reference);
        cases.extend(own(&problem, &reference, quick)?);
        if scenes::COMPARED.contains(&problem.name) {
            for integrator in peers() {
                cases.extend(best(&problem, &reference, &integrator, quick)?);
            }
        }
    }
    Ok(cases)
}

/// The component with the modes that it chooses; and at its smallest tolerance with each number of modes.
fn own(problem: &Problem, reference: &Rc<Reference>, quick: bool) -> Result<Vec<Case>> {
    let case = |part, problem, setting| Case {
        part,
        problem: Rc::new(problem),
        reference: Rc::clone(reference),
        integrator: Rc::new(Component),
        setting,
    };
    let mut cases = Vec::new();
    for setting in settings(false, quick) {
        let used = problem.with(|scene| scene.solver.tolerance = setting.value())?;
        cases.push(case(table::DELIVERED, used, setting));
    }
    let finest = Setting::Tolerance(Solver::TOLERANCE_FLOOR);
    for modes in (2..=16)
        .chain((20..=scenes::MANY_MODES).step_by(4))
        .step_by(if quick { 4 } else { 1 })
    {
        cases.push(case("modes", problem.with_modes(modes)?, finest));
    }
    Ok(cases)
}

/// Searches modes and settings of an integrator: the runs that no other beats in time and in both errors, or hardly.
fn best(
    problem: &Problem,
    reference: &Rc<Reference>,
    integrator: &Rc<dyn Integrator>,
    quick: bool,
) -> Result<Vec<Case>> {
    let mut found: Vec<(Case, Measured)> = Vec::new();
    let relatives: &[f64] = if integrator.fixed_step() { &[1.0] } else { &[1.0, 0.01] };
    for modes in MODES.into_iter().step_by(if quick { 3 } else { 1 }) {
        for relative in relatives {
            let problem = Rc::new(Problem {
                relative: *relative,
                ..problem.with_modes(modes)?
            });
            let mut least = [f64::INFINITY; 2];
            let mut idle = 0;
            for setting in settings(integrator.fixed_step(), quick) {
                let case = Case {
                    part: study::PEERS,
                    problem: Rc::clone(&problem),
                    reference: Rc::clone(reference),
                    integrator: Rc::clone(integrator),
                    setting,
                };
                let measured = match study::once(&case) {
                    Ok(measured) => measured,
                    // Named once, by the table of failed runs.
                    Err(Failure::Unavailable(_)) => return Ok(vec![case]),
                    Err(Failure::Stopped(_)) => continue,
                };
                // Where the modes left out decide, a smaller tolerance only costs more.
                let errors = measured.errors();
                let gains = errors.iter().zip(least).any(|(error, least)| *error < 0.7 * least);
                idle = if gains { 0 } else { idle + 1 };
                least = [errors[0].min(least[0]), errors[1].min(least[1])];
                found.push((case, measured));
                if idle == 3 {
                    break;
                }
            }
        }
    }
    let beaten = |one: &Measured| found.iter().any(|(_, other)| other.beats(one, NEARLY));
    Ok(found
        .iter()
        .filter(|(_, one)| !beaten(one))
        .map(|(case, _)| case.clone())
        .collect())
}

fn settings(fixed_step: bool, quick: bool) -> Vec<Setting> {
    let stride = if quick { 3 } else { 1 };
    if fixed_step {
        let steps = [2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7, 5e-8];
        steps.into_iter().step_by(stride).map(Setting::Step).collect()
    } else {
        let tolerance = |digits: i32| Setting::Tolerance(10_f64.powi(-digits));
        (1..=11).step_by(stride).map(tolerance).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second order at steps of 1 us leaves about (omega h)^2 / 12 of the motion, omega the highest frequency that moves the
    /// contact, some 1e5 1/s: 1e-3. Tolerances are far below that.
    #[test]
    fn all_integrate_the_same_equations() -> Result<(), Box<dyn std::error::Error>> {
        for mut problem in [scenes::paper()?, scenes::linear()?] {
            problem.end = 2e-3;
            problem.cells = 20;
            let reference = Reference::new(&problem, 1e-6).map_err(|failure| failure.to_string())?;
            let own: Rc<dyn Integrator> = Rc::new(Component);
            for integrator in peers().into_iter().chain([own]) {
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

    /// A search that finds what is known: of two settings of which one is worse in everything only the better one is left.
    #[test]
    fn a_search_keeps_what_no_other_run_beats() -> Result<()> {
        let mut problem = scenes::paper()?;
        problem.end = 2e-3;
        problem.cells = 20;
        let many = problem.with_modes(12)?;
        let reference = Rc::new(Reference::new(&many, 1e-6).map_err(|failure| anyhow!("{failure}"))?);
        let integrator: Rc<dyn Integrator> = Rc::new(Newmark);
        let cases = best(&problem, &reference, &integrator, false)?;
        let rows: Vec<Measured> = cases.iter().filter_map(|case| study::once(case).ok()).collect();
        assert_eq!(rows.len(), cases.len());
        // Steps of 20 us with 24 modes cost eight times what they cost with 3, and are no better.
        assert!(
            cases
                .iter()
                .all(|case| case.problem.modes() < 24 || case.setting.value() < 2e-5)
        );
        // The most accurate one is among them: second order leaves 1e-6 at 50 ns.
        assert!(rows.iter().any(|run| run.force_error < 1e-5));
        Ok(())
    }
}
