//! A communication step: integrated exactly to its end, or read from the dense output of a longer integration step
//! ([`crate::integrator::motion`]).

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::inputs::Inputs;
use crate::integrator::constants::{COARSEST, MANY_STEPS};
use crate::integrator::exact_step;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::Grid;
use crate::integrator::motion::Motion;
use crate::integrator::recorder::Recorder;
use crate::integrator::rest::rests_until;
use crate::integrator::stepper::{Stepper, resolution};
use crate::integrator::workspace::Workspace;
use crate::link::Ways;
use crate::model::Model;
use crate::state::State;
use crate::variables::RealInput;

/// Integrates from the start of a grid, which has no step behind it, exactly to its end. `driven`: an input is another one than before.
///
/// # Errors
/// A [`StepError`]; the state is then undefined.
pub(crate) fn advance(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: Drive,
    grid: Grid,
    driven: bool,
    extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    exact_step::leave_before_rest(model, state, &drive);
    state.time = rests_until(model, state, &drive, grid.end()).unwrap_or(grid.start);
    let remaining = grid.size - (state.time - grid.start);
    if remaining <= 0.0 {
        return Ok(());
    }
    check_spacing(model, state.time, remaining)?;
    if exact_step::step_exactly(model, state, workspace, &drive, remaining) {
        return Ok(());
    }
    let grid = Grid { recurs: grid.recurs, ..Grid::over(state.time, remaining) };
    // A blow would make more of an error than it is here.
    let never_opened = state.is_closed() && !state.has_switched();
    let recorder = Recorder { extremes, ..Recorder::default() };
    Stepper::new(model, state, workspace, drive, grid, recorder).run(driven && never_opened)
}

/// Takes one step as long as the error allows, from the end of the motion. Where it goes beyond `until` (s), its dense output is within
/// the tolerance from there on.
///
/// # Errors
/// A [`StepError`]; the motion is then undefined.
fn step_freely(model: &Model, motion: &mut Motion, workspace: &mut Workspace, until: f64) -> Result<(), StepError> {
    let Motion { start, end, dense, drive, .. } = motion;
    start.copy(end, model.modes.len(), model.links.len());
    let size = end.lengths.own();
    check_spacing(model, end.time, size)?;
    if !exact_step::step_ahead(model, end, workspace, drive, (until, &mut *dense)) {
        let grid = Grid::free(end.time, size);
        let recorder = Recorder { read: Some(until), dense: Some(dense), start: Some(start), extremes: None };
        Stepper::new(model, end, workspace, *drive, grid, recorder).run(false)?;
    }
    if motion.length() <= 0.0 {
        motion.start = motion.end;
    }
    Ok(())
}

/// Checks that floating-point numbers of time lie close enough for the motion from `time` (s) over `size` (s).
///
/// # Errors
/// [`StepErrorCause::Resolution`] if they do not.
fn check_spacing(model: &Model, time: f64, size: f64) -> Result<(), StepError> {
    let allowed = COARSEST * model.first_step(time);
    let spacing = resolution(time, size);
    let cause = StepErrorCause::Resolution { spacing, allowed };
    let fits = spacing <= allowed;
    fits.then_some(()).ok_or(StepError { time, cause })
}

/// Advances over the communication step from `time` to `time + size` (s) with inputs that are held or change linearly.
///
/// # Errors
/// A [`StepError`]; the motion is then unchanged.
pub fn step(
    model: &Model,
    motion: &mut Motion,
    workspace: &mut Workspace,
    inputs: &Inputs,
    time: f64,
    size: f64,
) -> Result<(), StepError> {
    check_size(time, size)?;
    let until = time + size;
    // An importer's rounded time may put the end before the point already reached: no time passes then.
    let until = until.max(motion.time);
    // Step sizes that differ by the rounding of time count as equal, except for exact linear steps. The first has none before it.
    let is_repeated = motion.size > 0.0 && (size - motion.size).abs() <= f64::EPSILON * until.abs();
    let size = if model.closed_loop.is_none() && is_repeated { motion.size } else { size };
    let since = motion.time;
    workspace.events.forget_until(since);
    workspace.search.work = 0;
    // The fixed contacts move at constant velocity to their positions at the end of the step.
    let displacements = displaced(model, inputs, time, size)?;
    let rates = felt(model, Inputs::MOVING.map(|input| inputs.rate(input)));
    let next = motion.drive.next(inputs, (time, size), (motion.displacements(), displacements), rates);
    // An exact step ahead has constant inputs.
    let steady = next.is_none() && (model.closed_loop.is_none() || motion.drive.is_constant());
    let mut extremes = model.scene.effects.extremes.then(|| motion.extremes_now(model));
    if steady && until < motion.end.time {
        // The end lies inside the current integration step: nothing to integrate, outputs come from its dense output.
        if let Some(extremes) = &mut extremes {
            motion.add_dense(extremes, model, since, until);
        }
    } else if steady {
        workspace.former.copy(model, motion);
        step_ahead(model, motion, workspace, until, extremes.as_mut()).inspect_err(|_| {
            motion.copy(model, &workspace.former);
            workspace.events.forget_after(motion.end.time);
        })?;
    } else {
        let drive = next.unwrap_or(motion.drive);
        // It is all that changes until the step is done.
        let (modes, links) = (model.modes.len(), model.links.len());
        workspace.former.end.copy(&motion.end, modes, links);
        let ahead = motion.time < motion.end.time;
        let gone_back = if ahead { go_back(model, motion, workspace) } else { Ok(()) };
        // One after a time without changes is none that recurs.
        let driven = !ahead && motion.size > 0.0;
        let grid = Grid { recurs: !driven || size == motion.size, ..Grid::over(time, size) };
        let done =
            gone_back.and_then(|()| advance(model, &mut motion.end, workspace, drive, grid, driven, extremes.as_mut()));
        done.inspect_err(|_| {
            motion.end.copy(&workspace.former.end, modes, links);
            workspace.events.replace_after(since, motion.events_ahead());
        })?;
        (motion.end.displacements, motion.end.time) = (displacements, until);
        motion.start = motion.end;
        motion.drive = drive;
    }
    motion.size = size;
    motion.extremes = extremes;
    motion.time = until;
    motion.current = inputs.after(RealInput::ContactCurrent, size);
    motion.current_rate = inputs.contact_current_rate;
    Ok(())
}

/// Checks that a communication step from `time` over `size` (s) can be taken.
///
/// # Errors
/// [`StepErrorCause::StepSize`] or [`StepErrorCause::Resolution`] where it cannot.
fn check_size(time: f64, size: f64) -> Result<(), StepError> {
    let until = time + size;
    let cause = if !(size > 0.0 && size.is_finite() && until.is_finite()) {
        StepErrorCause::StepSize
    } else if until == time {
        let (spacing, allowed) = (f64::EPSILON * time.abs(), size);
        StepErrorCause::Resolution { spacing, allowed }
    } else {
        return Ok(());
    };
    Err(StepError { time, cause })
}

/// Takes the motion back from the end of a step beyond the communication point to that point: integrated again, under the former
/// inputs.
///
/// # Errors
/// A [`StepError`] where that fails.
fn go_back(model: &Model, motion: &mut Motion, workspace: &mut Workspace) -> Result<(), StepError> {
    motion.end = motion.start;
    let until = motion.time;
    go_on(model, &mut motion.end, workspace, motion.drive, until)?;
    workspace.events.forget_after(until);
    Ok(())
}

/// Displacements of the inputs since the preload after a communication step of `size` seconds from `time` (s), m.
///
/// # Errors
/// [`StepErrorCause::NoRoom`] where the second fixed contact would reach the first.
fn displaced(model: &Model, inputs: &Inputs, time: f64, size: f64) -> Result<Ways, StepError> {
    let [support, second, pusher] = inputs.displacements_after(size);
    let initial = model.initial.displacements;
    let displacements = felt(model, [support - initial[0], second, pusher - initial[2]]);
    let [_, second, _] = displacements;
    let room = model.room(second);
    let (displacement, limit) = (second, second + room);
    let cause = StepErrorCause::NoRoom { displacement, limit };
    (room > 0.0).then_some(displacements).ok_or(StepError { time, cause })
}

/// What the model feels of ways (m), or velocities (m/s), of the inputs that move bodies.
fn felt(model: &Model, [support, second, pusher]: Ways) -> Ways {
    let prescribed = model.roles.pusher.is_some() && model.roles.core.is_none();
    [support, if model.roles.second.is_some() { second } else { 0.0 }, if prescribed { pusher } else { 0.0 }]
}

/// The state at the communication point, by a step from the start of the integration step around it.
///
/// # Errors
/// A [`StepError`] where that step fails.
pub fn state(model: &Model, motion: &Motion, workspace: &mut Workspace) -> Result<State, StepError> {
    let mut state = *motion.state();
    workspace.search.work = 0;
    go_on(model, &mut state, workspace, motion.drive, motion.time)?;
    Ok(state)
}

/// Integrates on to the instant `until` (s), if that is later.
///
/// # Errors
/// A [`StepError`]; the state is then undefined.
fn go_on(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: Drive,
    until: f64,
) -> Result<(), StepError> {
    let (time, size) = (state.time, until - state.time);
    if size <= 0.0 {
        return Ok(());
    }
    let grid = Grid { recurs: false, ..Grid::over(time, size) };
    advance(model, state, workspace, drive, grid, false, None)
}

/// Takes integration steps of the integrator's own choice until one reaches `time` (s) or beyond. `extremes` covers the
/// communication step.
///
/// # Errors
/// A [`StepError`]; the motion is then undefined.
fn step_ahead(
    model: &Model,
    motion: &mut Motion,
    workspace: &mut Workspace,
    time: f64,
    mut extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    let since = motion.time;
    let mut note = |motion: &Motion| {
        if let Some(extremes) = &mut extremes {
            motion.add_dense(extremes, model, since, time.min(motion.end.time));
            if motion.end.time <= time {
                for (index, link) in motion.end.links.iter().take(model.links.len()).enumerate() {
                    extremes.of(index).add(link.force);
                }
            }
        }
    };
    if since < motion.end.time {
        note(motion);
    }
    while motion.end.time < time {
        workspace.search.check(motion.end.time)?;
        if time - motion.end.time >= f64::from(MANY_STEPS) * motion.end.lengths.own()
            && let Some(until) = rests_until(model, &motion.end, &motion.drive, time)
        {
            motion.end.time = until;
            motion.start = motion.end;
            continue;
        }
        step_freely(model, motion, workspace, time)?;
        note(motion);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::CONTACT;
    use crate::math::simd::Simd;
    use crate::scene::Scene;
    use crate::variables::ExcitationKind;

    /// Contact force after each communication step, N.
    fn forces(scene: &Scene, simd: Simd, size: f64, count: u32) -> Vec<f64> {
        let mut model = Model::new(scene, 0.0).unwrap();
        model.simd = simd;
        let mut motion = Motion::new(model.initial_state(0.0));
        let mut workspace = Workspace::new(&model);
        (0..count)
            .map(|k| {
                let time = f64::from(k) * size;
                step(&model, &mut motion, &mut workspace, &Inputs::default(), time, size).unwrap();
                motion.link(&model, CONTACT).force
            })
            .collect()
    }

    #[test]
    fn both_compilations_agree_within_the_tolerance() {
        for (amplitude, tolerance) in [(98.0, 1e-4), (98.0, 1e-9), (400.0, 1e-4), (400.0, 1e-6)] {
            let mut scene = Scene::default();
            scene.effects.excitation = ExcitationKind::Sine;
            scene.excitation.amplitude = amplitude;
            scene.solver.tolerance = tolerance;
            let scale = Model::new(&scene, 0.0).unwrap().force_scale;
            for (size, count) in [(1e-6, 2000), (7e-5, 40), (1e-3, 3)] {
                let portable = forces(&scene, Simd::Portable, size, count);
                let found = forces(&scene, Simd::detect(), size, count);
                for (k, (a, b)) in portable.iter().zip(&found).enumerate() {
                    // Each of the two is within the tolerance of the exact force, hence twice the tolerance.
                    assert!(
                        (a - b).abs() < 2.0 * tolerance * scale,
                        "{amplitude} m/s2, tolerance {tolerance}, step {size}, number {k}: {a} {b}"
                    );
                }
            }
        }
    }
}
