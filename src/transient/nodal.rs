//! One step: the nodal contact forces and the motion they give.

use crate::model::{ModeStates, Model, State};
use crate::transient::coefficients::{ErrorColumn, Modal, StepCoefficients};
use crate::transient::collocation::{Collocation, Nodal};
use crate::transient::machine::{Arithmetic, compiled_for};
use crate::transient::vector::dot;

/// What drives the contact over a communication step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Base acceleration from the input, m/s2.
    pub acceleration: f64,
    /// Velocity of the fixed contact, m/s.
    pub support_rate: f64,
}

/// Where the contact force of a step comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// The law at the nodes while the contact is closed, with this as the largest last correction of Newton's method, N;
    /// nothing while it is open.
    Law(f64),
    /// This throughout, as deviation from the preload force, N.
    Constant(f64),
}

/// A step computed but not yet taken.
#[derive(Clone, Copy, Debug)]
pub struct Trial<const S: usize> {
    /// Nodal forces as deviation from the preload force, N.
    pub forces: Nodal<S>,
    /// Indentation at the nodes as deviation from the preload, m.
    pub indentations: Nodal<S>,
    /// Its velocity at the nodes, m/s.
    pub rates: Nodal<S>,
    /// Displacement of the fixed contact at the end, m.
    pub support: f64,
    /// Indentation at the end as deviation from the preload, m.
    pub indentation: f64,
    /// Its velocity at the end, m/s.
    pub rate: f64,
    /// Estimate of the error this step adds to the contact force, N.
    pub error: f64,
    /// Error below which it says nothing, being lost in rounding, N.
    pub rounding: f64,
    /// Contact force that the polynomial misses at the start, N.
    pub missed: f64,
    /// Newton iterations spent.
    pub iterations: u64,
    /// Of the law.
    pub slopes: Slopes,
}

/// How the law answers within a step; nothing where the force does not depend on the motion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slopes {
    /// Greatest stiffness at the nodes, N/m.
    pub stiffness: f64,
    /// Greatest damping at the nodes, N s/m.
    pub damping: f64,
    /// Change of the law's force at the end, at these, per force on the tip throughout the step.
    pub gain: f64,
}

/// The nodal forces of a step on the closed branch.
struct Solution<const S: usize> {
    /// Deviation from the preload force, N.
    forces: Nodal<S>,
    iterations: u64,
    /// Displacement and velocity of the tip at the end per force that the polynomial misses at the start.
    by_force: (f64, f64),
    /// The same per base acceleration.
    by_acceleration: (f64, f64),
    slopes: Slopes,
}

impl<const S: usize> Solution<S> {
    /// A force that does not depend on the motion.
    fn constant(force: f64) -> Self {
        Self {
            forces: [force; S],
            iterations: 0,
            by_force: (0.0, 0.0),
            by_acceleration: (0.0, 0.0),
            slopes: Slopes::default(),
        }
    }
}

/// Rounding of a contact force, relative to it.
const ROUNDING: f64 = 1e-13;

/// Rounding of the motion at the nodes, relative to what it would be without contact force.
const MOTION_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A pivot this small would multiply the rounding by its inverse in each elimination, and one beside entries larger than its
/// inverse.
const SMALL_PIVOT: f64 = 0.1;

/// Mean over a step of what the nodal polynomial misses of the square root of time from its start, over what it misses at the start.
const KINKED: f64 = 0.015;

/// Steps from a kink beyond which it is not felt.
const FAR: f64 = 20.0;

/// Newton iterations before a step is judged too long.
const ITERATIONS: u64 = 12;

impl Model {
    /// The step from `state` with the given coefficients, on the branch the state is on, with the modes at its end in
    /// `end_modes`; `None` where Newton's method does not converge.
    pub fn trial<const S: usize>(
        &self,
        state: &State,
        drive: &Drive,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        source: Source,
        end_modes: &mut ModeStates,
    ) -> Option<Trial<S>> {
        compiled_for!(self.machine, A => self.compute::<S, A>(state, drive, step, collocation, source, end_modes))
    }

    /// [`Model::trial`] for a machine.
    #[inline(always)]
    fn compute<const S: usize, A: Arithmetic>(
        &self,
        state: &State,
        drive: &Drive,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        source: Source,
        end_modes: &mut ModeStates,
    ) -> Option<Trial<S>> {
        let h = step.length;
        let generated = self.generator.over_step(state.time, &step.turns);
        let mut accelerations = generated.nodes;
        for acceleration in &mut accelerations {
            *acceleration += drive.acceleration;
        }

        // Indentation at the nodes without contact force.
        let mut free = [state.support; S];
        add_times::<S, A>(&mut free, &collocation.nodes, drive.support_rate * h);
        let mut free_rate = [drive.support_rate; S];
        // A sum of its own for q and v each: they do not wait for one another.
        let [mut from_q, mut from_v, mut rate_from_q, mut rate_from_v] = [[0.0; S]; 4];
        for (mode, row) in state.modes.iter().zip(&step.modes) {
            add_times::<S, A>(&mut from_q, &row.tip_from_q, mode.q);
            add_times::<S, A>(&mut from_v, &row.tip_from_v, mode.v);
            add_times::<S, A>(&mut rate_from_q, &row.rate_from_q, mode.q);
            add_times::<S, A>(&mut rate_from_v, &row.rate_from_v, mode.v);
        }
        subtract(&mut free, &from_q, &from_v);
        subtract(&mut free_rate, &rate_from_q, &rate_from_v);
        add_columns::<S, A>(&mut free, &step.acceleration.displacement, &accelerations);
        add_columns::<S, A>(&mut free_rate, &step.acceleration.velocity, &accelerations);

        let solution = match source {
            Source::Law(newton) if state.closed => {
                self.closed_forces::<S, A>(state, step, collocation, &free, &free_rate, newton)?
            }
            Source::Law(_) => Solution::constant(-self.preload.force),
            Source::Constant(force) => Solution::constant(force),
        };
        let Solution { forces, iterations, .. } = solution;
        let (indentations, rates) = at_nodes::<S, A>(step, &free, &free_rate, &forces);

        let support = state.support + drive.support_rate * h;
        let (tip, tip_rate) = end_of_modes::<S, A>(state, step, self.modes.len(), &forces, &accelerations, end_modes);
        let (indentation, rate) = (support - tip, drive.support_rate - tip_rate);

        let at_start = drive.acceleration + generated.start;
        let largest = forces.iter().fold(0.0_f64, |largest, force| {
            largest.max((self.preload.force + force).abs())
        });
        let error = self.error::<S, A>(
            state,
            step,
            collocation,
            &solution,
            at_start - dot::<S, A>(&accelerations, &collocation.at_start),
            largest,
        );
        Some(Trial {
            forces,
            indentations,
            rates,
            support,
            indentation,
            rate,
            error,
            rounding: ROUNDING * largest.max(self.preload.force),
            missed: if state.closed {
                (state.force - self.preload.force - dot::<S, A>(&forces, &collocation.at_start)).abs()
            } else {
                0.0
            },
            iterations,
            slopes: solution.slopes,
        })
    }

    /// Estimate of what a step adds to the error of the contact force, N.
    ///
    /// At the nodes the polynomials are right; what they miss at the start tells how much of the shape that vanishes at the
    /// nodes they lack. What that does to the nodal forces is known to first order ([`Solution`]). Modes slow against the step
    /// hardly feel it at the end (the shape is orthogonal to polynomials of low degree); they see an error of twice the order,
    /// about three times the square of what is missed (an impact of a free mass on a Hertz contact). Just after a touch or a
    /// jump the force is no polynomial of any degree, and they see more.
    #[inline(always)]
    fn error<const S: usize, A: Arithmetic>(
        &self,
        state: &State,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        solution: &Solution<S>,
        missed_acceleration: f64,
        largest: f64,
    ) -> f64 {
        if state.closed {
            let missed = state.force - self.preload.force - dot::<S, A>(&solution.forces, &collocation.at_start);
            let (by_force, by_acceleration) = (solution.by_force, solution.by_acceleration);
            let wrong_d = by_acceleration.0 * missed_acceleration - by_force.0 * missed;
            let wrong_r = by_acceleration.1 * missed_acceleration - by_force.1 * missed;
            let fast = (solution.slopes.stiffness * wrong_d).abs() + (solution.slopes.damping * wrong_r).abs();
            let elapsed = state.time - state.last_kink;
            let kinked = if elapsed < FAR * step.length {
                KINKED * missed.abs() * analytic::<S>(elapsed / step.length)
            } else {
                0.0
            };
            let slow = 3.0 * missed * missed / largest + kinked;
            fast + slow * solution.slopes.gain / (1.0 + solution.slopes.gain)
        } else {
            let last = |values: &Nodal<S>| values.last().map_or(0.0, |value| (value * missed_acceleration).abs());
            let rows = &step.acceleration_error;
            let wrong = last(&rows.displacement) + self.law.damping() * last(&rows.velocity);
            self.law.tangent_stiffness(self.force_scale) * wrong
        }
    }

    /// Newton's method for the nodal forces on the closed branch.
    #[inline(always)]
    fn closed_forces<const S: usize, A: Arithmetic>(
        &self,
        state: &State,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        free: &Nodal<S>,
        free_rate: &Nodal<S>,
        newton: f64,
    ) -> Option<Solution<S>> {
        let mut forces = if state.last_step > 0.0 {
            collocation.predict::<A>(&state.predictions, step.length / state.last_step)
        } else {
            [state.force - self.preload.force; S]
        };
        let d0 = self.preload.indentation;
        let greatest = |values: &Nodal<S>| values.iter().fold(0.0_f64, |greatest, value| greatest.max(value.abs()));
        let (farthest, fastest) = (greatest(free), greatest(free_rate));
        let mut by_errors = None;
        for iterations in 0..=ITERATIONS {
            let (indentations, rates) = at_nodes::<S, A>(step, free, free_rate, &forces);
            let mut residual = forces;
            let (mut stiffness, mut damping) = ([0.0; S], [0.0; S]);
            for ((((residual, stiffness), damping), d), rate) in residual
                .iter_mut()
                .zip(&mut stiffness)
                .zip(&mut damping)
                .zip(&indentations)
                .zip(&rates)
            {
                let law = self.law.closed_branch(d0 + d, *rate);
                *residual -= law.force - self.preload.force;
                (*stiffness, *damping) = (law.stiffness, law.damping);
            }
            // The motion has to obey the law, not only the nodal forces to be right: on a stiff contact they hardly depend
            // on it. What rounding leaves of the motion is all that can be asked.
            let rounding = MOTION_ROUNDING * (greatest(&stiffness) * farthest + greatest(&damping) * fastest);
            if let Some((force_error, acceleration_error)) =
                by_errors.filter(|_| greatest(&residual) <= newton.max(rounding))
            {
                return Some(Solution::new(
                    step,
                    forces,
                    iterations,
                    (greatest(&stiffness), greatest(&damping)),
                    &force_error,
                    &acceleration_error,
                ));
            }
            // The derivative of the residuals by each nodal force.
            let mut jacobian = step.force.displacement;
            for (column, velocity) in jacobian.iter_mut().zip(&step.force.velocity) {
                for (((entry, velocity), stiffness), damping) in
                    column.iter_mut().zip(velocity).zip(&stiffness).zip(&damping)
                {
                    *entry = A::mul_add(*stiffness, *entry, damping * velocity);
                }
            }
            let force_error = react::<S, A>(&step.force_error, &stiffness, &damping);
            let acceleration_error = react::<S, A>(&step.acceleration_error, &stiffness, &damping);
            let [correction, force_error, acceleration_error] =
                solve::<S, 3, A>(jacobian, [residual, force_error, acceleration_error])?;
            for (force, correction) in forces.iter_mut().zip(&correction) {
                *force -= correction;
            }
            by_errors = Some((force_error, acceleration_error));
        }
        None
    }
}

impl<const S: usize> Solution<S> {
    /// The effects at the end of the nodal forces that the errors cause.
    #[inline(always)]
    fn new(
        step: &StepCoefficients<S>,
        forces: Nodal<S>,
        iterations: u64,
        (stiffness, damping): (f64, f64),
        force_error: &Nodal<S>,
        acceleration_error: &Nodal<S>,
    ) -> Self {
        let last = |columns: &[Nodal<S>; S], loads: &Nodal<S>| {
            let entries = columns.iter().filter_map(|column| column.last());
            entries.zip(loads).map(|(entry, load)| entry * load).sum::<f64>()
        };
        let tip = |error: &ErrorColumn<S>, loads: &Nodal<S>| {
            let end = |values: &Nodal<S>| values.last().copied().unwrap_or_default();
            (
                end(&error.displacement) - last(&step.force.displacement, loads),
                end(&error.velocity) - last(&step.force.velocity, loads),
            )
        };
        let steady = [1.0; S];
        let gain = stiffness * last(&step.force.displacement, &steady) + damping * last(&step.force.velocity, &steady);
        Self {
            forces,
            iterations,
            by_force: tip(&step.force_error, force_error),
            by_acceleration: tip(&step.acceleration_error, acceleration_error),
            slopes: Slopes {
                stiffness,
                damping,
                gain: gain.max(0.0),
            },
        }
    }
}

/// How much less of a root of time its quadrature with `S` nodes misses, over what the nodal polynomial misses, where its
/// branch point lies `distance` steps before the step: the polynomial converges with the power `S` of the size of the ellipse in
/// which the root is analytic, the quadrature with the power `2 S - 1` (L. N. Trefethen, Approximation Theory and Approximation
/// Practice, 2013, chapters 8 and 19).
fn analytic<const S: usize>(distance: f64) -> f64 {
    let ellipse = 1.0 + 2.0 * distance + 2.0 * (distance * (distance + 1.0)).sqrt();
    (1..S).fold(1.0, |product, _| product / ellipse)
}

/// Modes computed at once.
const LANES: usize = 4;

/// The modes in use at the end of a step, into `ends`. Returns displacement and velocity of the tip.
#[inline(always)]
#[expect(
    clippy::indexing_slicing,
    reason = "the room for the modes is a whole number of lanes"
)]
fn end_of_modes<const S: usize, A: Arithmetic>(
    state: &State,
    step: &StepCoefficients<S>,
    modes: usize,
    forces: &Nodal<S>,
    accelerations: &Nodal<S>,
    ends: &mut ModeStates,
) -> (f64, f64) {
    let rows = &step.end;
    let (mut tip, mut tip_rate) = ([0.0; LANES], [0.0; LANES]);
    let lanes = |values: &Modal, first: usize| -> [f64; LANES] { std::array::from_fn(|i| values[first + i]) };
    for first in (0..modes).step_by(LANES) {
        let starts = &state.modes[first..first + LANES];
        let (start_q, start_v): ([f64; LANES], [f64; LANES]) = (
            std::array::from_fn(|i| starts[i].q),
            std::array::from_fn(|i| starts[i].v),
        );
        let (tips, participations) = (lanes(&rows.tip, first), lanes(&rows.participation, first));
        let (mut q, mut v) = ([0.0; LANES], [0.0; LANES]);
        add::<LANES, A>(&mut q, &lanes(&rows.q_from_q, first), &start_q);
        add::<LANES, A>(&mut q, &lanes(&rows.q_from_v, first), &start_v);
        add::<LANES, A>(&mut v, &lanes(&rows.v_from_q, first), &start_q);
        add::<LANES, A>(&mut v, &lanes(&rows.v_from_v, first), &start_v);
        for node in 0..S {
            let mut load = [0.0; LANES];
            for i in 0..LANES {
                load[i] = A::mul_add(tips[i], forces[node], -participations[i] * accelerations[node]);
            }
            add::<LANES, A>(&mut q, &lanes(&rows.q_from_load[node], first), &load);
            add::<LANES, A>(&mut v, &lanes(&rows.v_from_load[node], first), &load);
        }
        add::<LANES, A>(&mut tip, &tips, &q);
        add::<LANES, A>(&mut tip_rate, &tips, &v);
        for (end, (q, v)) in ends[first..first + LANES].iter_mut().zip(q.iter().zip(&v)) {
            (end.q, end.v) = (*q, *v);
        }
    }
    (tip.iter().sum(), tip_rate.iter().sum())
}

/// Adds the products of the values.
#[inline(always)]
fn add<const N: usize, A: Arithmetic>(sum: &mut [f64; N], a: &[f64; N], b: &[f64; N]) {
    for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
        *sum = A::mul_add(*a, *b, *sum);
    }
}

/// Solves `(1 + A) x = b` for several `b`, `A` column by column, by Gauss-Jordan elimination, whose inner loops run down
/// columns; rows are exchanged only where a pivot is small or the contact is stiff against the step. `None` where the matrix
/// is singular.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
#[inline(always)]
fn solve<const S: usize, const R: usize, A: Arithmetic>(
    mut a: [Nodal<S>; S],
    mut right: [Nodal<S>; R],
) -> Option<[Nodal<S>; R]> {
    for (k, column) in a.iter_mut().enumerate() {
        column[k] += 1.0;
    }
    let stiff = a[S - 1][S - 1].abs() > 1.0 / SMALL_PIVOT;
    for p in 0..S {
        if stiff || a[p][p].abs() < SMALL_PIVOT {
            let largest = (p..S).max_by(|i, j| a[p][*i].abs().total_cmp(&a[p][*j].abs()))?;
            for column in a.iter_mut().chain(&mut right) {
                column.swap(p, largest);
            }
        }
        let pivot = a[p];
        let inverse = 1.0 / pivot[p];
        let eliminate = |column: &mut Nodal<S>| {
            let share = column[p] * inverse;
            for k in 0..S {
                column[k] = A::mul_add(-pivot[k], share, column[k]);
            }
            column[p] = share;
        };
        a.iter_mut().skip(p + 1).chain(&mut right).for_each(eliminate);
    }
    right.iter().flatten().all(|x| x.is_finite()).then_some(right)
}

/// Forces of the law at the nodes that belong to displacements and velocities of the tip.
#[inline(always)]
fn react<const S: usize, A: Arithmetic>(tip: &ErrorColumn<S>, stiffness: &Nodal<S>, damping: &Nodal<S>) -> Nodal<S> {
    let mut forces = tip.displacement;
    for (((force, velocity), stiffness), damping) in forces.iter_mut().zip(&tip.velocity).zip(stiffness).zip(damping) {
        *force = A::mul_add(*stiffness, *force, damping * velocity);
    }
    forces
}

/// Indentation and its velocity at the nodes under the nodal forces.
#[inline(always)]
fn at_nodes<const S: usize, A: Arithmetic>(
    step: &StepCoefficients<S>,
    free: &Nodal<S>,
    free_rate: &Nodal<S>,
    forces: &Nodal<S>,
) -> (Nodal<S>, Nodal<S>) {
    let (mut indentations, mut rates) = (*free, *free_rate);
    let mut loads = *forces;
    for load in &mut loads {
        *load = -*load;
    }
    add_columns::<S, A>(&mut indentations, &step.force.displacement, &loads);
    add_columns::<S, A>(&mut rates, &step.force.velocity, &loads);
    (indentations, rates)
}

#[inline(always)]
fn add_columns<const S: usize, A: Arithmetic>(values: &mut Nodal<S>, columns: &[Nodal<S>; S], loads: &Nodal<S>) {
    for (column, load) in columns.iter().zip(loads) {
        add_times::<S, A>(values, column, *load);
    }
}

#[inline(always)]
fn add_times<const S: usize, A: Arithmetic>(values: &mut Nodal<S>, a: &Nodal<S>, x: f64) {
    for (value, a) in values.iter_mut().zip(a) {
        *value = A::mul_add(*a, x, *value);
    }
}

#[inline(always)]
fn subtract<const S: usize>(values: &mut Nodal<S>, a: &Nodal<S>, b: &Nodal<S>) {
    for ((value, a), b) in values.iter_mut().zip(a).zip(b) {
        *value -= a + b;
    }
}
