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

/// Steps, rejected steps and iterations so far.
pub(super) fn effort(simulation: &Simulation) -> [u64; 3] {
    let state = simulation.state();
    [state.steps, state.rejected_steps, state.iterations]
}

/// A communication step: its openings and closings, and the increase of the effort since `before`.
#[cold]
pub(super) fn step(logger: &Logger, simulation: &Simulation, before: [u64; 3]) {
    let (events, left_out) = simulation.events();
    for event in events {
        let verb = if event.closes { "closes" } else { "opens" };
        let link = simulation.model().links.get(event.link);
        let which = link.map_or("", |link| link.name);
        let text = format!("fmi2DoStep: the {which} {verb} at {} s", number(event.time));
        logger.log(Category::Events, fmi2OK, &text);
    }
    if let Some(instant) = left_out {
        let text = format!("fmi2DoStep: openings and closings in this step from {} s on are not told", number(instant));
        logger.log(Category::Events, fmi2OK, &text);
    }
    let ([steps, rejected, iterations], time) = (effort(simulation), number(simulation.time()));
    let [steps_before, rejected_before, iterations_before] = before;
    let text = format!(
        "fmi2DoStep: to {time} s: {} steps, {} rejected, {} iterations",
        steps.saturating_sub(steps_before),
        rejected.saturating_sub(rejected_before),
        iterations.saturating_sub(iterations_before)
    );
    logger.log(Category::Solver, fmi2OK, &text);
}
