//! Newmark's method with average acceleration (J. Eng. Mech. Div. ASCE 85 (1959) 67), the fixed-step method of structural
//! dynamics. With the damping it makes of high modes the generalised-alpha method is as accurate and as fast in these scenes.
//!
//! At the end of a step displacement and velocity of the tip are linear in the contact force there, so each step
//! solves one scalar equation, by bracketed Newton iteration. There is no root finding: openings and closings are
//! interpolated linearly between the ends of a step, as is usual with this method.

use cpu_time::ThreadTime;

use crate::integrator::{Failure, Integrator, Run, Setting};
use crate::problem::Problem;

const BETA: f64 = 0.25;
const GAMMA: f64 = 0.5;

/// The method.
pub struct Newmark;

impl Integrator for Newmark {
    fn name(&self) -> &'static str {
        "Newmark"
    }

    fn fixed_step(&self) -> bool {
        true
    }

    fn run(&self, problem: &Problem, setting: Setting) -> Result<Run, Failure> {
        let start = ThreadTime::now();
        let cell = problem.end / f64::from(problem.cells);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of steps, at least one"
        )]
        let steps_per_cell = (cell / setting.value()).round().max(1.0) as u64;
        let mut motion = Motion::new(problem, cell / steps_per_cell as f64);
        let mut run = Run {
            forces: vec![motion.force],
            ..Run::default()
        };
        for _ in 0..problem.cells {
            for _ in 0..steps_per_cell {
                let before = motion.engagement;
                run.iterations += motion
                    .step()
                    .ok_or_else(|| Failure::Stopped(format!("no solution at t = {:.6e} s", motion.time)))?;
                run.steps += 1;
                if problem.can_open() && (before > 0.0) != (motion.engagement > 0.0) {
                    let part = before / (before - motion.engagement);
                    run.events.push(motion.time - motion.h * (1.0 - part));
                }
            }
            run.forces.push(motion.force);
        }
        run.time = start.elapsed().as_secs_f64();
        Ok(run)
    }
}

/// The state of a mode.
#[derive(Clone, Copy, Debug, Default)]
struct ModeMotion {
    q: f64,
    v: f64,
    a: f64,
    /// Inverse of the effective mass.
    mobility: f64,
}

struct Motion<'a> {
    problem: &'a Problem,
    h: f64,
    steps: f64,
    time: f64,
    modes: Vec<ModeMotion>,
    /// Displacement and velocity of the tip at the end of a step per force there.
    compliance: (f64, f64),
    force: f64,
    engagement: f64,
}

impl<'a> Motion<'a> {
    fn new(problem: &'a Problem, h: f64) -> Self {
        let acceleration = problem.acceleration(0.0);
        let mut compliance = (0.0, 0.0);
        let modes = problem
            .model
            .modes()
            .iter()
            .map(|mode| {
                let mass = 1.0 + h * (mode.damping * GAMMA + mode.omega_squared * BETA * h);
                compliance.0 += mode.tip * mode.tip * BETA * h * h / mass;
                compliance.1 += mode.tip * mode.tip * GAMMA * h / mass;
                ModeMotion {
                    a: -mode.participation * acceleration,
                    mobility: 1.0 / mass,
                    ..ModeMotion::default()
                }
            })
            .collect();
        let preload = problem.model.preload();
        Self {
            problem,
            h,
            steps: 0.0,
            time: 0.0,
            modes,
            compliance,
            force: preload.force,
            engagement: problem
                .model
                .law()
                .engagement(preload.indentation, problem.support_rate),
        }
    }

    /// One step; with the number of Newton iterations, if there is a solution.
    fn step(&mut self) -> Option<u64> {
        let Self { problem, h, .. } = *self;
        let preload = problem.model.preload();
        self.steps += 1.0;
        self.time = self.steps * h;
        let acceleration = problem.acceleration(self.time);
        let mut d = preload.indentation + problem.support_rate * self.time;
        let mut rate = problem.support_rate;
        for (motion, mode) in self.modes.iter_mut().zip(problem.model.modes()) {
            let ModeMotion { q, v, a, mobility } = *motion;
            // Without the new force.
            let q_free = q + h * v + h * h * (0.5 - BETA) * a;
            let v_free = v + h * (1.0 - GAMMA) * a;
            let load = -mode.tip * preload.force - mode.participation * acceleration;
            let a = (load - mode.damping * v_free - mode.omega_squared * q_free) * mobility;
            *motion = ModeMotion {
                q: q_free + h * h * BETA * a,
                v: v_free + h * GAMMA * a,
                a,
                mobility,
            };
            d -= mode.tip * motion.q;
            rate -= mode.tip * motion.v;
        }
        let (force, iterations) = self.solve(d, rate)?;
        for (motion, mode) in self.modes.iter_mut().zip(problem.model.modes()) {
            let a = mode.tip * force * motion.mobility;
            motion.q += h * h * BETA * a;
            motion.v += h * GAMMA * a;
            motion.a += a;
        }
        self.force = force;
        let law = &problem.model.law();
        self.engagement = law.engagement(d - self.compliance.0 * force, rate - self.compliance.1 * force);
        Some(iterations)
    }

    /// The contact force, for indentation and rate without it.
    fn solve(&self, d: f64, rate: f64) -> Option<(f64, u64)> {
        let Self {
            problem, compliance, ..
        } = *self;
        let law = &problem.model.law();
        let bonded = law.never_opens();
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        if !bonded {
            low = 0.0;
            high = law.force(d, rate);
            if high <= 0.0 {
                return Some((0.0, 0));
            }
        }
        let mut force = self.force.clamp(low, high);
        for iteration in 1..=200 {
            let at = (d - compliance.0 * force, rate - compliance.1 * force);
            let closed = law.engagement(at.0, at.1) > 0.0;
            let branch = law.closed_branch(at.0, at.1);
            let (value, slope) = if closed {
                (
                    branch.force,
                    branch.stiffness * compliance.0 + branch.damping * compliance.1,
                )
            } else {
                (0.0, 0.0)
            };
            let residual = force - value;
            if residual > 0.0 {
                high = force;
            } else {
                low = force;
            }
            let mut next = force - residual / (1.0 + slope);
            // Unbracketed, Newton's method can cycle across the kink at zero force.
            if !bonded && (iteration > 8 && iteration % 2 == 0 || !(low..=high).contains(&next)) {
                next = f64::midpoint(low, high);
            }
            if (next - force).abs() <= 1e-13 * problem.model.force_scale().max(force) {
                return next.is_finite().then_some((next, iteration));
            }
            force = next;
        }
        None
    }
}
