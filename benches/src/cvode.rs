//! SUNDIALS CVODE by a C program, `sundials/cvode.c`: BDF, dense analytic Jacobian, root finding, restart at events.
//!
//! The absolute tolerance is [`Problem::absolute`], the relative one [`Problem::relative`] times the tolerance.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use relay_contact::reference::Opening;

use crate::integrator::{BUDGET, Failure, Integrator, Run, SHORT};
use crate::problem::Problem;

/// The program, if it could be compiled.
pub struct Cvode(Result<PathBuf, Failure>);

impl Default for Cvode {
    /// Compiles the program against the SUNDIALS library of the system.
    fn default() -> Self {
        Self(compile())
    }
}

impl Cvode {
    /// What the program answers: a key and its numbers on each line.
    fn ask(&self, question: &str) -> Result<String, Failure> {
        let program = self.0.as_ref().map_err(Clone::clone)?;
        let failed = |error: std::io::Error| Failure::Stopped(error.to_string());
        let mut command = Command::new(program);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(question.as_bytes()).map_err(failed)?;
        }
        let output = child.wait_with_output().map_err(failed)?;
        let answer = String::from_utf8_lossy(&output.stdout).into_owned();
        match line(&answer, "failure") {
            Some(failure) => Err(Failure::Stopped(failure.to_owned())),
            None => Ok(answer),
        }
    }

    /// Version of the SUNDIALS library, if installed.
    pub fn version(&self) -> Option<String> {
        let problem = crate::scenes::paper().ok()?;
        let answer = self.ask(&question(&problem, 1e-2).ok()?).ok()?;
        line(&answer, "version ").map(ToOwned::to_owned)
    }
}

impl Integrator for Cvode {
    fn name(&self) -> &'static str {
        "CVODE BDF"
    }

    fn run(&self, problem: &Problem, tolerance: f64) -> Result<Run, Failure> {
        let answer = self.ask(&question(problem, tolerance)?)?;
        let numbers = |key| -> Result<Vec<f64>, Failure> {
            let text = line(&answer, key).ok_or_else(|| Failure::Stopped("the C program stopped".to_owned()))?;
            Ok(text.split_whitespace().filter_map(|word| word.parse().ok()).collect())
        };
        Ok(Run {
            forces: numbers("forces")?,
            events: numbers("events")?,
            time: numbers("time")?.first().copied().unwrap_or(f64::NAN),
            start: problem.start(),
        })
    }
}

/// What follows a key.
fn line<'a>(answer: &'a str, key: &str) -> Option<&'a str> {
    answer.lines().find_map(|line| line.strip_prefix(key))
}

/// The problem as the C program reads it.
fn question(problem: &Problem, tolerance: f64) -> Result<String, Failure> {
    let model = &problem.model;
    let mut text = format!("{}\n", problem.modes());
    let mut line = |numbers: &[f64]| {
        for number in numbers {
            let _ = write!(text, "{number:e} ");
        }
        text.push('\n');
    };
    for mode in &model.modes {
        line(&[mode.omega_squared, mode.damping, mode.tip, mode.participation]);
    }
    let law = &model.law;
    if law.opening != Opening::Parting {
        return Err(Failure::Stopped("a linear contact".to_owned()));
    }
    line(&[law.coefficient, law.damping, law.exponent]);
    let (amplitude, omega, phase) = problem.sine();
    line(&[model.preload.force, model.preload.indentation]);
    line(&[amplitude, omega, phase, problem.support_rate]);
    line(&[problem.relative * tolerance]);
    line(&problem.absolute(tolerance));
    line(&[problem.end, f64::from(problem.cells), BUDGET, SHORT]);
    Ok(text)
}

fn compile() -> Result<PathBuf, Failure> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("sundials/cvode.c");
    let program = std::env::temp_dir().join(format!("relay-contact-cvode-{}", std::process::id()));
    let libraries = ["cvode", "sunmatrixdense", "sunlinsoldense", "nvecserial"];
    let libraries = libraries.map(|library| format!("-lsundials_{library}"));
    let output = Command::new("cc").args(["-O3", "-o"]).arg(&program).arg(source).args(libraries).arg("-lm").output();
    match output {
        Ok(output) if output.status.success() => Ok(program),
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stderr);
            let cause = text.lines().find(|line| line.contains("error")).unwrap_or("cc failed");
            Err(Failure::Unavailable(format!(
                "it needs SUNDIALS 6 (on Debian: apt-get install libsundials-dev): {cause}"
            )))
        }
        Err(error) => Err(Failure::Unavailable(format!("no C compiler cc: {error}"))),
    }
}
