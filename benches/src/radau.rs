//! The reference: Radau IIA with five stages (order 9; Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5), an
//! implicit Runge-Kutta method with short fixed steps, graded geometrically after each opening and closing, where the force
//! begins as the square root of time. Its error is estimated by doubling the number of steps.
//!
//! The modes are integrated by the Runge-Kutta method and not by exact exponentials as in the component. Within a
//! step every stage of every mode is linear in the contact forces at the stages, which leaves five equations for Newton.

use nalgebra::{SMatrix, SVector};
use testing::scenes::largest_difference;

use crate::integrator::Failure;
use crate::problem::Problem;

const STAGES: usize = 5;
/// Ratio of neighbouring steps after an opening or a closing.
const GROWTH: f64 = 1.1;
type Matrix = SMatrix<f64, STAGES, STAGES>;
type Vector = SVector<f64, STAGES>;

/// The reference solution.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Contact force at the grid times, N.
    pub forces: Vec<f64>,
    /// Times at which the contact opened and closed, alternating, s.
    pub events: Vec<f64>,
    /// Its error in the force, relative to the force scale.
    pub force_error: f64,
    /// Its error in these times, s.
    pub event_error: f64,
}

impl Reference {
    /// The reference of a problem, with steps of at most `step` seconds and of half of that.
    /// It fails where Newton's method does at any step length, or the two runs do not open equally often.
    pub fn new(problem: &Problem, step: f64) -> Result<Self, Failure> {
        let (coarse_forces, coarse_events) = Motion::new(problem, step, GROWTH).run()?;
        let (forces, events) = Motion::new(problem, 0.5 * step, GROWTH.sqrt()).run()?;
        if coarse_events.len() != events.len() {
            return Err(Failure::Stopped("the reference has another number of openings with halved steps".to_owned()));
        }
        Ok(Self {
            force_error: largest_difference(&coarse_forces, &forces) / problem.model.force_scale,
            event_error: largest_difference(&coarse_events, &events),
            forces,
            events,
        })
    }
}

/// Nodes and weights of the method, for a unit step.
struct Tableau {
    c: Vector,
    a: Matrix,
}

/// The zeros of `P_5 - P_4`, of Legendre's polynomials, moved from `[-1, 1]` to `[0, 1]`.
const NODES: [f64; STAGES] =
    [0.057_104_196_114_517_68, 0.276_843_013_638_123_8, 0.583_590_432_368_916_8, 0.860_240_135_656_219_5, 1.0];

impl Tableau {
    /// The weights integrate powers of time, up to the fourth.
    fn new() -> Self {
        let c = Vector::from(NODES);
        let powers = Matrix::from_fn(|i, k| (0..k).fold(1.0, |power, _| power * c[i]));
        let integrals = Matrix::from_fn(|i, k| powers[(i, k)] * c[i] / (k + 1) as f64);
        let a = integrals * powers.try_inverse().expect("no node twice");
        Self { c, a }
    }
}

/// Displacement and velocity of a mode with compensated summation: over many short steps rounding would cost three digits.
#[derive(Clone, Copy, Default)]
struct ModeMotion {
    q: f64,
    q_low: f64,
    v: f64,
    v_low: f64,
}

impl ModeMotion {
    fn add(&mut self, (dq, dv): (f64, f64)) {
        (self.q, self.q_low) = compensated(self.q, self.q_low + dq);
        (self.v, self.v_low) = compensated(self.v, self.v_low + dv);
    }
}

/// The sum and its rounding error.
fn compensated(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, if a.abs() > b.abs() { b - (sum - a) } else { a - (sum - b) })
}

/// A step computed but not yet taken.
struct Trial {
    /// Change of displacement and velocity of each mode.
    changes: Vec<(f64, f64)>,
    /// Indentation and rate at the stages; the last is the end.
    d: Vector,
    rate: Vector,
}

struct Motion<'a> {
    problem: &'a Problem,
    tableau: Tableau,
    longest: f64,
    growth: f64,
    modes: Vec<ModeMotion>,
    closed: bool,
    /// Force at the last instant, N: the first guess of the next step.
    force: f64,
}

impl<'a> Motion<'a> {
    fn new(problem: &'a Problem, longest: f64, growth: f64) -> Self {
        Self {
            problem,
            tableau: Tableau::new(),
            longest,
            growth,
            modes: vec![ModeMotion::default(); problem.modes()],
            closed: problem.starts_closed(),
            force: problem.model.preload.force,
        }
    }

    /// Forces on the grid, and the instants of opening and closing.
    fn run(mut self) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let problem = self.problem;
        let mut forces = vec![self.force];
        let mut events = Vec::new();
        let cell = problem.end / f64::from(problem.cells);
        let steps = (cell / self.longest).ceil();
        let longest = cell / steps;
        // The motion of a contact at rest starts as a power of time too.
        let mut wanted = longest;
        for k in 0..problem.cells {
            let start = problem.instant(k);
            // Time within the cell, which keeps more digits than the time from the start.
            let mut done = 0.0;
            while cell - done > 1e-14 * cell {
                let rest = cell - done;
                let mut h = if rest < 1.5 * wanted { rest } else { wanted };
                let trial = loop {
                    match self.trial(start + done, h) {
                        Some(trial) => break trial,
                        None if h < 1e-20 => {
                            return Err(Failure::Stopped(format!("reference: no solution at {:.9e} s", start + done)));
                        }
                        None => h *= 0.5,
                    }
                };
                let (trial, h, switches) = self.cut(trial, start + done, h);
                done += h;
                self.take(trial);
                wanted = (h.max(wanted.min(h * self.growth)) * self.growth).min(longest);
                if switches {
                    events.push(start + done);
                    self.closed = !self.closed;
                    self.force = 0.0;
                    // So short that the square root is negligible.
                    wanted = 1e-15;
                }
                if events.len() > 10_000 {
                    return Err(Failure::Stopped("reference: too many openings and closings".to_owned()));
                }
            }
            forces.push(self.force);
        }
        Ok((forces, events))
    }

    fn take(&mut self, trial: Trial) {
        let law = &self.problem.model.law;
        let end = STAGES - 1;
        if self.closed {
            let force = law.closed_branch(trial.d[end], trial.rate[end]).force;
            self.force = if self.problem.can_open() { force.max(0.0) } else { force };
        }
        for (mode, change) in self.modes.iter_mut().zip(trial.changes) {
            mode.add(change);
        }
    }

    /// How far inside its branch the contact is, m.
    fn inside(&self, d: f64, rate: f64) -> f64 {
        let engagement = self.problem.model.law.engagement(d, rate);
        if self.closed { engagement } else { -engagement }
    }

    /// The step, or its part on this branch; whether the branch ends there.
    fn cut(&self, trial: Trial, time: f64, h: f64) -> (Trial, f64, bool) {
        let end = STAGES - 1;
        let outside = (0..STAGES).find(|i| self.inside(trial.d[*i], trial.rate[*i]) <= 0.0);
        let Some(outside) = outside else { return (trial, h, false) };
        // A branch begins at zero engagement: the shortest steps there are of it whatever rounding says.
        if h < 1e-13 {
            return (trial, h, false);
        }
        let mut bracket = (0.0, self.tableau.c[outside] * h);
        let mut best = (trial, h);
        for _ in 0..200 {
            let middle = f64::midpoint(bracket.0, bracket.1);
            if middle <= bracket.0 || middle >= bracket.1 || bracket.1 - bracket.0 < 1e-19 {
                break;
            }
            let Some(trial) = self.trial(time, middle) else {
                bracket.1 = middle;
                continue;
            };
            if self.inside(trial.d[end], trial.rate[end]) <= 0.0 {
                bracket.1 = middle;
                best = (trial, middle);
            } else {
                bracket.0 = middle;
            }
        }
        (best.0, best.1, true)
    }

    /// The step of `h` seconds on the branch, if Newton's method converges.
    fn trial(&self, time: f64, h: f64) -> Option<Trial> {
        let Self { problem, tableau, .. } = self;
        let model = &problem.model;
        let a = tableau.a * h;
        let ones = Vector::repeat(1.0);
        let base = tableau.c.map(|c| problem.acceleration(time + c * h));
        // With v = v_0 + w at the stages: M w = hA (r - c v_0 - omega^2 (q_0 + h c_i v_0)), M = 1 + c hA + omega^2
        // (hA)^2, and q = q_0 + h c_i v_0 + hA w.
        let inverses: Option<Vec<Matrix>> = model
            .modes
            .iter()
            .map(|mode| (Matrix::identity() + a * mode.damping + a * a * mode.omega_squared).try_inverse())
            .collect();
        let inverses = inverses?;
        let times = tableau.c * h;
        let mut d = times.map(|t| model.preload.indentation + problem.support_rate * (time + t));
        let mut rate = ones * problem.support_rate;
        let mut compliance = Matrix::zeros();
        let mut mobility = Matrix::zeros();
        let mut free = Vec::with_capacity(inverses.len());
        for ((mode, inverse), motion) in model.modes.iter().zip(&inverses).zip(&self.modes) {
            let ModeMotion { q, q_low, v, v_low } = *motion;
            let held = mode.damping * v + mode.omega_squared * q;
            let load = base * -mode.participation - ones * held - times * (mode.omega_squared * v);
            let w = inverse * (a * load);
            let dq = times * v + a * w;
            d -= (dq + ones * q_low + ones * q) * mode.tip;
            rate -= (w + ones * v_low + ones * v) * mode.tip;
            let per_force = inverse * a * mode.tip;
            mobility += per_force * mode.tip;
            compliance += a * per_force * mode.tip;
            free.push((dq, w));
        }
        let forces =
            if self.closed { self.forces(&d, &rate, &compliance, &mobility)? } else { ones * -model.preload.force };
        let end = STAGES - 1;
        let modes = model.modes.iter().zip(&inverses).zip(free);
        let changes = modes
            .map(|((mode, inverse), (dq, w))| {
                let from_force = inverse * (a * (forces * mode.tip));
                (dq[end] + (a * from_force)[end], w[end] + from_force[end])
            })
            .collect();
        Some(Trial { changes, d: d - compliance * forces, rate: rate - mobility * forces })
    }

    /// Contact forces at the stages, as deviation from the preload force.
    fn forces(&self, d: &Vector, rate: &Vector, compliance: &Matrix, mobility: &Matrix) -> Option<Vector> {
        let model = &self.problem.model;
        let mut forces = Vector::repeat(self.force - model.preload.force);
        let mut last = f64::INFINITY;
        for _ in 0..40 {
            let (at, at_rate) = (d - compliance * forces, rate - mobility * forces);
            let mut residual = forces;
            let mut jacobian = Matrix::identity();
            for i in 0..STAGES {
                let branch = model.law.closed_branch(at[i], at_rate[i]);
                residual[i] -= branch.force - model.preload.force;
                for j in 0..STAGES {
                    jacobian[(i, j)] += branch.stiffness * compliance[(i, j)] + branch.damping * mobility[(i, j)];
                }
            }
            let correction = jacobian.lu().solve(&residual)?;
            forces -= correction;
            let size = correction.amax();
            if !size.is_finite() {
                return None;
            }
            // Until limited by rounding.
            if size <= 1e-17 || (size <= 1e-11 * model.force_scale && size >= 0.5 * last) {
                return Some(forces);
            }
            last = size;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use relay_contact::variables::AxialForceKind;

    use super::*;
    use crate::scenes;

    /// At 400 m/s2 and 1000 Hz the specimen's contact opens at 708.827593 us and closes at 1089.427605 us: converged
    /// in modes and time by two other methods, all digits given.
    #[test]
    fn the_reference_opens_and_closes_when_two_other_methods_say() -> Result<(), Box<dyn std::error::Error>> {
        let mut scene = scenes::chatter("chatter", 0.34)?.model.scene.clone();
        scene.effects.axial_force = AxialForceKind::None;
        scene.solver.modes = scenes::MANY_MODES;
        let problem = Problem::new("without axial force", &scene, 0.0, 0.005, 250)?;
        let reference = Reference::new(&problem, 1e-6).map_err(|failure| failure.to_string())?;
        for (event, known) in reference.events.iter().zip([708.827_593e-6, 1_089.427_605e-6]) {
            assert!((event - known).abs() < 1e-12, "{event} {known}");
        }
        Ok(())
    }
}
