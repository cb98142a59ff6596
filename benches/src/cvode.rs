//! SUNDIALS CVODE by a C program, `cvode/cvode.c`: BDF, dense analytic Jacobian, root finding, restart at events.
//!
//! The absolute tolerance is the tolerance in units of [`Problem::scales`], the relative one [`Problem::relative`]
//! times it. The program is compiled on first use, against the system's libraries.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use relay_contact::reference::Law;

use crate::integrator::{BUDGET, Failure, Integrator, Run, Setting};
use crate::problem::Problem;

/// CVODE, if it could be compiled.
pub struct Cvode {
    program: Result<PathBuf, Failure>,
}

impl Cvode {
    /// Compiles the program.
    pub fn new() -> Self {
        Self { program: compile() }
    }

    /// Version of the SUNDIALS library, if installed.
    pub fn version(&self) -> Option<String> {
        let problem = crate::scenes::linear().ok()?;
        let answer = self.answer(&problem, 1e-2).ok()?;
        answer
            .lines()
            .find_map(|line| line.strip_prefix("version "))
            .map(ToOwned::to_owned)
    }

    fn answer(&self, problem: &Problem, tolerance: f64) -> Result<String, Failure> {
        let program = self.program.as_ref().map_err(Clone::clone)?;
        let failed = |error: std::io::Error| Failure::Stopped(error.to_string());
        let mut child = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        if let Some(mut input) = child.stdin.take() {
            input
                .write_all(question(problem, tolerance).as_bytes())
                .map_err(failed)?;
        }
        let output = child.wait_with_output().map_err(failed)?;
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
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
        let answer = self.answer(problem, setting.value())?;
        let line = |key: &str| answer.lines().find_map(|line| line.strip_prefix(key));
        if let Some(failure) = line("failure ") {
            return Err(Failure::Stopped(failure.to_owned()));
        }
        let numbers = |key: &str| -> Result<Vec<f64>, Failure> {
            let text = line(key).ok_or_else(|| Failure::Stopped("the C program stopped".to_owned()))?;
            Ok(text.split_whitespace().filter_map(|word| word.parse().ok()).collect())
        };
        let work = numbers("work")?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "counters of the C program, written as integers"
        )]
        let count = |which: usize| work.get(which).map_or(0, |count| *count as u64);
        Ok(Run {
            forces: numbers("forces")?,
            events: numbers("events")?,
            time: numbers("time")?.first().copied().unwrap_or(f64::NAN),
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
        Law::Hertz(hertz) => line(&[0.0, hertz.coefficient, hertz.damping, 0.0]),
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

/// Compiles the program into the build folder.
fn compile() -> Result<PathBuf, Failure> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("cvode/cvode.c");
    let folder = std::env::current_exe()
        .ok()
        .and_then(|path| path.parent().map(Path::to_owned))
        .unwrap_or_else(std::env::temp_dir);
    let program = folder.join("relay-contact-cvode");
    let output = Command::new("cc")
        .args(["-O3", "-o"])
        .arg(&program)
        .arg(source)
        .args(["-lsundials_cvode", "-lsundials_nvecserial", "-lsundials_sunmatrixdense"])
        .args(["-lsundials_sunlinsoldense", "-lm"])
        .output();
    match output {
        Ok(output) if output.status.success() => Ok(program),
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stderr);
            let cause = text.lines().find(|line| line.contains("error")).unwrap_or("cc failed");
            Err(Failure::Unavailable(format!(
                "the C program cannot be compiled with SUNDIALS 6 (on Debian: apt-get install libsundials-dev): {cause}"
            )))
        }
        Err(error) => Err(Failure::Unavailable(format!("no C compiler cc: {error}"))),
    }
}
