//! C programs against the SUNDIALS library of the system: numbers on standard input, a key and its numbers on each line of
//! the answer.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::integrator::Failure;

/// A program, if it could be compiled.
pub struct Program {
    path: Result<PathBuf, Failure>,
}

impl Program {
    /// Compiles `sundials/NAME.c` into the build folder.
    pub fn new(name: &str, libraries: &[&str]) -> Self {
        Self {
            path: compile(name, libraries),
        }
    }

    /// The answer to a question.
    ///
    /// # Errors
    /// A [`Failure`] if the program is not available, or says that it failed.
    pub fn ask(&self, question: &str) -> Result<Answer, Failure> {
        let program = self.path.as_ref().map_err(Clone::clone)?;
        let failed = |error: std::io::Error| Failure::Stopped(error.to_string());
        let mut child = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(question.as_bytes()).map_err(failed)?;
        }
        let output = child.wait_with_output().map_err(failed)?;
        let answer = Answer(String::from_utf8_lossy(&output.stdout).into_owned());
        match answer.line("failure ") {
            Some(failure) => Err(Failure::Stopped(failure.to_owned())),
            None => Ok(answer),
        }
    }
}

/// What a program printed.
pub struct Answer(String);

impl Answer {
    /// What follows a key.
    pub fn line(&self, key: &str) -> Option<&str> {
        self.0.lines().find_map(|line| line.strip_prefix(key))
    }

    /// The numbers that follow a key.
    ///
    /// # Errors
    /// [`Failure::Stopped`] without the key.
    pub fn numbers(&self, key: &str) -> Result<Vec<f64>, Failure> {
        let text = self.line(key);
        let text = text.ok_or_else(|| Failure::Stopped("the C program stopped".to_owned()))?;
        Ok(text.split_whitespace().filter_map(|word| word.parse().ok()).collect())
    }
}

fn compile(name: &str, libraries: &[&str]) -> Result<PathBuf, Failure> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("sundials")
        .join(name)
        .with_extension("c");
    let folder = std::env::current_exe()
        .ok()
        .and_then(|path| path.parent().map(Path::to_owned))
        .unwrap_or_else(std::env::temp_dir);
    let program = folder.join(format!("relay-contact-{name}"));
    let output = Command::new("cc")
        .args(["-O3", "-o"])
        .arg(&program)
        .arg(source)
        .args(libraries.iter().map(|library| format!("-lsundials_{library}")))
        .args(["-lsundials_nvecserial", "-lm"])
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
