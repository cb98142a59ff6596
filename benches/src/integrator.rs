//! Interface of the integrators.

use crate::problem::Problem;

/// Processor time an integrator may take for a run, s.
pub const BUDGET: f64 = 5.0;

/// Accuracy setting of an integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// Tolerance of the force, relative to the force scale.
    Tolerance(f64),
    /// Length of all steps, s.
    Step(f64),
}

impl Setting {
    /// The number.
    pub fn value(self) -> f64 {
        match self {
            Self::Tolerance(value) | Self::Step(value) => value,
        }
    }

    /// The kind of setting.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Tolerance(_) => "tolerance",
            Self::Step(_) => "step",
        }
    }
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Tolerance(value) => write!(f, "{value:.0e}"),
            Self::Step(value) => write!(f, "{value:.0e} s"),
        }
    }
}

/// A completed run.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Contact force at the grid times, N, the first at 0.
    pub forces: Vec<f64>,
    /// Times at which the contact opened and closed, alternating, s.
    pub events: Vec<f64>,
    /// Processor time of the integration on its one thread, without setup, s; unaffected by other load.
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Newton iterations.
    pub iterations: u64,
}

/// A failed run.
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
    /// Name in tables and figures.
    fn name(&self) -> &'static str;

    /// Whether it uses a fixed step instead of a tolerance.
    fn fixed_step(&self) -> bool {
        false
    }

    /// Runs the problem.
    ///
    /// # Errors
    /// A [`Failure`].
    fn run(&self, problem: &Problem, setting: Setting) -> Result<Run, Failure>;
}
