//! The state as modes of the cantilever with the contact, in which a closed linear contact moves exactly, and back.

use crate::beam::mode::{MAX_MODES, ModeStates};
use crate::closed_loop::oscillator::Coordinates;
use crate::closed_loop::system::ClosedLoop;
use crate::model::Model;
use crate::state::State;

/// Sets the displacements of the oscillators, then their velocities.
pub(crate) fn oscillators(closed_loop: &ClosedLoop, model: &Model, state: &State, motion: &mut Coordinates) {
    let count = closed_loop.oscillators.len();
    let modes = state.modes.iter().take(count);
    if state.with_contact {
        let (x, v) = motion.split_at_mut(count);
        for ((x, v), mode) in x.iter_mut().zip(v).zip(modes) {
            (*x, *v) = (mode.q, mode.v);
        }
    } else {
        let mut pairs = [0.0; 2 * MAX_MODES];
        for (pair, mode) in pairs.as_chunks_mut().0.iter_mut().zip(modes) {
            *pair = [mode.q, mode.v];
        }
        *motion = closed_loop.to_oscillators.times(model.simd, &pairs);
    }
}

/// The modes of the cantilever in a state.
pub(crate) fn modes(model: &Model, state: &State) -> ModeStates {
    let mut modes = state.modes;
    if let Some(closed_loop) = model.closed_loop.as_deref().filter(|_| state.with_contact) {
        let mut motion = [0.0; 2 * MAX_MODES];
        oscillators(closed_loop, model, state, &mut motion);
        let pairs = closed_loop.to_modes.times(model.simd, &motion);
        for (mode, [q, v]) in modes.iter_mut().zip(pairs.as_chunks().0) {
            (mode.q, mode.v) = (*q, *v);
        }
    }
    modes
}

/// Makes a state one of the modes of the cantilever.
#[inline(never)]
pub(crate) fn leave(model: &Model, state: &mut State) {
    if state.with_contact {
        state.modes = modes(model, state);
        state.with_contact = false;
    }
}
