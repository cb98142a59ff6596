//! One step: the nodal contact forces and the motion they give.

use crate::model::{ModeStates, Model, State};
use crate::transient::coefficients::{ErrorColumn, StepCoefficients};
use crate::transient::collocation::{Collocation, Nodal, dot};

/// What drives the contact over a communication step.
#[derive(Clone, Copy, Debug)]
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
        let h = step.length;
        let generated = self.generator.over_step(state.time, &step.turns);
        let accelerations = generated.nodes.map(|generated| drive.acceleration + generated);

        // Indentation at the nodes without contact force.
        let mut free = collocation
            .nodes
            .map(|node| state.support + drive.support_rate * (node * h));
        let mut free_rate = [drive.support_rate; S];
        for (mode, row) in state.modes.iter().zip(&step.modes) {
            subtract(&mut free, &row.tip_from_q, mode.q, &row.tip_from_v, mode.v);
            subtract(&mut free_rate, &row.rate_from_q, mode.q, &row.rate_from_v, mode.v);
        }
        add_columns(&mut free, &step.acceleration.displacement, &accelerations);
        add_columns(&mut free_rate, &step.acceleration.velocity, &accelerations);

        let solution = match source {
            Source::Law(newton) if state.closed => {
                self.closed_forces(state, step, collocation, &free, &free_rate, newton)?
            }
            Source::Law(_) => Solution::constant(-self.preload.force),
            Source::Constant(force) => Solution::constant(force),
        };
        let Solution { forces, iterations, .. } = solution;
        let (indentations, rates) = at_nodes(step, &free, &free_rate, &forces);

        let support = state.support + drive.support_rate * h;
        let (mut indentation, mut rate) = (support, drive.support_rate);
        for (((end, start), row), mode) in end_modes.iter_mut().zip(&state.modes).zip(&step.modes).zip(&self.modes) {
            let mut load = forces;
            for (load, acceleration) in load.iter_mut().zip(&accelerations) {
                *load = mode.tip * *load - mode.participation * acceleration;
            }
            end.q = row.q_from_q * start.q + row.q_from_v * start.v + dot(&row.q_from_load, &load);
            end.v = row.v_from_q * start.q + row.v_from_v * start.v + dot(&row.v_from_load, &load);
            indentation -= mode.tip * end.q;
            rate -= mode.tip * end.v;
        }

        let at_start = drive.acceleration + generated.start;
        let error = self.error(
            state,
            step,
            collocation,
            &solution,
            at_start - dot(&accelerations, &collocation.at_start),
        );
        Some(Trial {
            forces,
            indentations,
            rates,
            support,
            indentation,
            rate,
            error,
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
    fn error<const S: usize>(
        &self,
        state: &State,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        solution: &Solution<S>,
        missed_acceleration: f64,
    ) -> f64 {
        let forces = &solution.forces;
        let largest = forces.iter().fold(0.0_f64, |largest, force| {
            largest.max((self.preload.force + force).abs())
        });
        let error = if state.closed {
            let missed = state.force - self.preload.force - dot(forces, &collocation.at_start);
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
        };
        // Below the rounding of the force the estimate says nothing. (Not `max`, which would hide a NaN.)
        if error <= ROUNDING * largest.max(self.preload.force) {
            0.0
        } else {
            error
        }
    }

    /// Newton's method for the nodal forces on the closed branch.
    fn closed_forces<const S: usize>(
        &self,
        state: &State,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        free: &Nodal<S>,
        free_rate: &Nodal<S>,
        newton: f64,
    ) -> Option<Solution<S>> {
        let mut forces = if state.last_step > 0.0 {
            collocation.predict(&state.predictions, step.length / state.last_step)
        } else {
            [state.force - self.preload.force; S]
        };
        let d0 = self.preload.indentation;
        for iteration in 1..=ITERATIONS {
            let (indentations, rates) = at_nodes(step, free, free_rate, &forces);
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
            // The derivative of the residuals by each nodal force.
            let mut jacobian = step.force.displacement;
            for (column, velocity) in jacobian.iter_mut().zip(&step.force.velocity) {
                for (((entry, velocity), stiffness), damping) in
                    column.iter_mut().zip(velocity).zip(&stiffness).zip(&damping)
                {
                    *entry = stiffness * *entry + damping * velocity;
                }
            }
            let force_error = react(&step.force_error, &stiffness, &damping);
            let acceleration_error = react(&step.acceleration_error, &stiffness, &damping);
            let [correction, force_error, acceleration_error] =
                solve(jacobian, [residual, force_error, acceleration_error])?;
            let (mut largest, mut lowest) = (0.0_f64, f64::INFINITY);
            for (force, correction) in forces.iter_mut().zip(&correction) {
                *force -= correction;
                largest = largest.max(correction.abs());
                lowest = lowest.min(self.preload.force + *force);
            }
            // Newton's method leaves about correction^2 / (6 F) where the law is Hertz's, nothing where it is linear.
            let done = largest <= newton || largest * largest <= newton * lowest;
            let rounding = |force: &f64| largest <= ROUNDING * (self.preload.force + force);
            if done || forces.iter().any(rounding) {
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
                let greatest = |values: &Nodal<S>| values.iter().copied().fold(0.0, f64::max);
                let (stiffness, damping) = (greatest(&stiffness), greatest(&damping));
                let steady = [1.0; S];
                let gain =
                    stiffness * last(&step.force.displacement, &steady) + damping * last(&step.force.velocity, &steady);
                return Some(Solution {
                    forces,
                    iterations: iteration,
                    by_force: tip(&step.force_error, &force_error),
                    by_acceleration: tip(&step.acceleration_error, &acceleration_error),
                    slopes: Slopes {
                        stiffness,
                        damping,
                        gain: gain.max(0.0),
                    },
                });
            }
        }
        None
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

/// Solves `(1 + A) x = b` for several `b`, `A` column by column, by Gauss-Jordan elimination, whose inner loops run down
/// columns; rows are exchanged only where a pivot is small or the contact is stiff against the step. `None` where the matrix
/// is singular.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
fn solve<const S: usize, const R: usize>(mut a: [Nodal<S>; S], mut right: [Nodal<S>; R]) -> Option<[Nodal<S>; R]> {
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
                column[k] -= pivot[k] * share;
            }
            column[p] = share;
        };
        a.iter_mut().skip(p + 1).chain(&mut right).for_each(eliminate);
    }
    right.iter().flatten().all(|x| x.is_finite()).then_some(right)
}

/// Forces of the law at the nodes that belong to displacements and velocities of the tip.
fn react<const S: usize>(tip: &ErrorColumn<S>, stiffness: &Nodal<S>, damping: &Nodal<S>) -> Nodal<S> {
    let mut forces = tip.displacement;
    for (((force, velocity), stiffness), damping) in forces.iter_mut().zip(&tip.velocity).zip(stiffness).zip(damping) {
        *force = stiffness * *force + damping * velocity;
    }
    forces
}

/// Indentation and its velocity at the nodes under the nodal forces.
fn at_nodes<const S: usize>(
    step: &StepCoefficients<S>,
    free: &Nodal<S>,
    free_rate: &Nodal<S>,
    forces: &Nodal<S>,
) -> (Nodal<S>, Nodal<S>) {
    let (mut indentations, mut rates) = (*free, *free_rate);
    let loads = forces.map(|force| -force);
    add_columns(&mut indentations, &step.force.displacement, &loads);
    add_columns(&mut rates, &step.force.velocity, &loads);
    (indentations, rates)
}

fn add_columns<const S: usize>(values: &mut Nodal<S>, columns: &[Nodal<S>; S], loads: &Nodal<S>) {
    for (column, load) in columns.iter().zip(loads) {
        for (value, entry) in values.iter_mut().zip(column) {
            *value += entry * load;
        }
    }
}

fn subtract<const S: usize>(values: &mut Nodal<S>, a: &Nodal<S>, x: f64, b: &Nodal<S>, y: f64) {
    for ((value, a), b) in values.iter_mut().zip(a).zip(b) {
        *value -= a * x + b * y;
    }
}
