//! One step: the nodal contact forces and the motion they give.

use crate::model::{ModeStates, Model, State};
use crate::transient::coefficients::{ErrorRows, StepCoefficients};
use crate::transient::collocation::{Collocation, Nodal, dot};

/// What drives the contact over a communication step.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Base acceleration from the input, m/s2.
    pub acceleration: f64,
    /// Velocity of the fixed contact, m/s.
    pub support_rate: f64,
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
}

/// Newton iterations before a step is judged too long.
const ITERATIONS: u64 = 12;

impl Model {
    /// The step from `state` with the given coefficients, on the branch the state is on, with the modes at its end in
    /// `end_modes`; `None` where Newton's method does not converge. `newton` is the largest last correction of a nodal
    /// force, N.
    pub fn trial<const S: usize>(
        &self,
        state: &State,
        drive: &Drive,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        newton: f64,
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

        let (forces, iterations) = if state.closed {
            self.closed_forces(state, step, collocation, &free, &free_rate, newton)?
        } else {
            ([-self.preload.force; S], 0)
        };
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

        // What the nodal polynomials miss at both ends of the step belongs to P(2x-1) and (2x-1) P(2x-1).
        let missed = |values: &Nodal<S>, start: f64, end: f64| {
            let sign = if S.is_multiple_of(2) { 1.0 } else { -1.0 };
            let start = sign * (start - dot(values, &collocation.at_start));
            let end = end - dot(values, &collocation.at_end);
            [f64::midpoint(end, start), 0.5 * (end - start)]
        };
        let d = self.preload.indentation + indentation;
        let end_law = self.law.closed_branch(d, rate);
        let missed_force = if state.closed {
            missed(
                &forces,
                state.force - self.preload.force,
                end_law.force - self.preload.force,
            )
        } else {
            [0.0; 2]
        };
        let missed_acceleration = missed(
            &accelerations,
            drive.acceleration + generated.start,
            drive.acceleration + generated.end,
        );
        let wrong = |rows: &ErrorRows, missed: [f64; 2]| (dot2(rows.displacement, missed), dot2(rows.velocity, missed));
        let (force_d, force_r) = wrong(&step.force_error, missed_force);
        let (base_d, base_r) = wrong(&step.acceleration_error, missed_acceleration);
        let (wrong_d, wrong_r) = (base_d - force_d, base_r - force_r);
        let error = if state.closed {
            let last = |columns: &[Nodal<S>; S]| columns.iter().filter_map(|column| column.last()).sum::<f64>();
            let gain =
                end_law.stiffness * last(&step.force.displacement) + end_law.damping * last(&step.force.velocity);
            (end_law.stiffness * wrong_d + end_law.damping * wrong_r).abs() / (1.0 + gain.max(0.0))
        } else {
            let stiffness = self.law.tangent_stiffness(self.force_scale);
            stiffness * (wrong_d.abs() + self.law.damping() * wrong_r.abs())
        };
        Some(Trial {
            forces,
            indentations,
            rates,
            support,
            indentation,
            rate,
            error,
            iterations,
        })
    }

    /// Newton's method for the nodal forces on the closed branch; with the number of iterations.
    fn closed_forces<const S: usize>(
        &self,
        state: &State,
        step: &StepCoefficients<S>,
        collocation: &Collocation<S>,
        free: &Nodal<S>,
        free_rate: &Nodal<S>,
        newton: f64,
    ) -> Option<(Nodal<S>, u64)> {
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
            let correction = solve(jacobian, residual)?;
            let (mut largest, mut lowest) = (0.0_f64, f64::INFINITY);
            for (force, correction) in forces.iter_mut().zip(&correction) {
                *force -= correction;
                largest = largest.max(correction.abs());
                lowest = lowest.min(self.preload.force + *force);
            }
            // Newton's method leaves about correction^2 / (6 F) where the law is Hertz's, nothing where it is linear.
            if largest <= newton || largest * largest <= newton * lowest {
                return Some((forces, iteration));
            }
        }
        None
    }
}

/// Solves `(1 + A) x = b`, `A` column by column, by Gauss-Jordan elimination, whose inner loops run down columns; rows are
/// exchanged only where a pivot is small, which happens in violent steps alone. `None` where the matrix is singular.
#[expect(
    clippy::indexing_slicing,
    reason = "every index runs over the fixed size of the arrays"
)]
fn solve<const S: usize>(mut a: [Nodal<S>; S], mut x: Nodal<S>) -> Option<Nodal<S>> {
    for (k, column) in a.iter_mut().enumerate() {
        column[k] += 1.0;
    }
    for p in 0..S {
        if a[p][p].abs() < 0.1 {
            let largest = (p..S).max_by(|i, j| a[p][*i].abs().total_cmp(&a[p][*j].abs()))?;
            a.iter_mut().for_each(|column| column.swap(p, largest));
            x.swap(p, largest);
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
        a.iter_mut().skip(p + 1).for_each(eliminate);
        eliminate(&mut x);
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
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

fn dot2(a: [f64; 2], b: [f64; 2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
