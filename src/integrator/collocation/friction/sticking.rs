//! Newton's method for contact force and friction force at the nodes while the contact sticks.
//!
//! Both laws hardly bend within a step, and the friction force depends on the motion along the spring linearly: the Jacobian of
//! the first iteration, once factorised, serves the others and the error estimate.

use crate::friction::Friction;
use crate::integrator::collocation::elimination::{factorise, substitute};
use crate::integrator::collocation::friction::motion::{Motion, Solved, Unforced};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{ITERATIONS, MOTION_ROUNDING, STALE};
use crate::math::nodal::{Nodal, add, add_columns, add_products, greatest, scaled};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// A contact force and a friction force at each node.
type Both<const S: usize> = [Nodal<S>; 2];

/// Derivatives of both forces by the motion at the nodes.
struct Laws<const S: usize> {
    stiffness: Nodal<S>,
    damping: Nodal<S>,
    /// Of the friction force, by indentation, displacement and velocity.
    by_d: Nodal<S>,
    by_v: Nodal<S>,
    by_rate: Nodal<S>,
}

/// The Jacobian of the residuals, factorised: the friction forces are eliminated before the contact forces.
struct Factors<const S: usize> {
    /// Of the friction forces.
    along: [Nodal<S>; S],
    along_exchanges: [usize; S],
    /// Friction forces per contact force.
    answers: [Nodal<S>; S],
    /// Residuals of the contact forces per friction force.
    crossed: [Nodal<S>; S],
    /// Of the contact forces, with the friction forces that answer them.
    across: [Nodal<S>; S],
    across_exchanges: [usize; S],
}

impl<const S: usize> Laws<S> {
    /// Change of the contact force by indentation and its velocity.
    #[inline(always)]
    fn across<A: Arithmetic>(&self, d: &Nodal<S>, rate: &Nodal<S>) -> Nodal<S> {
        let mut forces = [0.0; S];
        add_products::<S, A>(&mut forces, &self.stiffness, d);
        add_products::<S, A>(&mut forces, &self.damping, rate);
        forces
    }

    /// Change of the friction force by indentation, and by displacement and velocity along the spring.
    #[inline(always)]
    fn along<A: Arithmetic>(&self, d: &Nodal<S>, v: &Nodal<S>, rate: &Nodal<S>) -> Nodal<S> {
        let mut forces = [0.0; S];
        add_products::<S, A>(&mut forces, &self.by_d, d);
        add_products::<S, A>(&mut forces, &self.by_v, v);
        add_products::<S, A>(&mut forces, &self.by_rate, rate);
        forces
    }

    #[inline(always)]
    fn factors<A: Arithmetic>(&self, unforced: &Unforced<S>) -> Option<Factors<S>> {
        let Unforced { step, tangential, .. } = unforced;
        let (d, cross, own) = (&step.force, &tangential.cross, &tangential.own);
        let [mut across, mut crossed, mut answers, mut along] = [[[0.0; S]; S]; 4];
        for j in 0..S {
            #[expect(clippy::indexing_slicing, reason = "there is a column for each node")]
            {
                // Contact forces reduce the indentation.
                across[j] = self.across::<A>(&d.displacement[j], &d.velocity[j]);
                crossed[j] = self.across::<A>(&cross.displacement[j], &cross.velocity[j]);
                let less = |column: &Nodal<S>| scaled(column, -1.0);
                answers[j] = self.along::<A>(
                    &d.displacement[j],
                    &less(&cross.displacement[j]),
                    &less(&cross.velocity[j]),
                );
                along[j] = self.along::<A>(
                    &cross.displacement[j],
                    &less(&own.displacement[j]),
                    &less(&own.velocity[j]),
                );
                across[j][j] += 1.0;
                along[j][j] += 1.0;
            }
        }
        let along_exchanges = factorise::<S, S, A>(&mut along, &mut answers)?;
        for (column, answer) in across.iter_mut().zip(&answers) {
            add_columns::<S, A>(column, &crossed, &scaled(answer, -1.0));
        }
        let across_exchanges = factorise::<S, 0, A>(&mut across, &mut [])?;
        Some(Factors {
            along,
            along_exchanges,
            answers,
            crossed,
            across,
            across_exchanges,
        })
    }
}

impl<const S: usize> Factors<S> {
    /// Forces from residuals.
    #[inline(always)]
    fn solve<A: Arithmetic>(&self, [mut forces, mut loads]: Both<S>) -> Both<S> {
        substitute::<S, A>(&self.along, &self.along_exchanges, &mut loads);
        add_columns::<S, A>(&mut forces, &self.crossed, &scaled(&loads, -1.0));
        substitute::<S, A>(&self.across, &self.across_exchanges, &mut forces);
        add_columns::<S, A>(&mut loads, &self.answers, &scaled(&forces, -1.0));
        [forces, loads]
    }
}

/// Friction forces at the nodes, extrapolated from the last step.
#[inline(always)]
fn predicted_loads<const S: usize, A: Arithmetic>(
    state: &State,
    length: f64,
    collocation: &Collocation<S>,
) -> Nodal<S> {
    if state.last_step > 0.0 && state.tangential.last_change != Some(state.time) {
        collocation.guess::<A>(&state.tangential.course, length / state.last_step)
    } else {
        [state.tangential.force; S]
    }
}

/// Both forces at the nodes, to residuals of at most `newton` (N) or rounding; `None` if the iteration does not converge.
#[inline(always)]
pub(super) fn sticking<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    (unforced, collocation): (&Unforced<S>, &Collocation<S>),
    guess: Nodal<S>,
    newton: f64,
) -> Option<Solved<S>> {
    let law = model.law.power()?;
    let slip = state.tangential.slip;
    let (d0, f0, t0) = (model.preload.indentation, model.preload.force, friction.preload);
    let mut forces = guess;
    let mut loads = predicted_loads::<S, A>(state, unforced.step.length, collocation).map(|load| load - t0);
    let sizes = [
        greatest(&unforced.motion.d),
        greatest(&unforced.motion.d_rate),
        greatest(&unforced.motion.v),
        greatest(&unforced.motion.v_rate),
    ];
    let mut factors: Option<Factors<S>> = None;
    let mut before = 0.0;
    for iterations in 0..=ITERATIONS {
        let motion = unforced.under::<A>(&forces, &loads);
        let mut laws = Laws {
            stiffness: [0.0; S],
            damping: [0.0; S],
            by_d: [0.0; S],
            by_v: [0.0; S],
            by_rate: [0.0; S],
        };
        let [mut residual, mut residual_along] = [[0.0; S]; 2];
        #[expect(clippy::indexing_slicing, reason = "there is a value for each node")]
        for k in 0..S {
            let d = d0 + motion.d[k];
            let branch = law.closed_branch(d, motion.d_rate[k]);
            residual[k] = forces[k] + f0 - branch.force;
            (laws.stiffness[k], laws.damping[k]) = (branch.stiffness, branch.damping);
            let trial = friction.trial(law, d, motion.v[k] - slip, motion.v_rate[k]);
            laws.by_d[k] = trial.by_indentation;
            laws.by_v[k] = -trial.stiffness;
            laws.by_rate[k] = -trial.stiffness * law.damping;
            residual_along[k] = loads[k] + t0 - trial.force;
        }
        let rounding = MOTION_ROUNDING
            * [&laws.stiffness, &laws.damping, &laws.by_v, &laws.by_rate]
                .iter()
                .zip(sizes)
                .map(|(factors, size)| greatest(factors) * size)
                .fold(0.0, |sum, part| sum + part);
        let wrong = greatest(&residual).max(greatest(&residual_along));
        if let Some(factors) = factors.as_ref().filter(|_| wrong <= newton.max(rounding)) {
            let defects = unforced.defects::<A>(model, friction, state, collocation, (&forces, &loads));
            let Motion { d, d_rate, v, v_rate } = unforced.under_defects::<A>(&defects);
            let [wrong, wrong_loads] =
                factors.solve::<A>([laws.across::<A>(&d, &d_rate), laws.along::<A>(&d, &v, &v_rate)]);
            return Some(Solved {
                forces,
                loads,
                iterations,
                motion,
                hardest: (greatest(&laws.stiffness), greatest(&laws.damping)),
                defects,
                wrong,
                wrong_loads,
            });
        }
        if factors.is_none() || wrong > STALE * before {
            factors = Some(laws.factors::<A>(unforced)?);
        }
        before = wrong;
        let [correction, correction_along] = factors.as_ref()?.solve::<A>([residual, residual_along]);
        if !correction
            .iter()
            .chain(&correction_along)
            .all(|force| force.is_finite())
        {
            return None;
        }
        add::<S, A>(&mut forces, -1.0, &correction);
        add::<S, A>(&mut loads, -1.0, &correction_along);
    }
    None
}
