//! A communication step: integrated exactly to its end, or read from the dense output of a longer integration step
//! ([`crate::integrator::motion`]).

use crate::error::{StepError, StepErrorCause};
use crate::excitation::drive::Drive;
use crate::inputs::Inputs;
use crate::integrator::constants::{COARSEST, MANY_STEPS};
use crate::integrator::dense_output::DenseOutput;
use crate::integrator::energy::conservation::conserves;
use crate::integrator::exact_step;
use crate::integrator::extremes::Extremes;
use crate::integrator::grid::Grid;
use crate::integrator::motion::Motion;
use crate::integrator::recorder::Recorder;
use crate::integrator::rest::rests_until;
use crate::integrator::stepper::{Progress, Stepper, resolution};
use crate::integrator::with_contact;
use crate::integrator::workspace::{Budget, Workspace};
use crate::link::Ways;
use crate::model::Model;
use crate::state::State;
use crate::variables::RealInput;

/// How far to advance.
#[derive(Debug)]
pub(crate) enum Steps<'a> {
    /// From `time` exactly to `time + size`.
    Exactly {
        /// s.
        time: f64,
        /// s.
        size: f64,
        /// Whether such a size is expected again.
        recurs: bool,
        /// Whether an input is another one than before.
        driven: bool,
    },
    /// By one step as long as the error allows, with dense output.
    Own {
        /// Dense output is read from here on where the step goes beyond it, within the tolerance, s.
        until: f64,
        /// The links during the step.
        dense: &'a mut DenseOutput,
        /// The state at its start, to which events are added that happen there.
        start: &'a mut State,
    },
}

/// Advances the state.
///
/// # Errors
/// A [`StepError`]; the state is then undefined.
pub(crate) fn advance(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: Drive,
    steps: Steps,
    extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    let mut recorder = Recorder { extremes, ..Recorder::default() };
    let (grid, driven) = match steps {
        Steps::Exactly { time, size, recurs, driven } => {
            exact_step::leave_before_rest(model, state, &drive);
            state.time = rests_until(model, state, &drive, time + size).unwrap_or(time);
            let remaining = size - (state.time - time);
            if remaining <= 0.0 {
                return Ok(());
            }
            check_spacing(model, state.time, remaining)?;
            if exact_step::step_exactly(model, state, workspace, &drive, remaining) {
                return Ok(());
            }
            let grid = Grid { recurs, ..Grid::over(state.time, remaining) };
            // A blow would make more of an error than it is here.
            let never_opened = state.is_closed() && !state.has_switched();
            (grid, driven && never_opened)
        }
        Steps::Own { until, dense, start } => {
            let size = state.lengths.own();
            check_spacing(model, state.time, size)?;
            if exact_step::step_ahead(model, state, workspace, &drive, (until, &mut *dense)) {
                return Ok(());
            }
            (recorder.read, recorder.dense, recorder.start) = (Some(until), Some(dense), Some(start));
            (Grid::free(state.time, size), false)
        }
    };
    with_contact::leave(model, state);
    let conserves = conserves(model, &drive);
    Stepper {
        model,
        state,
        budget: Budget::new(workspace),
        workspace,
        drive,
        grid,
        recorder,
        progress: Progress {
            // Without any damping errors add up over the more steps that this takes.
            driven: driven && !conserves,
            conserves,
            ..Progress::default()
        },
    }
    .run()
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
    if model.scene.effects.extremes {
        step_by::<true>(model, motion, workspace, inputs, (time, size))
    } else {
        step_by::<false>(model, motion, workspace, inputs, (time, size))
    }
}

/// [`step`], compiled with and without the extremes.
fn step_by<const EXTREMES: bool>(
    model: &Model,
    motion: &mut Motion,
    workspace: &mut Workspace,
    inputs: &Inputs,
    (time, size): (f64, f64),
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
    // The fixed contacts move at constant velocity to their positions at the end of the step.
    let displacements = displaced(model, inputs, time, size)?;
    let drive = Drive::new(inputs, time, size, motion.ways(displacements));
    let steady = drive.continues(&motion.drive);
    let drive = if steady { motion.drive } else { drive };
    let ahead = motion.time < motion.end.time;
    // The end lies inside the current integration step: nothing to integrate, outputs come from its dense output.
    let inside = steady && until < motion.end.time;
    let mut extremes = EXTREMES.then(|| motion.extremes_now(model));
    if inside {
        if let Some(extremes) = &mut extremes {
            motion.add_dense(extremes, model, since, until);
        }
    } else if steady {
        go_ahead(model, motion, workspace, until, extremes.as_mut())?;
    } else {
        workspace.former.end = motion.end;
        let gone_back = if ahead { go_back(model, motion, workspace) } else { Ok(()) };
        // One after a time without changes is none that recurs.
        let driven = !ahead && motion.size > 0.0;
        let steps = Steps::Exactly { time, size, recurs: !driven || size == motion.size, driven };
        let done = gone_back.and_then(|()| advance(model, &mut motion.end, workspace, drive, steps, extremes.as_mut()));
        done.inspect_err(|_| {
            motion.end = workspace.former.end;
            workspace.events.replace_after(since, motion.events_ahead());
        })?;
        (motion.end.displacements, motion.end.time) = (displacements, until);
        motion.start = motion.end;
        motion.drive = drive;
    }
    motion.size = size;
    if EXTREMES {
        motion.extremes = extremes;
    }
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
    let present = |link: Option<usize>, displacement: f64| link.map_or(0.0, |_| displacement);
    let prescribed = model.roles.pusher.filter(|_| model.roles.core.is_none());
    let second = present(model.roles.second, second);
    let room = model.room(second);
    let (displacement, limit) = (second, second + room);
    let cause = StepErrorCause::NoRoom { displacement, limit };
    let displacements = [support - initial[0], second, present(prescribed, pusher - initial[2])];
    (room > 0.0).then_some(displacements).ok_or(StepError { time, cause })
}

/// The state at the communication point, by a step from the start of the integration step around it.
///
/// # Errors
/// A [`StepError`] where that step fails.
pub fn state(model: &Model, motion: &Motion, workspace: &mut Workspace) -> Result<State, StepError> {
    let mut state = *motion.state();
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
    let steps = Steps::Exactly { time, size, recurs: false, driven: false };
    advance(model, state, workspace, drive, steps, None)
}

/// Takes integration steps of the integrator's own choice until one reaches `time` (s) or beyond. `extremes` covers the
/// communication step.
///
/// # Errors
/// A [`StepError`]; the motion is then unchanged.
fn go_ahead(
    model: &Model,
    motion: &mut Motion,
    workspace: &mut Workspace,
    time: f64,
    extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    if time <= motion.end.time {
        // Without a step nothing can fail.
        return take_steps(model, motion, workspace, time, extremes);
    }
    // One after the other: together they would lie on the stack in between.
    let former = &mut *workspace.former;
    let (modes, links) = (model.modes.len(), model.links.len());
    former.start.copy(&motion.start, modes, links);
    former.end.copy(&motion.end, modes, links);
    former.dense.copy(&motion.dense, links);
    take_steps(model, motion, workspace, time, extremes).inspect_err(|_| {
        let former = &*workspace.former;
        motion.start = former.start;
        motion.end = former.end;
        motion.dense.copy(&former.dense, links);
        workspace.events.forget_after(motion.end.time);
    })
}

/// See [`go_ahead`].
///
/// # Errors
/// A [`StepError`]; the motion is then undefined.
fn take_steps(
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
    let budget = Budget::new(workspace);
    while motion.end.time < time {
        budget.check(&workspace.search, motion.end.time)?;
        if time - motion.end.time >= f64::from(MANY_STEPS) * motion.end.lengths.own()
            && let Some(until) = rests_until(model, &motion.end, &motion.drive, time)
        {
            motion.end.time = until;
            motion.start = motion.end;
            continue;
        }
        let Motion { start, end, dense, drive, .. } = motion;
        start.copy(end, model.modes.len(), model.links.len());
        let until = time;
        let steps = Steps::Own { until, dense, start };
        advance(model, end, workspace, *drive, steps, None)?;
        if motion.length() <= 0.0 {
            motion.start = motion.end;
        }
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
