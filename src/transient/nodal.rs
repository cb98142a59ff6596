//! One step: the nodal contact forces and the motion they give.

use nalgebra::{SMatrix, SVector};

use crate::model::{ModeStates, Model, State};
use crate::transient::coefficients::{ErrorRows, StepCoefficients};
use crate::transient::collocation::{Collocation, NODES, Nodal, dot};

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
pub struct Trial {
    /// Nodal forces as deviation from the preload force, N.
    pub forces: Nodal,
    /// Indentation at the nodes as deviation from the preload, m.
    pub indentations: Nodal,
    /// Its velocity at the nodes, m/s.
    pub rates: Nodal,
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
    pub fn trial(
        &self,
        state: &State,
        drive: &Drive,
        step: &StepCoefficients,
        collocation: &Collocation,
        newton: f64,
        end_modes: &mut ModeStates,
    ) -> Option<Trial> {
        let h = step.length;
        let generated = self.generator.over_step(state.time, &step.turns);
        let accelerations = generated.nodes.map(|generated| drive.acceleration + generated);

        // Indentation at the nodes without contact force.
        let mut free = collocation
            .nodes
            .map(|node| state.support + drive.support_rate * (node * h));
        let mut free_rate = [drive.support_rate; NODES];
        for (mode, row) in state.modes.iter().zip(&step.modes) {
            subtract(&mut free, &row.tip_from_q, mode.q, &row.tip_from_v, mode.v);
            subtract(&mut free_rate, &row.rate_from_q, mode.q, &row.rate_from_v, mode.v);
        }
        for ((free, free_rate), (row, row_rate)) in free
            .iter_mut()
            .zip(&mut free_rate)
            .zip(step.acceleration.displacement.iter().zip(&step.acceleration.velocity))
        {
            *free += dot(row, &accelerations);
            *free_rate += dot(row_rate, &accelerations);
        }

        let (forces, iterations) = if state.closed {
            self.closed_forces(state, step, collocation, &free, &free_rate, newton)?
        } else {
            ([-self.preload.force; NODES], 0)
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
        let missed = |values: &Nodal, start: f64, end: f64| {
            let sign = if NODES.is_multiple_of(2) { 1.0 } else { -1.0 };
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
            let last = |rows: &[Nodal; NODES]| rows.last().map_or(0.0, |row| row.iter().sum::<f64>());
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
    fn closed_forces(
        &self,
        state: &State,
        step: &StepCoefficients,
        collocation: &Collocation,
        free: &Nodal,
        free_rate: &Nodal,
        newton: f64,
    ) -> Option<(Nodal, u64)> {
        let mut forces = if state.last_step > 0.0 {
            let ratio = step.length / state.last_step;
            collocation
                .nodes
                .map(|node| collocation.interpolate(&state.nodal_forces, 1.0 + node * ratio))
        } else {
            [state.force - self.preload.force; NODES]
        };
        let d0 = self.preload.indentation;
        for iteration in 1..=ITERATIONS {
            let (indentations, rates) = at_nodes(step, free, free_rate, &forces);
            let laws = indentations
                .iter()
                .zip(&rates)
                .map(|(d, rate)| self.law.closed_branch(d0 + d, *rate));
            let rows = step.force.displacement.iter().zip(&step.force.velocity);
            let mut residual = forces;
            // Row by row dF/d(nodal force), column-major as nalgebra stores it: the transpose of the Jacobian.
            let mut jacobian = [[0.0; NODES]; NODES];
            for ((law, (row, row_rate)), (residual, gradient)) in
                laws.zip(rows).zip(residual.iter_mut().zip(&mut jacobian))
            {
                *residual -= law.force - self.preload.force;
                for ((entry, compliance), mobility) in gradient.iter_mut().zip(row).zip(row_rate) {
                    *entry = law.stiffness * compliance + law.damping * mobility;
                }
            }
            let jacobian =
                SMatrix::<f64, NODES, NODES>::from(jacobian).transpose() + SMatrix::<f64, NODES, NODES>::identity();
            let residual = SVector::from(residual);
            let correction = jacobian.lu().solve(&residual)?;
            for (force, correction) in forces.iter_mut().zip(correction.iter()) {
                *force -= correction;
            }
            let largest = correction.amax();
            if !largest.is_finite() {
                return None;
            }
            if largest <= newton {
                return Some((forces, iteration));
            }
        }
        None
    }
}

/// Indentation and its velocity at the nodes under the nodal forces.
fn at_nodes(step: &StepCoefficients, free: &Nodal, free_rate: &Nodal, forces: &Nodal) -> (Nodal, Nodal) {
    let (mut indentations, mut rates) = (*free, *free_rate);
    for (indentation, row) in indentations.iter_mut().zip(&step.force.displacement) {
        *indentation -= dot(row, forces);
    }
    for (rate, row) in rates.iter_mut().zip(&step.force.velocity) {
        *rate -= dot(row, forces);
    }
    (indentations, rates)
}

fn subtract(values: &mut Nodal, a: &Nodal, x: f64, b: &Nodal, y: f64) {
    for ((value, a), b) in values.iter_mut().zip(a).zip(b) {
        *value -= a * x + b * y;
    }
}

fn dot2(a: [f64; 2], b: [f64; 2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
