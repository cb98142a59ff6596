//! The component as its users run it: through its C interface, watched for interruptions and extremes, one communication
//! step per cell of the grid, force and instants read after each.

use cpu_time::ThreadTime;
use relay_contact::fmi2::{fmi2OK, fmi2Status};
use testing::instance::{Instance, vr};

use crate::integrator::{Failure, Integrator, Run};
use crate::problem::Problem;

/// The component.
pub struct Component;

impl Integrator for Component {
    fn name(&self) -> &'static str {
        "relay-contact"
    }

    fn run(&self, problem: &Problem, tolerance: f64) -> Result<Run, Failure> {
        let mut scene = problem.model.scene.clone();
        scene.solver.tolerance = tolerance;
        let start = ThreadTime::now();
        let contact = Instance::new();
        let instantiated = start.elapsed();
        contact.set_scene(&scene);
        let check = |status: fmi2Status| {
            (status == fmi2OK).then_some(()).ok_or_else(|| Failure::Stopped(format!("{:?}", contact.messages())))
        };
        let start = ThreadTime::now();
        check(contact.setup(None, 0.0, None))?;
        contact.initialize();
        let initialized = start.elapsed();
        let read = ["contact.force", "contact.lastOpening", "contact.lastClosing"].map(vr);
        let support = [vr("support.displacement")];
        let mut forces = Vec::with_capacity(problem.cells as usize + 1);
        let mut events: Vec<f64> = Vec::with_capacity(1000);
        let size = problem.end / f64::from(problem.cells);

        let start = ThreadTime::now();
        forces.push(contact.reals_of(read)[0]);
        for cell in 0..problem.cells {
            if problem.support_rate != 0.0 {
                check(contact.set_reals_of(support, [problem.support_rate * problem.instant(cell)]))?;
                check(contact.set_rates_of(support, [1], [problem.support_rate]))?;
            }
            check(contact.step(problem.instant(cell), size))?;
            let [force, opening, closing] = contact.reals_of(read);
            forces.push(force);
            let seen = events.last().copied().unwrap_or(-1.0);
            let last = [opening.min(closing), opening.max(closing)];
            events.extend(last.into_iter().filter(|event| *event > seen));
        }
        Ok(Run {
            forces,
            events,
            time: start.elapsed().as_secs_f64(),
            start: (instantiated + initialized).as_secs_f64(),
        })
    }
}
