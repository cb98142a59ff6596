//! A communication step: HEAD
use crate::BARE;
use crate::error::StepError;
use crate::error::StepErrorCause;
use crate::excitation::drive::Drive;
use crate::inputs::Inputs;
use crate::integrator::extremes::Extremes;
use crate::integrator::integration::Steps;
use crate::integrator::motion::Course;
use crate::integrator::step_control::advance;
use crate::integrator::workspace::Budget;
use crate::integrator::workspace::Workspace;
use crate::model::Model;
use crate::state::State;

/// How many of the integrator's steps a communication step has to be long for the integrator to end one with it.
const MANY_STEPS: f64 = 4.0;

/// Advances over the communication step from `time` to `time + size` (s) with inputs that are held or change linearly.
///
/// # Errors
/// A [`StepError`]; the course then stands where it did.
pub fn step(
    model: &Model,
    course: &mut Course,
    workspace: &mut Workspace,
    inputs: &Inputs,
    time: f64,
    size: f64,
) -> Result<(), StepError> {
    if model.scene.effects.extremes && !BARE {
        step_by::<true>(model, course, workspace, inputs, (time, size))
    } else {
        step_by::<false>(model, course, workspace, inputs, (time, size))
    }
}

/// [`step`], with the extremes or without.
fn step_by<const EXTREMES: bool>(
    model: &Model,
    course: &mut Course,
    workspace: &mut Workspace,
    inputs: &Inputs,
    (time, size): (f64, f64),
) -> Result<(), StepError> {
    let until = time + size;
    if !(size > 0.0 && size.is_finite() && until.is_finite()) {
        return Err(StepError {
            time,
            cause: StepErrorCause::StepSize,
        });
    }
    // Where a point comes early by more than the step is long, time stands still.
    let until = until.max(course.time);
    // Lengths that differ by the rounding of time are one, but for exact steps.
    let size = if model.closed_loop.is_none() && (size - course.size).abs() <= f64::EPSILON * until.abs() {
        course.size
    } else {
        size
    };
    let since = course.time;
    workspace.events.forget_until(since);
    // The fixed contact moves linearly to where the input leads.
    let support = inputs.support_displacement_after(size) - model.initial_support;
    let drive = Drive::new(inputs, time, size, support - course.state().support);
    let steady = drive.continues(&course.drive) && model.closed_loop.is_none();
    let ahead = course.time < course.end.time;
    // Nothing is integrated: what is read of the step is computed when it is read.
    let inside = steady && until < course.end.time;
    let mut extremes = (EXTREMES && !inside).then(|| Extremes::at(course.tip(model).force));
    let reach = course.end.short_step.max(course.end.long_step);
    if steady && (ahead || size < reach || size < MANY_STEPS * reach && size != course.size) {
        if !inside {
            let left = until - course.end.time;
            if left < MANY_STEPS * reach {
                go_ahead(model, course, workspace, until, extremes.as_mut())?;
            } else {
                let (mut end, time) = (course.end, course.end.time);
                let steps = Steps::Exactly { time, size: left };
                if let Some(extremes) = &mut extremes {
                    course.add_span(extremes, model, since, time);
                }
                advance(model, &mut end, workspace, course.drive, steps, extremes.as_mut())?;
                end.time = until;
                (course.start, course.end) = (end, end);
            }
        }
    } else {
        let before = ahead.then_some((course.start, course.end));
        if ahead {
            course.end = state(model, course, workspace)?;
            course.start = course.end;
            workspace.events.forget_after(since);
        }
        let steps = Steps::Exactly { time, size };
        if let Err(error) = advance(model, &mut course.end, workspace, drive, steps, extremes.as_mut()) {
            (course.start, course.end) = before.unwrap_or((course.start, course.start));
            workspace.events.forget_after(since);
            return Err(error);
        }
        course.end.support = support;
        course.end.time = until;
        course.start = course.end;
        course.drive = drive;
    }
    course.size = size;
    if EXTREMES {
        course.extremes = extremes;
    }
    course.time = until;
    course.current = inputs.contact_current_after(size);
    course.current_rate = inputs.contact_current_rate;
    Ok(())
}

/// The whole motion at the communication point.
///
/// # Errors
/// A [`StepError`] where it cannot be found.
pub fn state(model: &Model, course: &Course, workspace: &mut Workspace) -> Result<State, StepError> {
    let mut state = *course.state();
    let (time, size) = (state.time, course.time - state.time);
    if size > 0.0 {
        let steps = Steps::Exactly { time, size };
        advance(model, &mut state, workspace, course.drive, steps, None)?;
    }
    Ok(state)
}

/// Advances the integrator by its own steps until it is at `time` (s) or ahead of it. Extremes are those up to the
/// end of the last step that lies before.
fn go_ahead(
    model: &Model,
    course: &mut Course,
    workspace: &mut Workspace,
    time: f64,
    mut extremes: Option<&mut Extremes>,
) -> Result<(), StepError> {
    let since = course.time;
    let mut ahead = *course;
    if let Some(extremes) = &mut extremes
        && since < ahead.end.time
    {
        ahead.add_span(extremes, model, since, ahead.end.time);
        extremes.add(ahead.end.force);
    }
    let budget = Budget::new(workspace, time - since);
    while ahead.end.time < time {
        budget.check(workspace, ahead.end.time)?;
        ahead.start = ahead.end;
        let steps = Steps::Own {
            until: time,
            span: &mut ahead.span,
        };
        advance(model, &mut ahead.end, workspace, ahead.drive, steps, None)?;
        if let Some(extremes) = &mut extremes
            && ahead.end.time <= time
        {
            ahead.add_span(extremes, model, since, ahead.end.time);
            extremes.add(ahead.end.force);
        }
    }
    if ahead.end.time > time && !ahead.span.good {
        ahead.end = ahead.start;
        workspace.events.forget_after(ahead.end.time);
        let (start, size) = (ahead.end.time, time - ahead.end.time);
        let steps = Steps::Exactly { time: start, size };
        advance(model, &mut ahead.end, workspace, ahead.drive, steps, extremes)?;
    }
    *course = ahead;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::Machine;
    use crate::scene::Scene;
    use crate::variables::ExcitationKind;

    /// Contact force after each communication step, N.
    fn forces(scene: &Scene, machine: Machine, size: f64, count: u32) -> Vec<f64> {
        let mut model = Model::new(scene, 0.0).unwrap();
        model.machine = machine;
        let mut course = Course::new(model.initial_state(0.0));
        let mut workspace = Workspace::new(&model);
        (0..count)
            .map(|k| {
                let time = f64::from(k) * size;
                step(&model, &mut course, &mut workspace, &Inputs::default(), time, size).unwrap();
                course.tip(&model).force
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
                let portable = forces(&scene, Machine::Portable, size, count);
                let found = forces(&scene, Machine::detect(), size, count);
                for (k, (a, b)) in portable.iter().zip(&found).enumerate() {
                    // Each of the two is within the tolerance of the exact force.
                    assert!(
                        (a - b).abs() < 2.0 * tolerance * scale,
                        "{amplitude} m/s2, tolerance {tolerance}, step {size}, number {k}: {a} {b}"
                    );
                }
            }
        }
    }
}
