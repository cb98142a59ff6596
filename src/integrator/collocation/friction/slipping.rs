//! The nodal forces while the contact slips: the friction force is a share of the contact force, `T = -+ mu F`. So each contact
//! force moves the tip with its friction force, and what remains are the contact forces, as without friction.

use crate::friction::Friction;
use crate::integrator::collocation::coefficients::{ErrorColumn, TipColumns};
use crate::integrator::collocation::friction::motion::{Solved, Unforced};
use crate::integrator::collocation::newton::closed_forces;
use crate::integrator::collocation::polynomial::Collocation;
use crate::math::nodal::{Nodal, add, add_columns};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// Both forces at the nodes, where the friction force is `share` times the contact force, to residuals of at most `newton` (N)
/// or rounding; `None` if the iteration does not converge.
#[inline(always)]
pub(super) fn slipping<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    (unforced, collocation): (&Unforced<S>, &Collocation<S>),
    share: f64,
    guess: Nodal<S>,
    newton: f64,
) -> Option<Solved<S>> {
    let Unforced {
        step, tangential, free, ..
    } = unforced;
    // The friction force without a change of the contact force, as deviation from that of the preload.
    let steady = share * model.preload.force - friction.preload;
    let columns = TipColumns {
        displacement: joined::<S, A, _>(&step.force.displacement, share, &tangential.cross.displacement),
        velocity: joined::<S, A, _>(&step.force.velocity, share, &tangential.cross.velocity),
    };
    let [displacement, velocity] = joined::<S, A, _>(
        &[step.force_error.displacement, step.force_error.velocity],
        share,
        &[tangential.cross_error.displacement, tangential.cross_error.velocity],
    );
    let defect = ErrorColumn { displacement, velocity };
    let mut free = free.clone();
    if steady != 0.0 {
        let less = [-steady; S];
        add_columns::<S, A>(&mut free.free, &tangential.cross.displacement, &less);
        add_columns::<S, A>(&mut free.free_rate, &tangential.cross.velocity, &less);
    }
    let start = model.law.stiffness(model.preload.indentation + state.indentation);
    let solution = closed_forces::<S, A>(model, (&columns, &defect), &free, guess, (newton, start))?;
    let forces = solution.forces;
    let mut loads = [steady; S];
    add::<S, A>(&mut loads, share, &forces);
    let defects = unforced.defects::<A>(model, friction, state, collocation, (&forces, &loads));
    let [normal, _, base] = defects;
    let mut wrong = [0.0; S];
    add::<S, A>(&mut wrong, -normal, &solution.nodal_by_force);
    add::<S, A>(&mut wrong, base, &solution.nodal_by_load);
    Some(Solved {
        forces,
        loads,
        iterations: solution.iterations,
        motion: unforced.under::<A>(&forces, &loads),
        hardest: (solution.tangent.stiffness, solution.tangent.damping),
        defects,
        wrong,
        wrong_loads: wrong.map(|wrong| share * wrong),
    })
}

/// `a` with `share` times `b`.
#[inline(always)]
fn joined<const S: usize, A: Arithmetic, const N: usize>(
    a: &[Nodal<S>; N],
    share: f64,
    b: &[Nodal<S>; N],
) -> [Nodal<S>; N] {
    let mut sum = *a;
    for (sum, values) in sum.iter_mut().zip(b) {
        add::<S, A>(sum, share, values);
    }
    sum
}
