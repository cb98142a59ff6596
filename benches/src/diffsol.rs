//! The Rust library diffsol: BDF of orders 1 to 5, dense, with analytic Jacobian-vector products and root finding.
//!
//! The absolute tolerance is [`Problem::absolute`], the relative one [`Problem::relative`] times the tolerance. At an opening or a
//! closing the solver is restarted on the other branch.

use cpu_time::ThreadTime;

use ::diffsol::{DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};

use crate::integrator::{BUDGET, Failure, Integrator, Run};
use crate::problem::Problem;

/// Runs with more openings and closings than this fail.
const MOST_EVENTS: usize = 10_000;

/// The BDF of diffsol.
pub struct Diffsol;

impl Integrator for Diffsol {
    fn name(&self) -> &'static str {
        "diffsol BDF"
    }

    fn run(&self, problem: &Problem, tolerance: f64) -> Result<Run, Failure> {
        let start = ThreadTime::now();
        let mut run = Run { forces: vec![problem.model.preload.force], ..Run::default() };
        let mut branch = Start { time: 0.0, state: vec![0.0; 2 * problem.modes()], closed: problem.starts_closed() };
        while run.forces.len() <= problem.cells as usize {
            let stopped = |error: &DiffsolError| Failure::Stopped(format!("t = {:.6e} s: {error}", branch.time));
            let next = Self::branch(problem, &branch, tolerance, start, &mut run).map_err(|error| stopped(&error))?;
            if run.events.len() > MOST_EVENTS {
                return Err(Failure::Stopped("too many openings and closings".to_owned()));
            }
            match next {
                Some(next) => branch = next,
                None if start.elapsed().as_secs_f64() > BUDGET => {
                    return Err(Failure::Stopped("time limit exceeded".to_owned()));
                }
                None => break,
            }
        }
        run.time = start.elapsed().as_secs_f64();
        run.start = problem.start();
        Ok(run)
    }
}

/// Where a branch starts.
struct Start {
    time: f64,
    state: Vec<f64>,
    closed: bool,
}

impl Diffsol {
    /// Runs on one branch, to its end or to the end of the simulation.
    fn branch(
        problem: &Problem,
        from: &Start,
        tolerance: f64,
        clock: ThreadTime,
        run: &mut Run,
    ) -> Result<Option<Start>, DiffsolError> {
        let closed = from.closed;
        let mut ode = OdeBuilder::<NalgebraMat<f64>>::new()
            .t0(from.time)
            .rtol(problem.relative * tolerance)
            .atol(problem.absolute(tolerance))
            .rhs_implicit(
                |state, _, time, derivative| problem.derivative(closed, time, state, derivative),
                |state, _, time, direction, product| problem.jacobian_times(closed, time, state, direction, product),
            )
            .init(|_, _, state| state.copy_from_slice(&from.state), from.state.len())
            .root(
                |state, _, time, root| {
                    // If the contact cannot open, the engagement is infinite.
                    root.fill(problem.engagement(time, state).min(1.0));
                },
                1,
            )
            .build()?;
        // The first steps after an impact are short.
        ode.ode_options.min_timestep = 1e-20;
        let mut solver = ode.bdf::<NalgebraLU<f64>>()?;
        let mut cell = u32::try_from(run.forces.len()).unwrap_or(u32::MAX);
        let mut steps = 0_u32;
        while cell <= problem.cells {
            // Reading the processor time costs as much as half a step, so not every step.
            steps += 1;
            if steps.is_multiple_of(1000) && clock.elapsed().as_secs_f64() > BUDGET {
                break;
            }
            let mut reached = f64::INFINITY;
            if let OdeSolverStopReason::RootFound(root, _) = solver.step()? {
                // A branch starts at zero engagement up to rounding: crossing into the branch does not end it.
                let state = solver.state();
                if (problem.engagement(state.t, state.y.batch_as_slice(0)) > 0.0) != closed {
                    reached = root;
                }
            }
            let end = reached.min(solver.state().t);
            while cell <= problem.cells && problem.instant(cell) <= end {
                let time = problem.instant(cell);
                let state = solver.interpolate(time)?;
                run.forces.push(problem.force(closed, time, state.batch_as_slice(0)));
                cell += 1;
            }
            if reached.is_finite() && cell <= problem.cells {
                run.events.push(reached);
                let state = solver.interpolate(reached)?.batch_as_slice(0).to_vec();
                return Ok(Some(Start { time: reached, state, closed: !closed }));
            }
        }
        Ok(None)
    }
}
