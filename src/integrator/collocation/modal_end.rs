//! The modes at the end of a step: from where they start, and under loads. All of this is done in pairs, as modes are read and written:
//! apart, q and v take twice the instructions.

use crate::beam::mode::{Modal, ModeState};
use crate::integrator::collocation::coefficients::{EndGroup, Pairs};
use crate::math::nodal::{Nodal, add, add_products};
use crate::math::simd::{Arithmetic, LANES};

/// A group of modes.
pub(super) type Group = [ModeState; LANES];

/// Moves modes from the start to the end of a step, without loads.
#[inline(always)]
pub(super) fn move_freely<const S: usize, A: Arithmetic>(
    rows: &[EndGroup<S>],
    starts: &[ModeState],
    ends: &mut [Group],
) {
    for (rows, (start, end)) in rows.iter().zip(starts.as_chunks().0.iter().zip(ends)) {
        let (same, mut other) = (pairs(start), [0.0; 2 * LANES]);
        for (other, start) in other.as_chunks_mut().0.iter_mut().zip(start) {
            *other = [start.v, start.q];
        }
        let mut sum = [0.0; 2 * LANES];
        add_products::<{ 2 * LANES }, A>(&mut sum, &rows.same, &same);
        add_products::<{ 2 * LANES }, A>(&mut sum, &rows.crossed, &other);
        set(end, &sum);
    }
}

/// Adds to modes at the end what a load does that acts on each with its part, and has these nodal values.
#[inline(always)]
pub(super) fn load<const S: usize, A: Arithmetic>(
    rows: &[EndGroup<S>],
    ends: &mut [Group],
    parts: &Modal,
    values: &Nodal<S>,
) {
    for (rows, (end, parts)) in rows.iter().zip(ends.iter_mut().zip(parts.as_chunks().0)) {
        let mut moved = [0.0; 2 * LANES];
        for (value, row) in values.iter().zip(&rows.from_load) {
            add::<{ 2 * LANES }, A>(&mut moved, *value, row);
        }
        let mut sum = pairs(end);
        add_products::<{ 2 * LANES }, A>(&mut sum, &twice(parts), &moved);
        set(end, &sum);
    }
}

/// Adds what loads of their own do to each mode.
#[inline(always)]
pub(super) fn load_each<const S: usize, A: Arithmetic>(rows: &[EndGroup<S>], ends: &mut [Group], loads: &[Nodal<S>]) {
    for (rows, (end, loads)) in rows.iter().zip(ends.iter_mut().zip(loads.chunks(LANES))) {
        let mut sum = pairs(end);
        for (k, row) in rows.from_load.iter().enumerate() {
            let mut load = [0.0; LANES];
            for (load, values) in load.iter_mut().zip(loads) {
                *load = values.get(k).copied().unwrap_or_default();
            }
            add_products::<{ 2 * LANES }, A>(&mut sum, row, &twice(&load));
        }
        set(end, &sum);
    }
}

/// The values of a group.
#[inline(always)]
pub(super) fn pairs(modes: &Group) -> Pairs {
    let mut pairs = [0.0; 2 * LANES];
    for (pair, mode) in pairs.as_chunks_mut().0.iter_mut().zip(modes) {
        *pair = [mode.q, mode.v];
    }
    pairs
}

/// Sets the values of a group.
#[inline(always)]
fn set(modes: &mut Group, pairs: &Pairs) {
    for (mode, [q, v]) in modes.iter_mut().zip(pairs.as_chunks().0) {
        (mode.q, mode.v) = (*q, *v);
    }
}

/// The value of each mode for its q and for its v.
#[inline(always)]
pub(super) fn twice(values: &[f64; LANES]) -> Pairs {
    let mut pairs = [0.0; 2 * LANES];
    for (pair, value) in pairs.as_chunks_mut().0.iter_mut().zip(values) {
        *pair = [*value; 2];
    }
    pairs
}
