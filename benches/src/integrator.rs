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

/// All integrators, the component first.
pub fn all() -> Vec<Box<dyn Integrator>> {
    vec![
        Box::new(crate::component::Component),
        Box::new(crate::cvode::Cvode::new()),
        Box::new(crate::diffsol::Diffsol::Bdf),
        Box::new(crate::diffsol::Diffsol::Esdirk34),
        Box::new(crate::generalised_alpha::GeneralisedAlpha::newmark()),
        Box::new(crate::generalised_alpha::GeneralisedAlpha::with_spectral_radius(0.8)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radau::Reference;
    use crate::scenes;

    /// Second order at steps of 1 us leaves about (omega h)^2 / 12 of the motion, omega the highest frequency that moves the
    /// contact, some 1e5 1/s: 1e-3. Tolerances are far below that.
    #[test]
    fn all_integrate_the_same_equations() -> Result<(), Box<dyn std::error::Error>> {
        for mut problem in [scenes::paper()?, scenes::linear()?] {
            problem.end = 2e-3;
            problem.cells = 20;
            let reference = Reference::new(&problem, 1e-6).map_err(|failure| failure.to_string())?;
            for integrator in all() {
                let setting = if integrator.fixed_step() {
                    Setting::Step(1e-6)
                } else {
                    Setting::Tolerance(1e-7)
                };
                match integrator.run(&problem, setting) {
                    Ok(run) => {
                        assert_eq!(run.forces.len(), reference.forces.len());
                        for (force, exact) in run.forces.iter().zip(&reference.forces) {
                            let error = (force - exact).abs() / problem.model.force_scale;
                            assert!(error < 1e-3, "{}, {}: {error}", problem.name, integrator.name());
                        }
                    }
                    Err(Failure::Unavailable(why)) => eprintln!("{}: {why}", integrator.name()),
                    Err(failure) => return Err(failure.to_string().into()),
                }
            }
        }
        Ok(())
    }
}
