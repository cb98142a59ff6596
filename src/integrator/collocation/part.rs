//! The first part of a step that has been computed: the exact motion of the modes under the polynomials of the whole step.
//! A step ends at an event inside it without new coefficients and without another solution for the nodal forces.

use std::array;

use crate::beam::mode::{Mode, ModeState, ModeStates};
use crate::excitation::drive::Drive;
use crate::integrator::collocation::end::{End, NodalModes};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::{Load, Shapes};
use crate::integrator::collocation::side_by_side::Loads;
use crate::integrator::collocation::step::Trial;
use crate::integrator::collocation::tangential::TangentialNodes;
use crate::math::nodal::{Nodal, dot};
use crate::math::prediction::value_and_slope;
use crate::math::simd::{Arithmetic, Separate, compiled_for};
use crate::model::Model;
use crate::state::State;

/// The motion of the tip at an instant inside a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// From the start of the step, s.
    pub(crate) at: f64,
    /// Indentation as deviation from the preload, m.
    pub(crate) d: f64,
    /// Its velocity, m/s.
    pub(crate) rate: f64,
}

/// The motion `at` seconds after the start of a trial of `length` seconds, with the modes in `ends`. `whole`: what the trial
/// has left.
pub(crate) fn motion<const S: usize>(
    model: &Model,
    state: &State,
    drive: &Drive,
    collocation: &Collocation<S>,
    (trial, length, whole): (&Trial<S>, f64, &End<S>),
    at: f64,
    ends: &mut ModeStates,
) -> Instant {
    compiled_for!(model.simd, A =>
        compute::<S, A>(model, state, drive, collocation, (trial, length, whole), at, ends))
}

#[inline(always)]
fn compute<const S: usize, A: Arithmetic>(
    model: &Model,
    state: &State,
    drive: &Drive,
    collocation: &Collocation<S>,
    (trial, length, whole): (&Trial<S>, f64, &End<S>),
    at: f64,
    ends: &mut ModeStates,
) -> Instant {
    let shapes = &collocation.shapes;
    let rows = collocation.nodes.map(|node| collocation.lagrange(node * (at / length)));
    let force = load_on::<S, A>(shapes, &rows, &trial.forces);
    let base = load_on::<S, A>(shapes, &rows, &trial.accelerations);
    if let Some(friction) = model.friction() {
        let along = load_on::<S, A>(shapes, &rows, &whole.tangential.forces);
        let loads = Loads {
            shapes,
            length: at,
            polynomials: [&force, &base, &along],
        };
        let factors = |i: usize, mode: &Mode| {
            let lever = friction.levers.get(i).copied().unwrap_or_default();
            [mode.tip, -mode.participation, lever]
        };
        loads.move_all::<A>(&model.modes, factors, &state.modes, ends);
    } else {
        let loads = Loads {
            shapes,
            length: at,
            polynomials: [&force, &base],
        };
        let factors = |_, mode: &Mode| [mode.tip, -mode.participation];
        loads.move_all::<A>(&model.modes, factors, &state.modes, ends);
    }
    if model.axial().is_some() {
        for ((mode, own), end) in model.modes.iter().zip(&whole.loads).zip(ends.iter_mut()) {
            let loads = Loads {
                shapes,
                length: at,
                polynomials: [&load_on::<S, A>(shapes, &rows, own)],
            };
            let mut by_axial = [ModeState::default()];
            loads.moved::<A, 1>(array::from_ref(mode), &[[1.0]], &[ModeState::default()], &mut by_axial);
            let [ModeState { q, v }] = by_axial;
            (end.q, end.v) = (end.q + q, end.v + v);
        }
    }
    let (mut tip, mut tip_rate) = (0.0, 0.0);
    for (mode, end) in model.modes.iter().zip(ends) {
        tip = A::mul_add(mode.tip, end.q, tip);
        tip_rate = A::mul_add(mode.tip, end.v, tip_rate);
    }
    Instant {
        at,
        d: state.support + drive.support_rate * at - tip,
        rate: drive.support_rate - tip_rate,
    }
}

/// The load of these nodal values up to an instant, at which the Lagrange polynomials take the nodes to `rows`. Not a closure,
/// which may not be inlined and would then be compiled for the generic processor.
#[inline(always)]
fn load_on<const S: usize, A: Arithmetic>(shapes: &Shapes<S>, rows: &[Nodal<S>; S], values: &Nodal<S>) -> Load {
    let mut nodal = [0.0; S];
    for (value, row) in nodal.iter_mut().zip(rows) {
        *value = dot::<S, A>(row, values);
    }
    shapes.load::<A>(&nodal)
}

/// The trial of `length` seconds up to an instant inside it, and what it leaves beside the modes.
pub(crate) fn first_part<const S: usize>(
    model: &Model,
    state: &State,
    drive: &Drive,
    collocation: &Collocation<S>,
    (trial, length, loads, tangential): (&Trial<S>, f64, &mut NodalModes<S>, &mut TangentialNodes<S>),
    end: &Instant,
) -> Trial<S> {
    let nodes = collocation.nodes.map(|node| node * (end.at / length));
    let rows = nodes.map(|x| collocation.lagrange(x));
    let nodal = |values: &Nodal<S>| rows.map(|row| dot::<S, Separate>(&row, values));
    let with_start = |start: f64, values: &Nodal<S>| {
        let polynomial = collocation.through(model.simd, start, values);
        nodes.map(|x| value_and_slope(&polynomial, x - 1.0).0)
    };
    if model.axial().is_some() {
        for load in loads.iter_mut() {
            *load = nodal(load);
        }
    }
    if model.friction().is_some() {
        *tangential = tangential.first_part((collocation, model.simd), state, end.at / length);
    }
    Trial {
        forces: nodal(&trial.forces),
        accelerations: nodal(&trial.accelerations),
        indentations: with_start(state.indentation, &trial.indentations),
        rates: with_start(state.indentation_rate, &trial.rates),
        support: state.support + drive.support_rate * end.at,
        indentation: end.d,
        rate: end.rate,
        force: if state.closed {
            let law = model.law.closed_branch(model.preload.indentation + end.d, end.rate);
            law.force - model.preload.force
        } else {
            trial.force
        },
        ..*trial
    }
}
