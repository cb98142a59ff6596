//! SUNDIALS CVODE by a C program, `sundials/cvode.c`: BDF, dense analytic Jacobian, root finding, restart at events.
//!
//! The absolute tolerance is the tolerance in units of [`Problem::scales`], the relative one [`Problem::relative`]
//! times it.

use std::fmt::Write as _;

use relay_contact::reference::Law;

use crate::c_program::Program;
use crate::integrator::{BUDGET, Failure, Integrator, Run, Setting};
use crate::problem::Problem;

/// CVODE, if it could be compiled.
pub struct Cvode {
    program: Program,
}

impl Cvode {
    /// Compiles the program.
    pub fn new() -> Self {
        Self {
            program: Program::new("cvode", &["cvode", "sunmatrixdense", "sunlinsoldense"]),
        }
    }

    /// Version of the SUNDIALS library, if installed.
    pub fn version(&self) -> Option<String> {
        let problem = crate::scenes::linear().ok()?;
        let answer = self.program.ask(&question(&problem, 1e-2)).ok()?;
        answer.line("version ").map(ToOwned::to_owned)
    }
}

impl Default for Cvode {
    fn default() -> Self {
        Self::new()
    }
}

impl Integrator for Cvode {
    fn name(&self) -> &'static str {
        "CVODE BDF"
    }

    fn run(&self, problem: &Problem, setting: Setting) -> Result<Run, Failure> {
        let answer = self.program.ask(&question(problem, setting.value()))?;
        let work = answer.numbers("work")?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "counters of the C program, written as integers"
        )]
        let count = |which: usize| work.get(which).map_or(0, |count| *count as u64);
        Ok(Run {
            forces: answer.numbers("forces")?,
            events: answer.numbers("events")?,
            time: answer.numbers("time")?.first().copied().unwrap_or(f64::NAN),
            steps: count(0),
            rejected: count(1),
            iterations: count(2),
        })
    }
}

/// The problem as the C program reads it.
fn question(problem: &Problem, tolerance: f64) -> String {
    let model = &problem.model;
    let mut text = format!("{}\n", problem.modes());
    let mut line = |numbers: &[f64]| {
        for number in numbers {
            let _ = write!(text, "{number:e} ");
        }
        text.push('\n');
    };
    for mode in model.modes() {
        line(&[mode.omega_squared, mode.damping, mode.tip, mode.participation]);
    }
    match model.law() {
        Law::Power(power) => line(&[0.0, power.coefficient, power.damping, power.exponent]),
        Law::Linear(linear) => line(&[
            if linear.bonded { 2.0 } else { 1.0 },
            linear.stiffness,
            linear.damping,
            linear.offset,
        ]),
    }
    let (amplitude, omega, phase) = problem.sine();
    line(&[model.preload().force, model.preload().indentation]);
    line(&[amplitude, omega, phase, problem.support_rate]);
    let absolute: Vec<f64> = problem.scales().iter().map(|scale| tolerance * scale).collect();
    line(&[problem.relative * tolerance]);
    line(&absolute);
    line(&[problem.end, f64::from(problem.cells), BUDGET]);
    text
}
