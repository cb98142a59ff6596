//! The error estimate of a trial step.

use crate::integrator::collocation::coefficients::StepCoefficients;
use crate::integrator::collocation::newton::{FreeResponse, Solution, Tangent};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::constants::{FAR, KINKED, SUM_ROUNDINGS};
use crate::math::nodal::{Nodal, greatest};
use crate::model::Model;
use crate::state::State;

/// Estimate of an error, N.
#[derive(Clone, Copy, Debug, Default)]
pub struct Estimate {
    /// All of it.
    pub total: f64,
    /// Without what the contact's damper takes back.
    pub lasting: f64,
}

impl Estimate {
    /// Of which nothing is known to die out sooner.
    pub fn lasting(total: f64) -> Self {
        Self { total, lasting: total }
    }

    /// With this share of what the contact's damper takes back.
    pub fn with(&self, share: f64) -> f64 {
        self.lasting + share * (self.total - self.lasting)
    }
}

/// Estimates of the error that a step adds to the contact force, N: if it is taken to its end, and if it ends inside.
///
/// The polynomials are exact at the nodes; their defect at the start gives the amplitude of the next term, the shape
/// that vanishes at the nodes. Its effect on the nodal forces is known to first order ([`Solution`]). At the end of the
/// step, modes slow compared with the step are hardly affected by it (the shape is orthogonal to polynomials of low
/// degree); their error is of twice the order, about three times the square of the defect (calibrated with a free mass
/// impacting a Hertz contact). Just after first touch or a jump the force is not smooth, and their error is larger.
/// Inside the step the shape is not orthogonal to anything: slow modes get its impulse up to there.
///
/// `start_defect` (N) is the defect of the force polynomial, `largest` (N) the largest nodal force.
#[inline(always)]
pub(crate) fn errors<const S: usize>(
    model: &Model,
    state: &State,
    (step, collocation): (&StepCoefficients<S>, &Collocation<S>),
    solution: &Solution<S>,
    start_defect: f64,
    free: &FreeResponse<S>,
    largest: f64,
) -> [Estimate; 2] {
    if state.closed {
        let (by_force, by_load) = (solution.by_force, solution.by_load);
        let wrong_d = by_load.0 * free.start_defect - by_force.0 * start_defect;
        let wrong_r = by_load.1 * free.start_defect - by_force.1 * start_defect;
        let of_way = (solution.tangent.stiffness * wrong_d).abs();
        let fast = of_way + (solution.tangent.damping * wrong_r).abs();
        let kinked = kinked::<S>(state, step.length, start_defect.abs());
        let reaction = solution.tangent.gain / (1.0 + solution.tangent.gain);
        let missed = model.inertia * free.missed_mean;
        let slow = 3.0 * start_defect * start_defect / largest + kinked + missed;
        let inside = greatest(&solution.nodal_by_force) * start_defect.abs()
            + greatest(&solution.nodal_by_load) * free.start_defect.abs();
        // With an axial force the other defects are in `inside` alone.
        let base = if model.axial().is_some() {
            0.0
        } else {
            model.inertia * free.start_defect.abs()
        };
        let impulse = collocation.impulse * (start_defect.abs() + base) + missed;
        // The contact's damper takes back what a wrong velocity makes, not a wrong way.
        let kept = of_way / fast.max(f64::MIN_POSITIVE);
        [(fast, slow), (inside, impulse)].map(|(fast, slow)| Estimate {
            total: fast + slow * reaction,
            lasting: kept * fast + slow * reaction,
        })
    } else {
        // Of the indentation that is read, searched for a contact, or left at an instant inside.
        let most = |values: &Nodal<S>| greatest(values) * free.start_defect.abs();
        let rows = free.error;
        let missed_velocity = free.missed_mean * step.length;
        let law = &model.hardest;
        let wrong = most(&rows.displacement)
            + law.damping() * most(&rows.velocity)
            + missed_velocity * (model.memory + law.damping());
        let stiffness = law.tangent_stiffness(model.force_scale);
        // At the end the velocity is that of the quadrature.
        [wrong, wrong + model.memory * most(&rows.velocity)].map(|wrong| Estimate::lasting(stiffness * wrong))
    }
}

/// Whether the error (N) of a step from `state` is explained by rounding of the sums over the modes: after an impact the
/// modal velocities are large and their sum at the tip is small.
pub(crate) fn is_rounding<const S: usize>(model: &Model, state: &State, tangent: &Tangent, error: f64) -> bool {
    let (displacement, velocity) = sum_rounding(model.modes.iter().map(|mode| mode.tip), state);
    // The force at the first node feeds back only over the time up to it, some 1 / S^2 of the step.
    let reaction = 1.0 + tangent.gain / (S * S) as f64;
    let Tangent { stiffness, damping, .. } = *tangent;
    error <= (stiffness * displacement + damping * velocity) / reaction
}

/// Rounding of a displacement (m) and its velocity (m/s) as sums over the modes with these factors.
pub(crate) fn sum_rounding(factors: impl Iterator<Item = f64>, state: &State) -> (f64, f64) {
    let (mut displacement, mut velocity) = (0.0, 0.0);
    for (factor, at) in factors.zip(&state.modes) {
        displacement += (factor * at.q).abs();
        velocity += (factor * at.v).abs();
    }
    let rounding = SUM_ROUNDINGS * f64::EPSILON;
    (rounding * displacement, rounding * velocity)
}

/// Error of slow modes, N, that a defect (N) of the force at the start of a step of `length` seconds makes near a kink, where
/// the force is not smooth.
#[inline(always)]
pub(super) fn kinked<const S: usize>(state: &State, length: f64, defect: f64) -> f64 {
    let elapsed = state.time - state.last_kink;
    if elapsed < FAR * length {
        KINKED * defect * analytic::<S>(elapsed / length)
    } else {
        0.0
    }
}

/// Ratio of the quadrature error to the interpolation error with `S` nodes for a square root of time whose branch point
/// lies `distance` step lengths before the step. Interpolation converges with the power `S` of the size of the
/// Bernstein ellipse, quadrature with the power `2 S - 1` (L. N. Trefethen, Approximation Theory and Approximation
/// Practice, 2013, chapters 8 and 19).
fn analytic<const S: usize>(distance: f64) -> f64 {
    let ellipse = 1.0 + 2.0 * distance + 2.0 * (distance * (distance + 1.0)).sqrt();
    (1..S).fold(1.0, |product, _| product / ellipse)
}
