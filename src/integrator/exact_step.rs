//! The exact step of any length for a linear contact that stays closed ([`crate::closed_loop`]).

use crate::beam::mode::MAX_MODES;
use crate::closed_loop::oscillator::Coordinates;
use crate::closed_loop::propagator::Propagators;
use crate::closed_loop::system::{ClosedLoop, Steady};
use crate::contact::law::Law;
use crate::contact::linear::Linear;
use crate::excitation::drive::Drive;
use crate::model::Model;
use crate::state::State;

/// Takes `size` seconds from the state's time in one exact step, or several where the generator starts or ends within
/// them.
/// `false`, with the state unchanged, if the motion is not linear or the contact may open.
pub(crate) fn step_exactly(
    model: &Model,
    state: &mut State,
    propagators: &mut Propagators,
    drive: &Drive,
    size: f64,
) -> bool {
    let (Some(closed_loop), Law::Linear(law)) = (&model.closed_loop, &model.law) else {
        return false;
    };
    let longest = model.scene.solver.maximum_step;
    if !(state.closed || law.bonded) || (longest > 0.0 && size > longest) {
        return false;
    }
    let end = state.time + size;
    let Some(corner) = model.generator.next_break(state.time).filter(|corner| *corner < end) else {
        if !advance(closed_loop, model, state, propagators, drive, size) {
            return false;
        }
        state.time = end;
        return true;
    };
    let saved = *state;
    let first = corner - state.time;
    if advance(closed_loop, model, state, propagators, drive, first) {
        state.time = corner;
        if step_exactly(model, state, propagators, drive, size - first) {
            state.time = end;
            return true;
        }
    }
    *state = saved;
    false
}

/// One step of `length` seconds without a start or end of the generator inside; `false`, with the state unchanged, if
/// the contact may open or be interrupted.
fn advance(
    closed_loop: &ClosedLoop,
    model: &Model,
    state: &mut State,
    propagators: &mut Propagators,
    drive: &Drive,
    length: f64,
) -> bool {
    let Linear { stiffness, damping, .. } = closed_loop.contact;
    let count = closed_loop.oscillators.len();
    let mut motion = [0.0; 2 * MAX_MODES];
    for (pair, mode) in motion.chunks_exact_mut(2).zip(state.modes.iter().take(count)) {
        if let [q, v] = pair {
            (*q, *v) = (mode.q, mode.v);
        }
    }
    let growth = stiffness * drive.support_rate;
    let steady = Steady {
        acceleration: drive.acceleration(state.time),
        jerk: drive.jerk,
        force: stiffness * state.support + damping * growth,
        growth,
    };
    let free = closed_loop.free_motion(model.simd, &motion, &steady);
    let phasor = model.generator.phasor(state.time);
    if state.interruptions.in_progress() {
        return false;
    }
    // The force must stay above zero, or above the threshold of an interruption.
    let least = model.criterion.map_or(0.0, |criterion| criterion.force);
    let watched = !model.law.never_opens() || least > 0.0;
    if watched && least >= closed_loop.least_force(model.preload.force, &free, &steady, phasor, length) {
        return false;
    }
    let Some(propagator) = propagators.over(length, &closed_loop.oscillators, &model.generator) else {
        return false;
    };
    let motion: Coordinates = closed_loop.moved(model.simd, propagator, &free, &steady.after(length), phasor);

    let support = state.support + drive.support_rate * length;
    let (mut indentation, mut rate) = (support, drive.support_rate);
    for (pair, mode) in motion.chunks_exact(2).zip(&model.modes) {
        if let [q, v] = pair {
            indentation -= mode.tip * q;
            rate -= mode.tip * v;
        }
    }
    if !(indentation.is_finite() && rate.is_finite()) {
        return false;
    }
    for (mode, pair) in state.modes.iter_mut().zip(motion.chunks_exact(2)).take(count) {
        if let [q, v] = pair {
            (mode.q, mode.v) = (*q, *v);
        }
    }
    state.support = support;
    state.support_rate = drive.support_rate;
    state.indentation = indentation;
    state.indentation_rate = rate;
    state.force = model.law.force(model.preload.indentation + indentation, rate);
    state.last_step = 0.0;
    state.steps += 1;
    true
}
