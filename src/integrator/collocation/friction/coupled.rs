//! Newton's method for contact force and friction force at the nodes.

use crate::friction::Friction;
use crate::integrator::collocation::friction::motion::{Motion, Unforced};
use crate::integrator::collocation::newton::solve;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{ITERATIONS, MOTION_ROUNDING};
use crate::math::nodal::{LONG, Nodal, greatest};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// Contact forces and friction forces at the nodes, one after the other; the rest is zero.
pub(super) type Both = [f64; 2 * LONG];

/// What the laws answer to a motion at the nodes: derivatives of both forces.
#[derive(Clone, Copy)]
pub(super) struct Laws<const S: usize> {
    pub(super) stiffness: Nodal<S>,
    pub(super) damping: Nodal<S>,
    /// Of the friction force while it sticks, by indentation (with opposite sign), displacement and velocity.
    pub(super) by_d: Nodal<S>,
    pub(super) by_v: Nodal<S>,
    pub(super) by_rate: Nodal<S>,
    /// Of the friction force by the contact force while it slips.
    pub(super) share: f64,
}

/// The nodal forces of a step.
pub(super) struct Coupled<const S: usize> {
    pub(super) forces: Nodal<S>,
    pub(super) tangential: Nodal<S>,
    pub(super) iterations: u64,
    pub(super) laws: Laws<S>,
    /// Both per unit defect at the start: of contact force, friction force and base acceleration.
    pub(super) by_defect: [Both; 3],
}

impl<const S: usize> Laws<S> {
    /// Change of both forces by a motion.
    #[inline(always)]
    fn answer(&self, motion: &Motion<S>) -> Both {
        let mut both = [0.0; 2 * LONG];
        let (first, second) = both.split_at_mut(S);
        let normal = self.stiffness.iter().zip(&self.damping);
        for (((answer, (k, c)), d), rate) in first.iter_mut().zip(normal).zip(&motion.d).zip(&motion.d_rate) {
            *answer = k * d + c * rate;
        }
        let along = self.by_d.iter().zip(&self.by_v).zip(&self.by_rate);
        let moved = motion.d.iter().zip(&motion.v).zip(&motion.v_rate);
        for ((answer, ((by_d, by_v), by_rate)), ((d, v), rate)) in second.iter_mut().zip(along).zip(moved) {
            *answer = by_d * d + by_v * v + by_rate * rate;
        }
        both
    }

    /// Derivatives of the residuals with respect to each nodal force, by columns.
    #[inline(always)]
    fn jacobian(&self, unforced: &Unforced<S>) -> [Both; 2 * LONG] {
        let mut jacobian = [[0.0; 2 * LONG]; 2 * LONG];
        for (j, (column, moved)) in jacobian.iter_mut().zip(unforced.by_nodes()).enumerate() {
            for (entry, answer) in column.iter_mut().zip(self.answer(&moved)) {
                *entry = -answer;
            }
            column.iter_mut().skip(j).take(1).for_each(|entry| *entry += 1.0);
            let slip = column.iter_mut().skip(S + j).take(usize::from(j < S));
            slip.for_each(|entry| *entry -= self.share);
        }
        jacobian
    }
}

/// Friction forces at the nodes while the contact sticks, extrapolated from the last step.
#[inline(always)]
fn predicted_loads<const S: usize, A: Arithmetic>(
    state: &State,
    length: f64,
    collocation: &Collocation<S>,
) -> Nodal<S> {
    if state.last_step > 0.0 && state.tangential.last_change != state.time {
        collocation.evaluate::<A>(&state.tangential.course, length / state.last_step)
    } else {
        [state.tangential.force; S]
    }
}

/// Newton's method for both forces at the nodes, to residuals of at most `newton` (N) or rounding; `None` if it does not
/// converge.
#[inline(always)]
pub(super) fn coupled<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    (unforced, collocation): (&Unforced<S>, &Collocation<S>),
    guess: Nodal<S>,
    newton: f64,
) -> Option<Coupled<S>> {
    let hertz = model.law.hertz()?;
    let sign = state.tangential.phase.sign();
    let share = sign.map_or(0.0, |sign| sign * friction.coefficient);
    let slip = state.tangential.slip;
    let (d0, f0, t0) = (model.preload.indentation, model.preload.force, friction.preload);
    let mut forces = guess;
    let mut loads = if sign.is_some() {
        guess.map(|force| share * (f0 + force) - t0)
    } else {
        predicted_loads::<S, A>(state, unforced.step.length, collocation).map(|load| load - t0)
    };
    let sizes = [
        greatest(&unforced.motion.d),
        greatest(&unforced.motion.d_rate),
        greatest(&unforced.motion.v),
        greatest(&unforced.motion.v_rate),
    ];
    let mut by_defect = None;
    for iterations in 0..=ITERATIONS {
        let motion = unforced.under::<A>(&forces, &loads);
        let mut laws = Laws {
            stiffness: [0.0; S],
            damping: [0.0; S],
            by_d: [0.0; S],
            by_v: [0.0; S],
            by_rate: [0.0; S],
            share,
        };
        let mut residual = [0.0; 2 * LONG];
        for k in 0..S {
            #[expect(
                clippy::indexing_slicing,
                reason = "every index runs over the fixed size of the arrays"
            )]
            {
                let d = d0 + motion.d[k];
                let law = hertz.closed_branch(d, motion.d_rate[k]);
                residual[k] = forces[k] + f0 - law.force;
                (laws.stiffness[k], laws.damping[k]) = (law.stiffness, law.damping);
                residual[S + k] = if sign.is_some() {
                    loads[k] + t0 - share * (f0 + forces[k])
                } else {
                    let trial = friction.trial(hertz, d, motion.v[k] - slip, motion.v_rate[k]);
                    laws.by_d[k] = trial.by_indentation;
                    laws.by_v[k] = -trial.stiffness;
                    laws.by_rate[k] = -trial.stiffness * hertz.damping;
                    loads[k] + t0 - trial.force
                };
            }
        }
        let rounding = MOTION_ROUNDING
            * [&laws.stiffness, &laws.damping, &laws.by_v, &laws.by_rate]
                .iter()
                .zip(sizes)
                .map(|(factors, size)| greatest(factors) * size)
                .fold(0.0, |sum, part| sum + part);
        let wrong = greatest(&residual);
        if let Some(by_defect) = by_defect.filter(|_| wrong <= newton.max(rounding)) {
            return Some(Coupled {
                forces,
                tangential: loads,
                iterations,
                laws,
                by_defect,
            });
        }
        let [by_force, by_friction, by_base] = unforced.by_defects();
        let right = [
            residual,
            laws.answer(&by_force),
            laws.answer(&by_friction),
            laws.answer(&by_base),
        ];
        let [correction, by_force, by_friction, by_base] =
            solve::<{ 2 * LONG }, 4, A>(laws.jacobian(unforced), right, 2 * S)?;
        for (force, correction) in forces.iter_mut().chain(&mut loads).zip(&correction) {
            *force -= correction;
        }
        by_defect = Some([by_force, by_friction, by_base]);
    }
    None
}
