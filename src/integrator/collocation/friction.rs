//! A trial step with friction: contact force and friction force at the nodes, found together.
//!
//! The friction force `T` is a second load on the modes, a polynomial through the nodes as the contact force `F` is, and it
//! moves the contact point along the spring by `v`:
//!
//! ```text
//! d_k = d_k(free) - sum_j (D_kj F_j + X_kj T_j)      X = sum_i T_i (h T_i') (response of mode i at x_k to l_j)
//! v_k = v_k(free) + sum_j (X_kj F_j + Y_kj T_j)      Y = sum_i (h T_i')^2 (the same)
//! stick:  T_k = -k_t(d_k) (v_k - s + beta_c v'_k), s the slip so far;  slip:  T_k = -+ mu F_k
//! ```
//!
//! with Newton's method for all nodal values ([`crate::friction`]: the law). While the contact slips the deflection `z` of
//! the tangential spring follows from `beta_c z' + z = -T / k_t`, collocated at the same nodes.

use crate::excitation::drive::Drive;
use crate::friction::Friction;
use crate::integrator::collocation::coefficients::{
    ErrorColumn, Prepared, StepCoefficients, TangentialCoefficients, TipColumns,
};
use crate::integrator::collocation::error::{analytic, errors};
use crate::integrator::collocation::newton::{FreeResponse, Solution, Source, Tangent, first_forces};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::{End, Trial, end_of_modes, free_response, loads_on_modes};
use crate::integrator::constants::{FAR, FORCE_ROUNDING, ITERATIONS, KINKED, MOTION_ROUNDING, SMALL_PIVOT};
use crate::math::nodal::{LONG, Nodal, add, add_columns, dot, end, greatest, scaled};
use crate::math::prediction::value_and_slope;
use crate::math::simd::{Arithmetic, LANES};
use crate::model::Model;
use crate::state::State;

/// Friction at the nodes of a step.
#[derive(Clone, Copy, Debug)]
pub struct TangentialNodes<const S: usize> {
    /// Friction force as deviation from that of the preload, N.
    pub forces: Nodal<S>,
    /// Displacement of the contact point along the spring, m.
    pub displacements: Nodal<S>,
    /// Its velocity, m/s.
    pub rates: Nodal<S>,
    /// Deflection of the tangential spring, m.
    pub deflections: Nodal<S>,
    /// Slip velocity, m/s.
    pub slip_rates: Nodal<S>,
}

impl<const S: usize> TangentialNodes<S> {
    pub(super) const ZERO: Self = Self {
        forces: [0.0; S],
        displacements: [0.0; S],
        rates: [0.0; S],
        deflections: [0.0; S],
        slip_rates: [0.0; S],
    };

    /// The first part of the step, up to the share `part` of it.
    pub(crate) fn first_part(&self, collocation: &Collocation<S>, state: &State, part: f64) -> Self {
        let nodes = collocation.nodes.map(|node| node * part);
        let nodal = |values: &Nodal<S>| nodes.map(|x| collocation.interpolate(values, x));
        let with_start = |start: f64, values: &Nodal<S>| {
            let polynomial = collocation.through(start, values);
            nodes.map(|x| value_and_slope(&polynomial, x - 1.0).0)
        };
        let start = &state.tangential;
        Self {
            forces: nodal(&self.forces),
            displacements: with_start(start.displacement, &self.displacements),
            rates: with_start(start.rate, &self.rates),
            deflections: with_start(start.deflection(), &self.deflections),
            slip_rates: nodal(&self.slip_rates),
        }
    }
}

/// Motion of the tip at the nodes: indentation and displacement along the spring, with their velocities.
#[derive(Clone, Copy)]
struct Motion<const S: usize> {
    d: Nodal<S>,
    d_rate: Nodal<S>,
    v: Nodal<S>,
    v_rate: Nodal<S>,
}

/// Contact forces and friction forces at the nodes, one after the other; the rest is zero.
type Both = [f64; 2 * LONG];

/// What the laws answer to a motion at the nodes: derivatives of both forces.
#[derive(Clone, Copy)]
struct Laws<const S: usize> {
    stiffness: Nodal<S>,
    damping: Nodal<S>,
    /// Of the friction force while it sticks, by indentation (with opposite sign), displacement and velocity.
    by_d: Nodal<S>,
    by_v: Nodal<S>,
    by_rate: Nodal<S>,
    /// Of the friction force by the contact force while it slips.
    share: f64,
}

/// The nodal forces of a step.
struct Coupled<const S: usize> {
    forces: Nodal<S>,
    tangential: Nodal<S>,
    iterations: u64,
    laws: Laws<S>,
    /// Both per unit defect at the start: of contact force, friction force and base acceleration.
    by_defect: [Both; 3],
}

/// What acts on the step beside both forces.
struct Unforced<'a, const S: usize> {
    step: &'a StepCoefficients<S>,
    tangential: &'a TangentialCoefficients<S>,
    free: FreeResponse<'a, S>,
    motion: Motion<S>,
}

/// [`trial`](super::step::trial) with friction. Where the contact forces are given, so are the friction forces: those left in
/// `end`.
#[inline(always)]
pub(super) fn compute<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    drive: &Drive,
    prepared: Prepared<S>,
    source: Source<S>,
    ends: &mut End<S>,
) -> Option<Trial<S>> {
    let Prepared { step, collocation, .. } = prepared;
    let tangential = step.tangential.as_deref()?;
    let free = free_response::<S, A>(state, drive, &prepared);
    let motion = along::<S, A>(state, tangential, &free);
    let unforced = Unforced {
        step,
        tangential,
        free,
        motion,
    };
    let guess = first_forces::<S, A>(model, state, step, collocation, source);
    let coupled = match source {
        Source::Law(newton) if state.closed => Some(coupled::<S, A>(
            model,
            friction,
            state,
            (&unforced, collocation),
            guess,
            newton,
        )?),
        _ => None,
    };
    let (forces, loads) = match (&coupled, source) {
        (Some(coupled), _) => (coupled.forces, coupled.tangential),
        (None, Source::Law(_)) => (guess, [-friction.preload; S]),
        (None, Source::Given(_)) => (guess, ends.tangential.forces),
    };
    let motion = unforced.under::<A>(&forces, &loads);
    ends.tangential = nodes::<S, A>(model, friction, state, (step.length, collocation), &motion, loads);

    let accelerations = unforced.free.accelerations;
    let (tip, tip_rate) = end_of_modes::<S, A>(
        state,
        step,
        model.modes.len(),
        #[inline(always)]
        |first, lanes| {
            loads_on_modes::<S, A>(&step.end, first, &forces, &accelerations, lanes);
            let levers = friction.levers.iter().skip(first).take(LANES);
            for (i, lever) in levers.enumerate() {
                for (lanes, load) in lanes.iter_mut().zip(&loads) {
                    lanes.iter_mut().skip(i).take(1).for_each(|lane| *lane += lever * load);
                }
            }
        },
        &mut ends.modes,
    );
    let support = state.support + drive.support_rate * step.length;
    let largest = forces.iter().fold(f64::MIN_POSITIVE, |largest, force| {
        largest.max((model.preload.force + force).abs())
    });
    let judgement = match &coupled {
        Some(coupled) => judged::<S, A>(model, friction, state, collocation, &unforced, coupled, largest),
        None => {
            let solution = Solution::given(forces);
            let coefficients = (step, collocation);
            let (error, inner_error) = errors(model, state, coefficients, &solution, 0.0, &unforced.free, largest);
            Judgement {
                error,
                inner_error,
                ..Judgement::default()
            }
        }
    };
    Some(Trial {
        forces,
        indentations: motion.d,
        rates: motion.d_rate,
        accelerations,
        support,
        indentation: support - tip,
        rate: drive.support_rate - tip_rate,
        force: end(&forces),
        error: judgement.error,
        inner_error: judgement.inner_error,
        rounding: FORCE_ROUNDING * largest.max(model.preload.force),
        start_defect: judgement.start_defect,
        next_terms: judgement.next_terms,
        iterations: coupled.as_ref().map_or(0, |coupled| coupled.iterations),
        tangent: judgement.tangent,
    })
}

/// Motion at the nodes without a change of both forces.
#[inline(always)]
fn along<const S: usize, A: Arithmetic>(
    state: &State,
    tangential: &TangentialCoefficients<S>,
    free: &FreeResponse<S>,
) -> Motion<S> {
    let (mut v, mut v_rate) = ([0.0; S], [0.0; S]);
    for (mode, row) in state.modes.iter().zip(&tangential.modes) {
        add::<S, A>(&mut v, mode.q, &row.tip_from_q);
        add::<S, A>(&mut v, mode.v, &row.tip_from_v);
        add::<S, A>(&mut v_rate, mode.q, &row.rate_from_q);
        add::<S, A>(&mut v_rate, mode.v, &row.rate_from_v);
    }
    let pushed = scaled(&free.accelerations, -1.0);
    add_columns::<S, A>(&mut v, &tangential.acceleration.displacement, &pushed);
    add_columns::<S, A>(&mut v_rate, &tangential.acceleration.velocity, &pushed);
    Motion {
        d: free.free,
        d_rate: free.free_rate,
        v,
        v_rate,
    }
}

impl<const S: usize> Unforced<'_, S> {
    /// Motion at the nodes under both forces, as deviations from those of the preload.
    #[inline(always)]
    fn under<A: Arithmetic>(&self, forces: &Nodal<S>, loads: &Nodal<S>) -> Motion<S> {
        let Self { step, tangential, .. } = self;
        let mut motion = self.motion;
        let (less, less_loads) = (scaled(forces, -1.0), scaled(loads, -1.0));
        add_columns::<S, A>(&mut motion.d, &step.force.displacement, &less);
        add_columns::<S, A>(&mut motion.d, &tangential.cross.displacement, &less_loads);
        add_columns::<S, A>(&mut motion.d_rate, &step.force.velocity, &less);
        add_columns::<S, A>(&mut motion.d_rate, &tangential.cross.velocity, &less_loads);
        add_columns::<S, A>(&mut motion.v, &tangential.cross.displacement, forces);
        add_columns::<S, A>(&mut motion.v, &tangential.own.displacement, loads);
        add_columns::<S, A>(&mut motion.v_rate, &tangential.cross.velocity, forces);
        add_columns::<S, A>(&mut motion.v_rate, &tangential.own.velocity, loads);
        motion
    }

    /// Motion under unit contact force or friction force at one node.
    #[inline(always)]
    fn by_nodes(&self) -> impl Iterator<Item = Motion<S>> {
        let Self { step, tangential, .. } = self;
        let pairs = |columns: &'_ TipColumns<S>| columns.displacement.into_iter().zip(columns.velocity);
        let by_force = pairs(&step.force).zip(pairs(&tangential.cross));
        let by_friction = pairs(&tangential.cross).zip(pairs(&tangential.own));
        by_force.chain(by_friction).map(|((d, d_rate), (v, v_rate))| Motion {
            d: scaled(&d, -1.0),
            d_rate: scaled(&d_rate, -1.0),
            v,
            v_rate,
        })
    }

    /// Motion per unit defect at the start: of contact force, friction force and base acceleration.
    #[inline(always)]
    fn by_defects(&self) -> [Motion<S>; 3] {
        let Self {
            step, tangential, free, ..
        } = self;
        let of = |d: &ErrorColumn<S>, v: &ErrorColumn<S>, sign: f64| Motion {
            d: scaled(&d.displacement, -sign),
            d_rate: scaled(&d.velocity, -sign),
            v: scaled(&v.displacement, sign),
            v_rate: scaled(&v.velocity, sign),
        };
        [
            of(&step.force_error, &tangential.cross_error, 1.0),
            of(&tangential.cross_error, &tangential.own_error, 1.0),
            of(free.error, &tangential.acceleration_error, -1.0),
        ]
    }
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
}

/// Newton's method for both forces at the nodes, to residuals of at most `newton` (N) or rounding; `None` if it does not
/// converge.
#[inline(always)]
fn coupled<const S: usize, A: Arithmetic>(
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
    } else if state.last_step > 0.0 && state.tangential.last_change != state.time {
        let ahead = collocation.evaluate::<A>(&state.tangential.course, unforced.step.length / state.last_step);
        ahead.map(|force| force - t0)
    } else {
        [state.tangential.force - t0; S]
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
        let wrong = residual.iter().fold(
            0.0,
            |most: f64, value| if value.abs() <= most { most } else { value.abs() },
        );
        if let Some(by_defect) = by_defect.filter(|_| wrong <= newton.max(rounding)) {
            return Some(Coupled {
                forces,
                tangential: loads,
                iterations,
                laws,
                by_defect,
            });
        }
        // Derivatives of the residuals with respect to each nodal force, by columns.
        let mut jacobian = [[0.0; 2 * LONG]; 2 * LONG];
        for (j, (column, moved)) in jacobian.iter_mut().zip(unforced.by_nodes()).enumerate() {
            for (entry, answer) in column.iter_mut().zip(laws.answer(&moved)) {
                *entry = -answer;
            }
            column.iter_mut().skip(j).take(1).for_each(|entry| *entry += 1.0);
            if j < S {
                column
                    .iter_mut()
                    .skip(S + j)
                    .take(1)
                    .for_each(|entry| *entry -= laws.share);
            }
        }
        let [by_force, by_friction, by_base] = unforced.by_defects();
        let mut right = [
            residual,
            laws.answer(&by_force),
            laws.answer(&by_friction),
            laws.answer(&by_base),
        ];
        solve::<A>(&mut jacobian, &mut right, 2 * S)?;
        let [correction, by_force, by_friction, by_base] = right;
        for (force, correction) in forces.iter_mut().chain(&mut loads).zip(&correction) {
            *force -= correction;
        }
        by_defect = Some([by_force, by_friction, by_base]);
    }
    None
}

/// Solves `A x = b` of `n` equations for several `b`, by columns: Gauss-Jordan elimination as in
/// [`newton`](super::newton), with exchange of rows at small pivots. `None` if the matrix is singular.
#[expect(clippy::indexing_slicing, reason = "n is at most the size of the arrays")]
#[inline(always)]
fn solve<A: Arithmetic>(a: &mut [Both; 2 * LONG], right: &mut [Both; 4], n: usize) -> Option<()> {
    for p in 0..n {
        if a[p][p].abs() < SMALL_PIVOT {
            let largest = (p..n).max_by(|i, j| a[p][*i].abs().total_cmp(&a[p][*j].abs()))?;
            for column in a.iter_mut().chain(right.iter_mut()) {
                column.swap(p, largest);
            }
        }
        let pivot = a[p];
        let inverse = 1.0 / pivot[p];
        for column in a.iter_mut().take(n).skip(p + 1) {
            eliminate::<A>(column, p, &pivot, inverse, n);
        }
        for column in right.iter_mut() {
            eliminate::<A>(column, p, &pivot, inverse, n);
        }
    }
    right.iter().flatten().all(|x| x.is_finite()).then_some(())
}

/// Eliminates row `p` of a column from all other rows, and divides it by the pivot.
#[expect(clippy::indexing_slicing, reason = "n is at most the size of the arrays")]
#[inline(always)]
fn eliminate<A: Arithmetic>(column: &mut Both, p: usize, pivot: &Both, inverse: f64, n: usize) {
    let share = column[p] * inverse;
    for k in 0..n {
        column[k] = A::mul_add(-pivot[k], share, column[k]);
    }
    column[p] = share;
}

/// Friction at the nodes under these forces.
#[inline(always)]
fn nodes<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    (length, collocation): (f64, &Collocation<S>),
    motion: &Motion<S>,
    loads: Nodal<S>,
) -> TangentialNodes<S> {
    let start = &state.tangential;
    let mut nodes = TangentialNodes {
        forces: loads,
        displacements: motion.v,
        rates: motion.v_rate,
        ..TangentialNodes::ZERO
    };
    let (Some(hertz), true) = (model.law.hertz(), state.closed) else {
        return nodes;
    };
    let Some(sign) = start.phase.sign() else {
        let slip = start.slip;
        nodes.deflections = motion.v.map(|v| v - slip);
        return nodes;
    };
    // z = z_0 + integral of z', beta_c z' + z = -T / k_t at the nodes.
    let Some(integrals) = collocation.shapes.integrals.first() else {
        return nodes;
    };
    let mut right = [[0.0; 2 * LONG]; 4];
    let moved = motion.d.iter().zip(&motion.d_rate);
    for (entry, (d, rate)) in right.iter_mut().take(1).flatten().zip(moved) {
        let d = model.preload.indentation + d;
        *entry = (friction.limit_deflection(hertz, sign, d, *rate) - start.deflection()) / (hertz.damping + length);
    }
    let mut matrix = [[0.0; 2 * LONG]; 2 * LONG];
    let lag = hertz.damping / (hertz.damping + length);
    for (j, (column, integral)) in matrix.iter_mut().zip(&integrals.nodal).enumerate() {
        for (entry, integral) in column.iter_mut().zip(integral) {
            *entry = (1.0 - lag) * integral;
        }
        column.iter_mut().skip(j).take(1).for_each(|entry| *entry += lag);
    }
    if solve::<A>(&mut matrix, &mut right, S).is_none() {
        return nodes;
    }
    let mut rates = [0.0; S];
    for (rate, solved) in rates.iter_mut().zip(right.iter().flatten()) {
        *rate = *solved;
    }
    nodes.deflections = [start.deflection(); S];
    add_columns::<S, A>(&mut nodes.deflections, &integrals.nodal, &scaled(&rates, length));
    for ((slip, rate), lagging) in nodes.slip_rates.iter_mut().zip(&motion.v_rate).zip(&rates) {
        *slip = rate - lagging;
    }
    nodes
}

/// How good a trial is.
#[derive(Default)]
struct Judgement {
    error: f64,
    inner_error: f64,
    start_defect: f64,
    next_terms: f64,
    tangent: Tangent,
}

/// The error estimate of [`error`](super::error), for both forces: what the defects of both polynomials and of the base
/// acceleration at the start do to both forces.
#[inline(always)]
fn judged<const S: usize, A: Arithmetic>(
    model: &Model,
    friction: &Friction,
    state: &State,
    collocation: &Collocation<S>,
    unforced: &Unforced<S>,
    coupled: &Coupled<S>,
    largest: f64,
) -> Judgement {
    let Unforced { step, free, .. } = unforced;
    let Coupled {
        forces,
        tangential,
        laws,
        by_defect,
        ..
    } = coupled;
    let starts = [
        state.force - model.preload.force,
        state.tangential.force - friction.preload,
    ];
    let [normal, along] = [(starts[0], forces), (starts[1], tangential)]
        .map(|(start, values)| start - dot::<S, A>(values, &collocation.at_start));
    let defects = [normal, along, free.start_defect];
    // Both forces at the nodes, and what moves the tip at the end.
    let (mut wrong, mut wrong_loads) = ([0.0; S], [0.0; S]);
    for (defect, both) in defects.iter().zip(by_defect) {
        for (sum, value) in wrong.iter_mut().chain(&mut wrong_loads).zip(both) {
            *sum += defect * value;
        }
    }
    let own = unforced.by_defects();
    let direct = |of: fn(&Motion<S>) -> &Nodal<S>| -> f64 {
        defects
            .iter()
            .zip(&own)
            .map(|(defect, motion)| defect * end(of(motion)))
            .sum()
    };
    let last = |columns: &[Nodal<S>; S], loads: &Nodal<S>| {
        columns
            .iter()
            .zip(loads)
            .map(|(column, load)| end(column) * load)
            .sum::<f64>()
    };
    let (d, v) = (&step.force, unforced.tangential);
    let wrong_d =
        direct(|motion| &motion.d) - last(&d.displacement, &wrong) - last(&v.cross.displacement, &wrong_loads);
    let wrong_rate =
        direct(|motion| &motion.d_rate) - last(&d.velocity, &wrong) - last(&v.cross.velocity, &wrong_loads);
    let wrong_v =
        direct(|motion| &motion.v) + last(&v.cross.displacement, &wrong) + last(&v.own.displacement, &wrong_loads);
    let wrong_v_rate =
        direct(|motion| &motion.v_rate) + last(&v.cross.velocity, &wrong) + last(&v.own.velocity, &wrong_loads);

    let start_stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
    let beta = model.law.damping();
    let tangent = {
        let stiffness = greatest(&laws.stiffness).max(start_stiffness);
        let damping = greatest(&laws.damping).max(beta * start_stiffness);
        let steady = [1.0; S];
        let gain = stiffness * last(&d.displacement, &steady) + damping * last(&d.velocity, &steady);
        Tangent {
            stiffness,
            damping,
            gain: gain.max(0.0),
        }
    };
    let sticks = state.tangential.phase.sign().is_none();
    let grip = if sticks {
        friction.ratio * tangent.stiffness
    } else {
        0.0
    };
    let fast = (tangent.stiffness * wrong_d).abs()
        + (tangent.damping * wrong_rate).abs()
        + grip * (wrong_v.abs() + beta * wrong_v_rate.abs());
    let both = normal.abs() + along.abs();
    let elapsed = state.time - state.last_kink;
    let kinked = if elapsed < FAR * step.length {
        KINKED * both * analytic::<S>(elapsed / step.length)
    } else {
        0.0
    };
    let reaction = tangent.gain / (1.0 + tangent.gain);
    let missed = model.inertia * free.missed_mean;
    let slow = 3.0 * (normal * normal + along * along) / largest + kinked + missed;
    let impulse = collocation.impulse * (both + model.inertia * free.start_defect.abs()) + missed;
    let terms = |start, values: &Nodal<S>| collocation.next_terms::<A>(start, values);
    Judgement {
        error: fast + slow * reaction,
        inner_error: greatest(&wrong) + greatest(&wrong_loads) + impulse * reaction,
        start_defect: normal.abs().max(along.abs()),
        next_terms: terms(starts[0], forces).max(terms(starts[1], tangential)),
        tangent,
    }
}
