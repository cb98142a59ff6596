//! Opening relays solved by the component and by the second solution.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;

use relay_contact::scene::Scene;
use relay_contact::variables::ExcitationKind;
use testing::promise::{OF_A_STEP, tighten};
use testing::relays::{Course, Relay};

use super::solution::{Resolution, Solver, damping_ratio};
use crate::integrator::Failure;

/// Number of elements with which the second solution begins, and how often it is refined at most: half as many elements more,
/// which have a 25th of the error, and a tenth of the tolerance.
const ELEMENTS: usize = 12;
const REFINEMENTS: usize = 4;

/// It is fine enough where a refinement changes the force by no more than this part of the tolerance asked of the component:
/// what is left is a fifth of it or less.
const SETTLED: f64 = 0.5;

/// What became of a relay.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// The contact stays closed, or open at all communication points, or the excitation is random.
    NotMeant,
    /// A change of excitation and curvature by the error of a step moves the force by more than the tolerance.
    IllConditioned,
    /// One of the two did not finish.
    Failed(String),
    /// Both finished.
    Compared(Row),
}

/// A relay compared.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its number.
    pub number: u64,
    /// Damping of the first mode relative to critical.
    pub damping: f64,
    /// Openings and closings.
    pub events: usize,
    /// `solver.tolerance`.
    pub asked: f64,
    /// Deviation of the component's contact force at communication points from the second solution, relative to the larger
    /// of the force scale and the largest force so far.
    pub deviation: f64,
    /// The same of the component at its smallest tolerance with the most modes.
    pub tightest: f64,
    /// What the last refinement of the second solution changed.
    pub refinement: f64,
    /// Its last number of elements.
    pub elements: usize,
}

fn course(relay: &Relay, change: impl FnOnce(&mut Scene)) -> Result<Course, Failure> {
    match relay.run(change) {
        Ok((course, None)) => Ok(course),
        Ok((_, Some(error))) => Err(Failure::Stopped(error.to_string())),
        Err(error) => Err(Failure::Stopped(error.to_string())),
    }
}

/// Relays compared, and what became of those between them.
pub struct Comparison {
    /// Those compared, by number.
    pub rows: Vec<Row>,
    /// The others, with their numbers.
    pub others: Vec<(u64, Outcome)>,
}

/// The first relays of a number on that can be compared, so many.
///
/// # Errors
/// [`Failure::Unavailable`] without the library.
pub fn compare_all(first: u64, count: usize) -> Result<Comparison, Failure> {
    let solver = Solver::new();
    let next = AtomicU64::new(first);
    let compared = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while compared.load(Ordering::Relaxed) < count {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let outcome = compare(&solver, number)?;
            println!("relay {number}: {outcome:?}");
            if matches!(outcome, Outcome::Compared(_)) {
                compared.fetch_add(1, Ordering::Relaxed);
            }
            done.push((number, outcome));
        }
        Ok(done)
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut done = thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let stopped = |_| Err(Failure::Stopped("a thread panicked".to_owned()));
        let parts = threads.into_iter().map(|thread| thread.join().unwrap_or_else(stopped));
        parts.collect::<Result<Vec<_>, Failure>>().map(|parts| parts.concat())
    })?;
    done.sort_by_key(|(number, _)| *number);
    let (mut rows, mut others) = (Vec::new(), Vec::new());
    for (number, outcome) in done {
        match outcome {
            Outcome::Compared(row) => rows.push(row),
            other if rows.len() < count => others.push((number, other)),
            _ => {}
        }
    }
    rows.truncate(count);
    Ok(Comparison { rows, others })
}

/// The relay of a number by both.
///
/// # Errors
/// [`Failure::Unavailable`] without the library.
fn compare(solver: &Solver, number: u64) -> Result<Outcome, Failure> {
    match attempt(solver, number) {
        Err(Failure::Stopped(why)) => Ok(Outcome::Failed(why)),
        outcome => outcome,
    }
}

fn attempt(solver: &Solver, number: u64) -> Result<Outcome, Failure> {
    let relay = Relay::draw(number);
    let asked = relay.scene.solver.tolerance;
    if relay.scene.effects.excitation == ExcitationKind::Random {
        return Ok(Outcome::NotMeant);
    }
    let own = course(&relay, |_| {})?;
    if own.events.is_empty() || own.force.iter().all(|force| *force == 0.0) {
        return Ok(Outcome::NotMeant);
    }
    let tightest = |stronger| course(&relay, |scene| tighten(scene, stronger));
    let best = tightest(0.0)?;
    if tightest(OF_A_STEP * asked)?.error(&best).0 > asked {
        return Ok(Outcome::IllConditioned);
    }
    let mut resolution = Resolution {
        elements: ELEMENTS,
        tolerance: (0.03 * asked).clamp(1e-9, 1e-6),
    };
    let mut coarse = solver.solve(&relay, resolution)?;
    let mut refinement = f64::INFINITY;
    for _ in 0..REFINEMENTS {
        resolution.elements += resolution.elements / 2;
        resolution.tolerance *= 0.1;
        let fine = solver.solve(&relay, resolution)?;
        refinement = coarse.error(&fine).0;
        coarse = fine;
        if refinement <= SETTLED * asked {
            break;
        }
    }
    Ok(Outcome::Compared(Row {
        number,
        damping: damping_ratio(&relay.scene).unwrap_or(f64::NAN),
        events: coarse.events.len(),
        asked,
        deviation: own.error(&coarse).0,
        tightest: best.error(&coarse).0,
        refinement,
        elements: resolution.elements,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sine, half sine and sweep; constant, prescribed and following axial force; Hertz' law and the linearised one; an input
    /// beside the generator. The tolerance of the second solution is far below those asked, 1e-5 to 1e-6.
    #[test]
    fn both_solutions_agree_and_a_wrong_damping_is_seen() {
        let solver = Solver::new();
        let resolution = Resolution {
            elements: 12,
            tolerance: 1e-8,
        };
        for number in [10_022, 10_030, 10_034, 10_051] {
            let mut relay = Relay::draw(number);
            let own = course(&relay, |_| {}).unwrap();
            let expected = match solver.solve(&relay, resolution) {
                Err(Failure::Unavailable(why)) => return eprintln!("{why}"),
                solved => solved.unwrap(),
            };
            let deviation = own.error(&expected).0 / relay.scene.solver.tolerance;
            assert!(own.opens() && deviation < 1.0, "relay {number}: {deviation}");
            relay.scene.beam.stiffness_damping *= 1.01;
            let wrong = solver.solve(&relay, resolution).unwrap();
            let deviation = own.error(&wrong).0 / relay.scene.solver.tolerance;
            assert!(deviation > 5.0, "relay {number}, damping 1 % off: {deviation}");
        }
    }
}
