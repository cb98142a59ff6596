//! The measurement: the component in every scene, and of each peer the runs that no other run of its own beats.
//!
//! Runs are interleaved in rounds, so that other load on the machine falls on all of them.

use std::fmt::Write as _;
use std::rc::Rc;

use anyhow::{Result, anyhow};
use relay_contact::scene::Solver;
use testing::scenes::largest_difference;

use crate::component::Component;
use crate::cvode::Cvode;
use crate::integrator::{Failure, Integrator, Run, SHORT};
use crate::problem::Problem;
use crate::radau::Reference;
use crate::scenes;

/// Numbers of modes tried with each peer.
const MODES: [i32; 14] = [2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 20, 24, 32, 40];

/// Runs of one search that cost up to this much more than another at equal or better error are timed again.
const NEARLY: f64 = 1.3;

/// Runs longer than this, s, are timed once.
const LONG: f64 = 0.5;

/// The integrators that the component is compared with.
fn peers() -> Vec<Rc<dyn Integrator>> {
    vec![
        Rc::new(Cvode::default()),
        #[cfg(feature = "diffsol")]
        Rc::new(crate::diffsol::Diffsol),
    ]
}

/// One integrator with one tolerance.
#[derive(Clone)]
struct Case {
    /// `delivered`: the component as it is used; `modes`: with so many modes; `peers`.
    part: &'static str,
    problem: Rc<Problem>,
    reference: Rc<Reference>,
    integrator: Rc<dyn Integrator>,
    tolerance: f64,
}

/// A completed run, measured.
#[derive(Clone, Copy, Debug)]
struct Measured {
    /// Processor time per simulated time, the least of all rounds, as what else runs only adds to it; and the median.
    cost: f64,
    median_cost: f64,
    /// Processor time of the start, and of start and simulation together, the least of all rounds, s.
    start: f64,
    total: f64,
    /// Largest deviation of the contact force on the grid, relative to the force scale.
    force_error: f64,
    /// Openings and closings found.
    events: usize,
    /// Largest deviation of their times, and of the length of an opening, s; none if their number is wrong.
    event_error: Option<f64>,
    duration_error: Option<f64>,
}

impl Measured {
    /// Whether it is as accurate as another one in force and instants, and cheaper by this factor, with its start too.
    fn beats(&self, other: &Self, factor: f64) -> bool {
        let errors = |run: &Self| [run.force_error, run.event_error.unwrap_or(f64::INFINITY)];
        let cheaper = factor * self.cost < other.cost && factor * self.total < other.total;
        cheaper && errors(self).iter().zip(errors(other)).all(|(own, error)| *own <= error)
    }
}

/// Measures everything, each run in `turns` rounds; gives it as CSV.
pub fn measure(quick: bool, turns: usize) -> Result<String> {
    let cases = all(quick)?;
    let rows = rounds(&cases, turns);
    let beaten = |case: &Case, run: &Measured| {
        case.part == "peers"
            && cases.iter().zip(&rows).any(|(other, row)| {
                let same = other.problem.name == case.problem.name && other.integrator.name() == case.integrator.name();
                same && other.part == case.part && row.as_ref().is_ok_and(|other| other.beats(run, 1.0))
            })
    };
    let mut text = String::from(
        "part,scene,integrator,tolerance,modes,seconds_per_second,median_seconds_per_second,start_seconds,total_seconds,\
         force_error,event_error_us,opening_duration_error_us,events,reference_force_error,reference_event_error_us,outcome\n",
    );
    let micro = |seconds: Option<f64>| seconds.map_or(String::new(), |seconds| format!("{:.4e}", 1e6 * seconds));
    for (case, row) in cases.iter().zip(&rows) {
        let (name, modes) = (case.integrator.name(), case.problem.modes());
        let measured = match row {
            Ok(run) if beaten(case, run) => continue,
            Ok(run) => format!(
                "{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{},{},{}",
                run.cost,
                run.median_cost,
                run.start,
                run.total,
                run.force_error,
                micro(run.event_error),
                micro(run.duration_error),
                run.events
            ),
            Err(_) => ",,,,,,,".to_owned(),
        };
        let outcome =
            row.as_ref().map_or_else(|failure| failure.to_string().replace([',', '\n'], " "), |_| "ok".to_owned());
        let Reference { force_error, event_error, .. } = *case.reference;
        let _ = writeln!(
            text,
            "{},{},{name},{:e},{modes},{measured},{force_error:.4e},{},{outcome}",
            case.part,
            case.problem.name,
            case.tolerance,
            micro(Some(event_error))
        );
    }
    Ok(text)
}

/// All cases: the component in each scene, and of its peers the runs that no other run of theirs beats.
fn all(quick: bool) -> Result<Vec<Case>> {
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
    let case = |part, problem, tolerance| Case {
        part,
        problem: Rc::new(problem),
        reference: Rc::clone(reference),
        integrator: Rc::new(Component),
        tolerance,
    };
    let mut cases = Vec::new();
    for tolerance in tolerances(quick, 1) {
        let used = problem.with(|scene| scene.solver.tolerance = tolerance)?;
        cases.push(case("delivered", used, tolerance));
    }
    let modes = (2..=16).chain((20..=scenes::MANY_MODES).step_by(4));
    for modes in modes.step_by(if quick { 4 } else { 1 }) {
        cases.push(case("modes", problem.with_modes(modes)?, Solver::TOLERANCE_FLOOR));
    }
    Ok(cases)
}

/// Searches modes and tolerances of a peer: the runs that no other beats in time and in both errors, or hardly.
fn best(
    problem: &Problem,
    reference: &Rc<Reference>,
    integrator: &Rc<dyn Integrator>,
    quick: bool,
) -> Result<Vec<Case>> {
    let mut found: Vec<(Case, Measured)> = Vec::new();
    for modes in MODES.into_iter().step_by(if quick { 3 } else { 1 }) {
        for relative in [1.0, 0.01] {
            let problem = Rc::new(Problem { relative, ..problem.with_modes(modes)? });
            let mut least = [f64::INFINITY; 2];
            let mut idle = 0;
            for tolerance in tolerances(quick, 2) {
                let case = Case {
                    part: "peers",
                    problem: Rc::clone(&problem),
                    reference: Rc::clone(reference),
                    integrator: Rc::clone(integrator),
                    tolerance,
                };
                let run = match integrator
                    .run(&problem, tolerance)
                    .and_then(|run| judge(&case, &run, vec![(run.time, run.start)]))
                {
                    Ok(run) => run,
                    // Named once, by its row.
                    Err(Failure::Unavailable(_)) => return Ok(vec![case]),
                    Err(Failure::Stopped(_)) => continue,
                };
                // Where the modes left out decide, a smaller tolerance only costs more.
                let errors = [run.force_error, run.event_error.unwrap_or(f64::INFINITY)];
                let gains = errors.iter().zip(least).any(|(error, least)| *error < 0.7 * least);
                idle = if gains { 0 } else { idle + 1 };
                least = [errors[0].min(least[0]), errors[1].min(least[1])];
                found.push((case, run));
                // Three decades.
                if idle == 6 {
                    break;
                }
            }
        }
    }
    let beaten = |one: &Measured| found.iter().any(|(_, other)| other.beats(one, NEARLY));
    Ok(found.iter().filter(|(_, one)| !beaten(one)).map(|(case, _)| case.clone()).collect())
}

/// So many in a decade, from 1e-1 to 1e-11.
fn tolerances(quick: bool, parts: u32) -> impl Iterator<Item = f64> {
    let digits = move |step: u32| f64::from(step) / f64::from(parts);
    (parts..=11 * parts).step_by(if quick { 3 * parts as usize } else { 1 }).map(move |step| 10_f64.powf(-digits(step)))
}

/// Runs all cases in rounds.
fn rounds(cases: &[Case], turns: usize) -> Vec<Result<Measured, Failure>> {
    let mut times = vec![Vec::new(); cases.len()];
    let mut first: Vec<Option<Result<Run, Failure>>> = cases.iter().map(|_| None).collect();
    for turn in 1..=turns {
        eprintln!("round {turn} of {turns}: {} runs", cases.len());
        for ((case, times), first) in cases.iter().zip(&mut times).zip(&mut first) {
            if first.as_ref().is_some_and(|known| known.as_ref().map_or(true, |run| run.time > LONG)) {
                continue;
            }
            let mut spent = 0.0;
            while spent < SHORT {
                let outcome = case.integrator.run(&case.problem, case.tolerance);
                spent += outcome.as_ref().map_or(f64::INFINITY, |run| run.time);
                times.extend(outcome.as_ref().ok().map(|run| (run.time, run.start)));
                first.get_or_insert(outcome);
            }
        }
    }
    let rows = cases.iter().zip(times).zip(first);
    rows.map(|((case, times), first)| {
        first.unwrap_or_else(|| Err(Failure::Stopped("not run".to_owned()))).and_then(|run| judge(case, &run, times))
    })
    .collect()
}

/// A run, and what simulation and start took in all rounds, s.
fn judge(case: &Case, run: &Run, times: Vec<(f64, f64)>) -> Result<Measured, Failure> {
    let (mut times, mut starts): (Vec<f64>, Vec<f64>) = times.into_iter().unzip();
    times.sort_by(f64::total_cmp);
    starts.sort_by(f64::total_cmp);
    let at = |sorted: &[f64], place: usize| sorted.get(place).copied().unwrap_or(f64::NAN);
    let (time, start) = (at(&times, 0), at(&starts, 0));
    let Case { problem, reference, .. } = case;
    if run.forces.len() != reference.forces.len() || run.forces.iter().any(|force| !force.is_finite()) {
        return Err(Failure::Stopped("the force is not finite at every time".to_owned()));
    }
    let found = (run.events.len() == reference.events.len()).then_some(run.events.as_slice());
    Ok(Measured {
        cost: time / problem.end,
        median_cost: at(&times, times.len() / 2) / problem.end,
        start,
        total: start + time,
        force_error: largest_difference(&run.forces, &reference.forces) / problem.model.force_scale,
        events: run.events.len(),
        event_error: found.map(|events| largest_difference(events, &reference.events)),
        duration_error: found.map(|events| {
            let closed = problem.starts_closed();
            largest_difference(&openings(events, closed), &openings(&reference.events, closed))
        }),
    })
}

/// Lengths of the complete openings, s.
fn openings(events: &[f64], starts_closed: bool) -> Vec<f64> {
    let events = events.get(usize::from(!starts_closed)..).unwrap_or_default();
    events.chunks_exact(2).map(|pair| pair[1] - pair[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_integrate_the_same_equations() -> Result<(), Box<dyn std::error::Error>> {
        let mut problem = scenes::paper()?;
        problem.end = 2e-3;
        problem.cells = 20;
        let reference = Rc::new(Reference::new(&problem, 1e-6).map_err(|failure| failure.to_string())?);
        let own: Rc<dyn Integrator> = Rc::new(Component);
        for integrator in peers().into_iter().chain([own]) {
            match integrator.run(&problem, 1e-7) {
                Ok(run) => {
                    let error = largest_difference(&run.forces, &reference.forces) / problem.model.force_scale;
                    // A hundred steps of a local error of the tolerance.
                    assert!(error < 1e-5, "{}: {error}", integrator.name());
                }
                Err(Failure::Unavailable(why)) => eprintln!("{}: {why}", integrator.name()),
                Err(failure) => return Err(failure.to_string().into()),
            }
        }
        Ok(())
    }
}
