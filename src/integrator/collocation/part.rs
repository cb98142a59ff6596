//! The first part of a step that has been computed: the exact motion of the modes under the polynomials of the whole step.
//! A step ends at an event inside it without new coefficients and without another solution for the nodal forces.

use crate::beam::mode::ModeStates;
use crate::excitation::drive::Drive;
use crate::integrator::collocation::axial_force::NodalModes;
use crate::integrator::collocation::modal_response::ModeOverStep;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::{End, Trial};
use crate::integrator::collocation::superposition::Pair;
use crate::integrator::collocation::tangential::TangentialNodes;
use crate::math::free_motion::FreeMotion;
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
    let load = |values: &Nodal<S>| shapes.load::<A>(&rows.map(|row| dot::<S, A>(&row, values)));
    let (force, base) = (load(&trial.forces), load(&trial.accelerations));
    let axial = model.axial().is_some();
    let friction = model
        .friction()
        .map(|friction| (&friction.levers, load(&whole.tangential.forces)));
    let (mut tip, mut tip_rate) = (0.0, 0.0);
    let modes = model.modes.iter().zip(&whole.loads).enumerate();
    for (((i, (mode, own)), start), end) in modes.zip(&state.modes).zip(ends) {
        let free = FreeMotion::new(mode.omega_squared, mode.damping, at);
        let over = ModeOverStep::new(mode.omega_squared, mode.damping, at);
        let by_loads = |by_force: Pair<f64>, by_base: Pair<f64>| {
            let q = mode.tip * by_force.q - mode.participation * by_base.q;
            let v = mode.tip * by_force.v - mode.participation * by_base.v;
            (q, v)
        };
        let (mut q, mut v);
        if let Some((levers, along)) = &friction {
            let [by_force, by_base, by_friction] = over.under::<S, A, 3>(shapes, &free, [&force, &base, along]);
            let lever = levers.get(i).copied().unwrap_or_default();
            (q, v) = by_loads(by_force, by_base);
            (q, v) = (q + lever * by_friction.q, v + lever * by_friction.v);
        } else {
            let [by_force, by_base] = over.under::<S, A, 2>(shapes, &free, [&force, &base]);
            (q, v) = by_loads(by_force, by_base);
        }
        if axial {
            let [by_axial] = over.under::<S, A, 1>(shapes, &free, [&load(own)]);
            (q, v) = (q + by_axial.q, v + by_axial.v);
        }
        end.q = free.q_from_q * start.q + free.q_from_v * start.v + at * at * q;
        end.v = free.v_from_q * start.q + free.v_from_v * start.v + at * v;
        tip = A::mul_add(mode.tip, end.q, tip);
        tip_rate = A::mul_add(mode.tip, end.v, tip_rate);
    }
    Instant {
        at,
        d: state.support + drive.support_rate * at - tip,
        rate: drive.support_rate - tip_rate,
    }
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
        let polynomial = collocation.through(start, values);
        nodes.map(|x| value_and_slope(&polynomial, x - 1.0).0)
    };
    if model.axial().is_some() {
        for load in loads.iter_mut() {
            *load = nodal(load);
        }
    }
    if model.friction().is_some() {
        *tangential = tangential.first_part(collocation, state, end.at / length);
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
