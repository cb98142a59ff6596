//! Runs of integrators against references, interleaved so that other load affects all of them.

use std::rc::Rc;

use indicatif::{ProgressBar, ProgressStyle};

use crate::integrator::{Failure, Integrator, Run, Setting};
use crate::problem::Problem;
use crate::radau::Reference;

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

impl Row {
    /// Whether the contact opens or closes.
    pub fn opens(&self) -> bool {
        !self.case.reference.events.is_empty()
    }
}

/// A completed run, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Processor time per simulated time, median of all rounds.
    pub cost: f64,
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

/// Runs all cases in `turns` rounds.
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
    rows.filter_map(|((case, mut times), first)| {
        times.sort_by(f64::total_cmp);
        let time = times.get(times.len() / 2).copied().unwrap_or(f64::NAN);
        Some(Row {
            case: case.clone(),
            modes: case.problem.modes(),
            outcome: first?.and_then(|run| measure(case, &run, time)),
        })
    })
    .collect()
}

fn measure(case: &Case, run: &Run, time: f64) -> Result<Measured, Failure> {
    let Case { problem, reference, .. } = case;
    if run.forces.len() != reference.forces.len() || run.forces.iter().any(|force| !force.is_finite()) {
        return Err(Failure::Stopped("the force is not finite at every time".to_owned()));
    }
    let found = (run.events.len() == reference.events.len()).then_some(run.events.as_slice());
    Ok(Measured {
        cost: time / problem.end,
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
