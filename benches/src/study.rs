//! Runs of integrators against references, interleaved so that other load affects all of them.

use std::rc::Rc;

use indicatif::{ProgressBar, ProgressStyle};

use crate::integrator::{Failure, Integrator, Run, Setting};
use crate::problem::Problem;
use crate::radau::Reference;

/// The part of a study with the best runs of other integrators, of any number of modes.
pub const PEERS: &str = "peers";

/// Runs shorter than this, s, are repeated within a round.
const SHORT: f64 = 2e-3;

/// Runs longer than this, s, are timed once.
const LONG: f64 = 0.5;

/// One integrator at one setting.
#[derive(Clone)]
pub struct Case {
    /// The part of the study.
    pub part: &'static str,
    /// The problem.
    pub problem: Rc<Problem>,
    /// The reference.
    pub reference: Rc<Reference>,
    /// The integrator.
    pub integrator: Rc<dyn Integrator>,
    /// The accuracy setting.
    pub setting: Setting,
}

/// The result of a case.
pub struct Row {
    /// The case.
    pub case: Case,
    /// Number of modes.
    pub modes: usize,
    /// The measurement.
    pub outcome: Result<Measured, Failure>,
}

/// A completed run, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Processor time per simulated time, median of all rounds.
    pub cost: f64,
    /// The least of all rounds.
    pub least_cost: f64,
    /// Largest deviation of the contact force on the grid, relative to the force scale.
    pub force_error: f64,
    /// Openings and closings found.
    pub events: usize,
    /// Largest deviation of their times, s; none if their number is wrong.
    pub event_error: Option<f64>,
    /// Largest deviation of the length of an opening, s; none as before.
    pub duration_error: Option<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Newton iterations.
    pub iterations: u64,
}

impl Measured {
    /// Of the force, relative, and of the instants, s; infinite where their number is wrong.
    pub fn errors(&self) -> [f64; 2] {
        [self.force_error, self.event_error.unwrap_or(f64::INFINITY)]
    }

    /// Whether it is as accurate as another one, and cheaper by this factor.
    pub fn beats(&self, other: &Self, factor: f64) -> bool {
        factor * self.cost < other.cost
            && self
                .errors()
                .iter()
                .zip(other.errors())
                .all(|(own, error)| *own <= error)
    }
}

/// Whether another run of the same integrator, compared in the same scene, beats this one.
fn beaten(row: &Row, rows: &[Row]) -> bool {
    let Ok(run) = row.outcome.as_ref() else {
        return false;
    };
    let same = |case: &Case| {
        case.part == PEERS
            && case.problem.name == row.case.problem.name
            && case.integrator.name() == row.case.integrator.name()
    };
    let mut others = rows
        .iter()
        .filter(|other| same(&other.case))
        .filter_map(|other| other.outcome.as_ref().ok());
    row.case.part == PEERS && others.any(|other| other.beats(run, 1.0))
}

/// Runs all cases in `turns` rounds; of other integrators the runs that no other one of theirs beats are left.
pub fn run(cases: &[Case], turns: usize) -> Vec<Row> {
    let mut times = vec![Vec::new(); cases.len()];
    let mut first: Vec<Option<Result<Run, Failure>>> = cases.iter().map(|_| None).collect();
    let style =
        ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    let progress = ProgressBar::new((turns * cases.len()) as u64).with_style(style);
    for _ in 0..turns {
        for ((case, times), first) in cases.iter().zip(&mut times).zip(&mut first) {
            progress.set_message(case.integrator.name());
            progress.inc(1);
            let again = match first {
                None => true,
                Some(Ok(run)) => run.time < LONG,
                Some(Err(_)) => false,
            };
            if !again {
                continue;
            }
            let mut spent = 0.0;
            while spent < SHORT {
                let outcome = case.integrator.run(&case.problem, case.setting);
                spent += outcome.as_ref().map_or(f64::INFINITY, |run| run.time);
                times.extend(outcome.as_ref().ok().map(|run| run.time));
                first.get_or_insert(outcome);
            }
        }
    }
    progress.finish_and_clear();
    let rows = cases.iter().zip(times).zip(first);
    let rows = rows.filter_map(|((case, mut times), first)| {
        times.sort_by(f64::total_cmp);
        Some(Row {
            case: case.clone(),
            modes: case.problem.modes(),
            outcome: first?.and_then(|run| measure(case, &run, &times)),
        })
    });
    let rows: Vec<Row> = rows.collect();
    let left: Vec<bool> = rows.iter().map(|row| !beaten(row, &rows)).collect();
    rows.into_iter()
        .zip(left)
        .filter_map(|(row, left)| left.then_some(row))
        .collect()
}

/// A single run of a case.
///
/// # Errors
/// A [`Failure`].
pub fn once(case: &Case) -> Result<Measured, Failure> {
    let run = case.integrator.run(&case.problem, case.setting)?;
    measure(case, &run, &[run.time])
}

/// A run, and what it took in all rounds, s, in ascending order.
fn measure(case: &Case, run: &Run, times: &[f64]) -> Result<Measured, Failure> {
    let time = |place: usize| times.get(place).copied().unwrap_or(f64::NAN);
    let Case { problem, reference, .. } = case;
    if run.forces.len() != reference.forces.len() || run.forces.iter().any(|force| !force.is_finite()) {
        return Err(Failure::Stopped("the force is not finite at every time".to_owned()));
    }
    let found = (run.events.len() == reference.events.len()).then_some(run.events.as_slice());
    Ok(Measured {
        cost: time(times.len() / 2) / problem.end,
        least_cost: time(0) / problem.end,
        force_error: largest_difference(&run.forces, &reference.forces) / problem.model.force_scale(),
        events: run.events.len(),
        event_error: found.map(|events| largest_difference(events, &reference.events)),
        duration_error: found.map(|events| {
            let closed = problem.starts_closed();
            largest_difference(&openings(events, closed), &openings(&reference.events, closed))
        }),
        steps: run.steps,
        rejected: run.rejected,
        iterations: run.iterations,
    })
}

/// Lengths of the complete openings, s.
fn openings(events: &[f64], starts_closed: bool) -> Vec<f64> {
    let events = if starts_closed {
        events
    } else {
        events.get(1..).unwrap_or_default()
    };
    events
        .chunks_exact(2)
        .filter_map(|pair| match pair {
            [opening, closing] => Some(closing - opening),
            _ => None,
        })
        .collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
