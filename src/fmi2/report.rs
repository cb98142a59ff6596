//! Texts of the debug messages.

use super::logger::{Category, Logger};
use super::types::fmi2OK;
use crate::error::number;
use crate::math::simd::Simd;
use crate::model::Model;
use crate::simulation::Simulation;

/// Number of modes, kind of steps and tolerance of a scene.
pub(super) fn model(logger: &Logger, model: &Model) {
    let modes = model.modes.len();
    let steps = match model.closed_loop {
        Some(_) => "exact steps while the contact is closed",
        None => "steps by collocation",
    };
    let tolerance = model.scene.solver.effective_tolerance();
    let error = tolerance * model.force_scale;
    let machine = match model.simd {
        Simd::Portable => "for any processor",
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2(_) => "for AVX2 and FMA",
    };
    let text = format!(
        "fmi2ExitInitializationMode: {modes} modes, {steps}, compiled {machine}, tolerance {tolerance:e}, absolute {error:e} N"
    );
    logger.log(Category::Solver, fmi2OK, &text);
}

/// A communication step, with the counters `before` it.
#[cold]
pub(super) fn step(logger: &Logger, simulation: &Simulation, before: Effort) {
    events(logger, simulation);
    before.report(logger, simulation);
}

/// Its openings and closings.
fn events(logger: &Logger, simulation: &Simulation) {
    let (events, left_out) = simulation.events();
    for event in events {
        let verb = if event.closes { "closes" } else { "opens" };
        let link = simulation.model().links.get(event.link);
        let which = link.map_or("", |link| link.name);
        let text = format!("fmi2DoStep: the {which} {verb} at {} s", number(event.time));
        logger.log(Category::Events, fmi2OK, &text);
    }
    if left_out > 0 {
        let text = format!("fmi2DoStep: {left_out} more openings and closings in this step");
        logger.log(Category::Events, fmi2OK, &text);
    }
}

/// Counters of the integration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    steps: u64,
    rejected: u64,
    iterations: u64,
}

impl Effort {
    pub(super) fn of(simulation: &Simulation) -> Self {
        let state = simulation.state();
        Self {
            steps: state.steps,
            rejected: state.rejected_steps,
            iterations: state.iterations,
        }
    }

    /// Their increase since then.
    fn report(self, logger: &Logger, simulation: &Simulation) {
        let now = Self::of(simulation);
        let text = format!(
            "fmi2DoStep: to {} s: {} steps, {} rejected, {} iterations",
            number(simulation.time()),
            now.steps.saturating_sub(self.steps),
            now.rejected.saturating_sub(self.rejected),
            now.iterations.saturating_sub(self.iterations)
        );
        logger.log(Category::Solver, fmi2OK, &text);
    }
}
