//! Interface of the integrators.

use thiserror::Error;

use crate::problem::Problem;

/// Processor time an integrator may take for a run, s.
pub const BUDGET: f64 = 1.0;

/// Shorter runs are repeated until they have taken this together, s, as the first one is slower.
pub const SHORT: f64 = 2e-3;

/// A completed run.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Contact force at the grid times, N, the first at 0.
    pub forces: Vec<f64>,
    /// Times at which the contact opened and closed, alternating, s.
    pub events: Vec<f64>,
    /// Processor time of the integration on its one thread, s; unaffected by other load.
    pub time: f64,
    /// Processor time of what is made of the parameters before, s.
    pub start: f64,
}

/// A failed run.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Failure {
    /// The integrator is not installed here.
    #[error("skipped: {0}")]
    Unavailable(String),
    /// It stopped or gave no usable result.
    #[error("failed: {0}")]
    Stopped(String),
}

/// An integrator of the contact's equations.
pub trait Integrator {
    /// Name in tables and figures.
    fn name(&self) -> &'static str;

    /// Runs the problem with a tolerance of the force, relative to the force scale.
    fn run(&self, problem: &Problem, tolerance: f64) -> Result<Run, Failure>;
}
