//! The component, through its Rust library: one call per cell of the grid.

use cpu_time::ThreadTime;

use relay_contact::inputs::Inputs;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;

use crate::integrator::{Failure, Integrator, Run, Setting};
use crate::problem::Problem;

/// The component.
pub struct Component;

impl Integrator for Component {
    fn name(&self) -> &'static str {
        "relay-contact"
    }

    fn run(&self, problem: &Problem, setting: Setting) -> Result<Run, Failure> {
        let mut scene = problem.model.scene().clone();
        scene.solver.tolerance = setting.value();
        let stopped = |error: &dyn std::fmt::Display| Failure::Stopped(error.to_string());
        let mut inputs = Inputs::default();
        let mut simulation = Simulation::new(&scene, &inputs, 0.0).map_err(|error| stopped(&error))?;
        let mut forces = Vec::with_capacity(problem.cells as usize + 1);
        let mut events: Vec<f64> = Vec::with_capacity(1000);
        let size = problem.end / f64::from(problem.cells);

        let start = ThreadTime::now();
        forces.push(simulation.real(RealOutput::ContactForce));
        for cell in 0..problem.cells {
            let time = problem.instant(cell);
            inputs.support_displacement = problem.support_rate * problem.instant(cell + 1);
            simulation.step(&inputs, time, size).map_err(|error| stopped(&error))?;
            forces.push(simulation.real(RealOutput::ContactForce));
            let mut last = [RealOutput::ContactLastOpening, RealOutput::ContactLastClosing].map(|o| simulation.real(o));
            last.sort_by(f64::total_cmp);
            let seen = events.last().copied().unwrap_or(-1.0);
            events.extend(last.into_iter().filter(|event| *event > seen));
        }
        let cpu = start.elapsed().as_secs_f64();
        let state = simulation.state();
        Ok(Run {
            forces,
            events,
            time: cpu,
            steps: state.steps,
            rejected: state.rejected_steps,
            iterations: state.iterations,
        })
    }
}
