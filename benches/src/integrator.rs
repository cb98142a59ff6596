//! What every integrator here does.

use crate::problem::Problem;

/// Processor time an integrator may take for a run, s.
pub const BUDGET: f64 = 20.0;

/// What an integrator is told about accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// Error asked for in the force, relative to the force scale.
    Tolerance(f64),
    /// Length of all steps, s.
    Step(f64),
}

impl Setting {
    /// The number without its meaning.
    pub fn value(self) -> f64 {
        match self {
            Self::Tolerance(value) | Self::Step(value) => value,
        }
    }

    /// The meaning without the number.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Tolerance(_) => "tolerance",
            Self::Step(_) => "step",
        }
    }
}

/// A run that came to its end.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Contact force at the grid's instants, N, the first at 0.
    pub forces: Vec<f64>,
    /// Instants at which the contact opened and closed in turn, s.
    pub events: Vec<f64>,
    /// Processor time the integration took on its one thread, without setting it up, s. The machine's other work does not count.
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// Steps discarded.
    pub rejected: u64,
    /// Newton iterations.
    pub iterations: u64,
}

/// A run that did not.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// The integrator is not installed here.
    Unavailable(String),
    /// It stopped or gave no usable result.
    Stopped(String),
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unavailable(why) => write!(f, "skipped: {why}"),
            Self::Stopped(why) => write!(f, "failed: {why}"),
        }
    }
}

/// An integrator of the contact's equations.
pub trait Integrator {
    /// What it is called in tables and figures.
    fn name(&self) -> &'static str;

    /// Whether it works at a fixed step, and not to a tolerance.
    fn fixed_step(&self) -> bool {
        false
    }

    /// Runs the problem.
    ///
    /// # Errors
    /// A [`Failure`].
    fn run(&self, problem: &Problem, setting: Setting) -> Result<Run, Failure>;
}
