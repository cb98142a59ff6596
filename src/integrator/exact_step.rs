//! The exact step of any length for a linear contact that stays closed ([`crate::closed_loop`]).
//!
//! From step to step the state holds the oscillators of beam and contact together ([`State::with_contact`]); the modes
//! of the cantilever are formed where they are needed.

use crate::beam::mode::MAX_MODES;
use crate::closed_loop::oscillator::Coordinates;
use crate::closed_loop::propagator::Propagator;
use crate::closed_loop::system::{ClosedLoop, Steady};
use crate::contact::law::Law;
use crate::excitation::drive::Drive;
use crate::integrator::constants::{FORCE_ROUNDING, MANY_STEPS, STEP_GROWTH, UNREST};
use crate::integrator::dense_output::{DenseLink, DenseOutput};
use crate::integrator::grid::round_down;
use crate::integrator::step_length::{StepOutcome, growth, shrinkage};
use crate::integrator::with_contact::{leave, oscillators};
use crate::integrator::workspace::Workspace;
use crate::link::CONTACT;
use crate::math::nodal::{LONG, Nodal, dot};
use crate::math::simd::Separate;
use crate::model::Model;
use crate::state::State;

/// Takes `size` seconds from the state's time in one exact step, or several where the generator starts or ends within
/// them.
/// `false`, with the state unchanged, if the motion is not linear or the contact may open.
#[inline(never)]
pub(crate) fn step_exactly(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: &Drive,
    size: f64,
) -> bool {
    let longest = model.scene.solver.maximum_step;
    if model.closed_loop.is_none() || longest > 0.0 && size > longest {
        return false;
    }
    let end = state.time + size;
    let Some(corner) = model.generator.next_break(state.time).filter(|corner| *corner < end) else {
        if !step(model, state, workspace, drive, size) {
            return false;
        }
        state.time = end;
        return true;
    };
    let saved = *state;
    let first = corner - state.time;
    if step(model, state, workspace, drive, first) {
        state.time = corner;
        if step_exactly(model, state, workspace, drive, size - first) {
            state.time = end;
            return true;
        }
    }
    *state = saved;
    false
}

/// [`step_exactly`] to an instant (s).
fn step_until(model: &Model, state: &mut State, workspace: &mut Workspace, drive: &Drive, until: f64) -> bool {
    let done = step_exactly(model, state, workspace, drive, until - state.time);
    if done {
        state.time = until;
    }
    done
}

/// One step of `length` seconds without a start or end of the generator inside; `false`, with the state unchanged, if
/// the contact may open or be interrupted.
fn step(model: &Model, state: &mut State, workspace: &mut Workspace, drive: &Drive, length: f64) -> bool {
    let mut free = [0.0; 2 * MAX_MODES];
    let Some(start) = Start::new(model, state, drive, length, &mut free) else { return false };
    let propagator = workspace.propagators.get(length, |propagator| {
        propagator.fill(length, &start.closed_loop.oscillators, &model.generator);
    });
    propagator.is_some_and(|propagator| start.end(model, state, &free, drive, length, propagator))
}

/// Takes an exact step with dense output, as long as its polynomials are accurate and from the state's time beyond
/// `until` (s); else an exact step to there. Inputs are constant.
/// `false`, with the modes unchanged, if the motion is not linear or the contact may open.
#[inline(never)]
pub(crate) fn step_ahead(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    drive: &Drive,
    (until, dense): (f64, &mut DenseOutput),
) -> bool {
    if model.closed_loop.is_none() {
        return false;
    }
    let allowed = model.tolerance.step.max(FORCE_ROUNDING * model.force_scale);
    let longest = match model.scene.solver.maximum_step {
        0.0 => f64::INFINITY,
        longest => longest,
    };
    let remaining = until - state.time;
    let mut requested = state.lengths.long;
    if remaining >= f64::from(MANY_STEPS) * requested {
        // One with dense output would not come so far.
        return step_until(model, state, workspace, drive, until);
    }
    let mut free = [0.0; 2 * MAX_MODES];
    let Some(start) = Start::new(model, state, drive, requested, &mut free) else { return false };
    loop {
        let mut length = round_down(requested.min(longest));
        let mut time = state.time + length;
        if let Some(corner) = model.generator.next_break(state.time).filter(|corner| *corner < time) {
            (length, time) = (corner - state.time, corner);
        }
        if length < remaining {
            // The next step tries again, as what is not smooth may decay.
            state.lengths.long = requested.max(2.0 * remaining);
            return step_until(model, state, workspace, drive, until);
        }
        let collocation = workspace.long.cache.collocation;
        let propagator = workspace.dense_propagators.get(length, |propagator| {
            propagator.fill(length, start.closed_loop, &model.generator, &collocation.nodes);
        });
        let Some(propagator) = propagator else { return false };
        let [indentations, rates] = start.at_nodes(state, propagator.tip_at_nodes(model.simd, &free, start.phasor));
        let defect = |start: f64, values: &Nodal<LONG>| start - dot::<LONG, Separate>(values, &collocation.at_start);
        let stiffness = start.law.coefficient;
        let contact = state.links[CONTACT];
        let elastic = stiffness * defect(contact.approach, &indentations);
        let force = elastic + stiffness * start.law.damping * defect(contact.rate, &rates);
        let ratio = elastic.abs().max(force.abs()) / allowed;
        if ratio <= 1.0 {
            let indentation = collocation.through(model.simd, contact.approach, &indentations);
            let rate = collocation.through(model.simd, contact.rate, &rates);
            if !start.end(model, state, &free, drive, length, &propagator.whole) {
                return false;
            }
            let damping = stiffness * start.law.damping;
            let mut force = indentation;
            for (force, rate) in force.iter_mut().zip(&rate) {
                *force = stiffness * *force + damping * rate;
            }
            *dense = DenseOutput::default();
            let [contact, ..] = &mut dense.links;
            *contact = DenseLink { force, approach: indentation, rate, ..DenseLink::default() };
            state.time = time;
            state.force_error.add(ratio * allowed, model.force_scale);
            let growth = (growth::<LONG>(ratio), STEP_GROWTH);
            state.lengths.long = StepOutcome::accepted(length, requested, growth).length;
            return true;
        }
        requested = length * shrinkage::<LONG>(ratio);
    }
}

/// What an exact step begins with.
struct Start<'a> {
    closed_loop: &'a ClosedLoop,
    law: Law,
    /// Loads at the start.
    steady: Steady,
    /// Sine and cosine of the generator's phase at the start, times its amplitude.
    phasor: (f64, f64),
}

impl<'a> Start<'a> {
    /// Of a step of `length` seconds, with the motion of the oscillators relative to the particular solution in `free`;
    /// `None` if the motion in it is not linear, as the contact may open or be interrupted.
    fn new(model: &'a Model, state: &State, drive: &Drive, length: f64, free: &mut Coordinates) -> Option<Self> {
        let closed_loop = model.closed_loop.as_deref()?;
        let law = model.law;
        let contact = &state.links[CONTACT];
        if !(contact.closed || law.never_opens()) || state.circuits.is_interrupted(CONTACT) {
            return None;
        }
        let growth = law.coefficient * drive.velocities[0];
        let steady = Steady {
            acceleration: drive.acceleration(state.time),
            jerk: drive.jerk,
            force: law.coefficient * state.displacements[0] + law.damping * growth,
            growth,
        };
        let phasor = model.generator.phasor(state.time);
        // The force must stay above zero, or above the threshold of an interruption.
        let criterion = model.links.first().and_then(|link| link.criterion);
        let least = criterion.map_or(0.0, |criterion| criterion.force);
        let watched = !law.never_opens() || least > 0.0;
        let margin = if watched {
            let steady = closed_loop.least_steady_force(model.preload.force, &steady, phasor, length);
            steady - least
        } else {
            f64::INFINITY
        };
        // Before the transformation of the modes, the dearest part.
        if margin.is_nan() || margin <= 0.0 {
            return None;
        }
        oscillators(closed_loop, model, state, free);
        closed_loop.add_particular(free, &steady, -1.0);
        // Not `>=`, so that NaN does not pass.
        let stays_closed = !watched || closed_loop.swing(free, phasor, margin) < margin;
        stays_closed.then_some(Self { closed_loop, law, steady, phasor })
    }

    /// Indentation and its velocity at the nodes, under constant loads, from the motion of the tip relative to the
    /// particular solution.
    fn at_nodes(&self, state: &State, tip: [Nodal<LONG>; 2]) -> [Nodal<LONG>; 2] {
        let mut particular = [0.0; 2 * MAX_MODES];
        self.closed_loop.add_particular(&mut particular, &self.steady, 1.0);
        let (displacement, velocity) = self.closed_loop.tip_of(&particular);
        let [displacements, velocities] = tip;
        [
            displacements.map(|tip| state.displacements[0] - (tip + displacement)),
            velocities.map(|tip| -(tip + velocity)),
        ]
    }

    /// Moves the state to the end of the step, but for its time; `false`, with the state unchanged, where that is not
    /// finite. `free` is that of [`Start::new`].
    fn end(
        &self,
        model: &Model,
        state: &mut State,
        free: &Coordinates,
        drive: &Drive,
        length: f64,
        propagator: &Propagator,
    ) -> bool {
        let Self { closed_loop, .. } = self;
        let motion = closed_loop.moved(propagator, free, &self.steady.after(length), self.phasor);
        let (tip, tip_rate) = closed_loop.tip_of(&motion);
        let support = state.displacements[0] + drive.velocities[0] * length;
        let (indentation, rate) = (support - tip, drive.velocities[0] - tip_rate);
        if !(indentation.is_finite() && rate.is_finite()) {
            return false;
        }
        let unresolved = closed_loop.resolution.error(&motion.iter().copied());
        state.force_error.note_unresolved(unresolved, model.force_scale);
        let (x, v) = motion.split_at(closed_loop.oscillators.len());
        for (mode, (x, v)) in state.modes.iter_mut().zip(x.iter().zip(v)) {
            (mode.q, mode.v) = (*x, *v);
        }
        state.with_contact = true;
        state.displacements[0] = support;
        state.velocities = drive.velocities;
        let contact = &mut state.links[CONTACT];
        (contact.approach, contact.rate) = (indentation, rate);
        contact.force = model.law.force(model.preload.indentation + indentation, rate);
        state.lengths.last = 0.0;
        state.steps += 1;
        true
    }
}

/// [`leave`] where constant inputs leave so little motion that the contact may be at rest.
#[inline(never)]
pub(crate) fn leave_before_rest(model: &Model, state: &mut State, drive: &Drive) {
    if !state.with_contact || !drive.is_constant() || model.generator.is_active(state.time) {
        return;
    }
    let mut free = [0.0; 2 * MAX_MODES];
    let least = UNREST * model.tolerance.force;
    if let Some(start) = Start::new(model, state, drive, 0.0, &mut free)
        && start.closed_loop.swing(&free, start.phasor, least) <= least
    {
        leave(model, state);
    }
}
