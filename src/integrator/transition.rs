//! What an event makes of the state: contacts open and close, slip begins and ends, fixed contacts change their velocity.

use crate::contact::friction::Phase;
use crate::excitation::drive::Drive;
use crate::integrator::constants::{LEAST_SHRINK, WORTH};
use crate::integrator::events::log::{self, Events};
use crate::link::{CONTACT, LinkLaw};
use crate::model::Model;
use crate::state::State;

/// Opens or closes a contact at the instant of the state. Short steps begin anew.
pub(crate) fn switch(model: &Model, state: &mut State, index: usize, log: &mut Events) {
    let (Some(link), Some(port), time) = (model.links.get(index), model.port_of(index), state.time) else { return };
    if let Some(law) = link.contact() {
        state.force_error.keep((law.firm, law.damping), port, model.force_scale);
    }
    state.force_error.begin(&model.modes, port);
    let Some(at) = state.links.get_mut(index) else { return };
    at.closed = !at.closed;
    let (closed, rate) = (at.closed, at.rate);
    log.record(log::Event { time, closes: closed, link: index });
    let touch = link.contact().filter(|_| closed);
    at.force = touch.map_or(0.0, |law| law.force_at_touch(at.rate));
    if at.force > 0.0 {
        state.force_error.jump(&model.modes, port, at.force / at.rate);
    }
    if closed {
        at.last_closing = Some(time);
        state.last_kink = time;
        state.kink_is_closing = true;
    } else {
        at.last_opening = Some(time);
    }
    state.lengths.last = 0.0;
    state.lengths.short = if closed { first_closed_step(model, state, index) } else { step_after_jump(model, state) };
    if let Some((rubbing, _)) = model.friction().filter(|_| closed && index == CONTACT) {
        let along = state.links.get(rubbing).map_or(0.0, |along| -along.rate);
        state.force_error.hold(port, along / rate);
    }
    model.settle_friction(state);
}

/// Begins or ends slip at the instant of the state. The slope of the friction force jumps, and the spring answers as
/// steeply as its highest modes do: the next step is as long as the last one after such a change.
pub(crate) fn slide(model: &Model, state: &mut State, phase: Phase) {
    model.change_phase(state, phase);
    let first = *state.lengths.after_change(phase);
    let length = if first > 0.0 { first } else { step_after_jump(model, state) };
    state.lengths.long = state.lengths.long.min(length);
    state.lengths.short = state.lengths.short.min(length / WORTH);
}

/// Applies jumps of the velocities of the fixed contacts, with which dissipative forces jump.
pub(crate) fn set_velocities(model: &Model, state: &mut State, drive: &Drive, log: &mut Events) {
    let mut jumps = drive.velocities;
    for (jump, before) in jumps.iter_mut().zip(&state.velocities) {
        *jump -= before;
    }
    if jumps.iter().all(|jump| *jump == 0.0) {
        return;
    }
    state.velocities = drive.velocities;
    for (index, link) in model.links.iter().enumerate() {
        let Some(at) = state.links.get_mut(index) else { continue };
        let jump = link.offset(&jumps);
        at.rate += jump;
        if jump == 0.0 || link.contact().is_none() {
            continue;
        }
        let (force, closed) = (link.force_at(at.approach, at.rate), link.engagement(at.approach, at.rate) > 0.0);
        if closed != at.closed {
            switch(model, state, index, log);
        }
        if let Some(at) = state.links.get_mut(index) {
            at.force = force;
        }
        model.settle_friction(state);
        restart(model, state, index);
    }
}

/// Sets the current of the coil, with which the force of the magnet jumps.
pub(crate) fn set_coil(model: &Model, state: &mut State, coil: f64) {
    if state.coil == coil {
        return;
    }
    state.coil = coil;
    for (index, link) in model.links.iter().enumerate() {
        if let (LinkLaw::Magnet(magnet), Some(at)) = (&link.law, state.links.get_mut(index)) {
            at.force = magnet.force(link.approach + at.approach, coil).0;
            restart(model, state, index);
        }
    }
}

/// Steps begin anew as the force of a link has jumped.
fn restart(model: &Model, state: &mut State, index: usize) {
    (state.last_kink, state.kink_is_closing) =
        (state.time, state.links.iter().any(|link| link.last_closing == Some(state.time)));
    state.lengths.last = 0.0;
    let next = first_closed_step(model, state, index);
    let lengths = &mut state.lengths;
    (lengths.short, lengths.long) = (lengths.short.min(next), lengths.long.min(next));
}

/// First step after an acceleration has jumped or bent, s.
pub(crate) fn step_after_jump(model: &Model, state: &State) -> f64 {
    LEAST_SHRINK * model.first_step(state.time)
}

/// First step after closing, s. The dissipative force starts as the square root of time, which no polynomial
/// approximates well: the step is so short that its error moves the force by less than the error allowed per step.
fn first_closed_step(model: &Model, state: &State, index: usize) -> f64 {
    let mut h = model.first_step(state.time);
    let (Some(link), Some(at)) = (model.links.get(index), state.links.get(index)) else { return h };
    let (Some(law), Some(port)) = (link.contact(), model.port_of(index)) else { return h };
    let (d, speed) = (link.approach + at.approach, at.rate.abs());
    for _ in 0..40 {
        let branch = law.closed_branch(d + speed * h, at.rate);
        let gain = port.mobility * h * (branch.damping + 0.5 * h * branch.stiffness.abs());
        if 0.1 * (branch.force - at.force).abs() * gain / (1.0 + gain) <= model.tolerance.step {
            break;
        }
        h *= 0.5;
    }
    h
}
