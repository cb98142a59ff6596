//! The fixed-step methods of structural dynamics: Newmark's average acceleration (J. Eng. Mech. Div. ASCE 85 (1959) 67) and
//! the generalised-alpha method (Chung, Hulbert, J. Appl. Mech. 60 (1993) 371), of which it is a special case.
//!
//! At the end of a step displacement and velocity of the tip are linear in the contact force there, so each step
//! solves one scalar equation, by bracketed Newton iteration. There is no root finding: openings and closings are
//! interpolated linearly between the ends of a step, as is usual with these methods.

use cpu_time::ThreadTime;

use crate::integrator::{Failure, Integrator, Run, Setting};
use crate::problem::Problem;

/// The parameters of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralisedAlpha {
    name: &'static str,
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl GeneralisedAlpha {
    /// Newmark's average acceleration.
    pub fn newmark() -> Self {
        Self {
            name: "Newmark",
            alpha_m: 0.0,
            alpha_f: 0.0,
            beta: 0.25,
            gamma: 0.5,
        }
    }

    /// Generalised-alpha with a spectral radius at infinite frequency of 0 (all damping) to 1 (none).
    pub fn with_spectral_radius(radius: f64) -> Self {
        let alpha_m = (2.0 * radius - 1.0) / (radius + 1.0);
        let alpha_f = radius / (radius + 1.0);
        Self {
            name: "generalised-alpha",
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2),
            gamma: 0.5 - alpha_m + alpha_f,
        }
    }
}

impl Integrator for GeneralisedAlpha {
    fn name(&self) -> &'static str {
        self.name
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
        let mut motion = Motion::new(self, problem, cell / steps_per_cell as f64);
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
    method: &'a GeneralisedAlpha,
    problem: &'a Problem,
    h: f64,
    steps: f64,
    time: f64,
    modes: Vec<ModeMotion>,
    /// Displacement and velocity of the tip at the end of a step per force there.
    compliance: (f64, f64),
    acceleration: f64,
    force: f64,
    engagement: f64,
}

impl<'a> Motion<'a> {
    fn new(method: &'a GeneralisedAlpha, problem: &'a Problem, h: f64) -> Self {
        let GeneralisedAlpha {
            alpha_m,
            alpha_f,
            beta,
            gamma,
            ..
        } = *method;
        let acceleration = problem.acceleration(0.0);
        let mut compliance = (0.0, 0.0);
        let modes = problem
            .model
            .modes()
            .iter()
            .map(|mode| {
                let mass = 1.0 - alpha_m + (1.0 - alpha_f) * h * (mode.damping * gamma + mode.omega_squared * beta * h);
                compliance.0 += mode.tip * mode.tip * beta * h * h * (1.0 - alpha_f) / mass;
                compliance.1 += mode.tip * mode.tip * gamma * h * (1.0 - alpha_f) / mass;
                ModeMotion {
                    a: -mode.participation * acceleration,
                    mobility: 1.0 / mass,
                    ..ModeMotion::default()
                }
            })
            .collect();
        let preload = problem.model.preload();
        Self {
            method,
            problem,
            h,
            steps: 0.0,
            time: 0.0,
            modes,
            compliance,
            acceleration,
            force: preload.force,
            engagement: problem.model.engagement(0.0, problem.support_rate),
        }
    }

    /// One step; with the number of Newton iterations, if there is a solution.
    fn step(&mut self) -> Option<u64> {
        let Self { problem, h, .. } = *self;
        let GeneralisedAlpha {
            alpha_m,
            alpha_f,
            beta,
            gamma,
            ..
        } = *self.method;
        let preload = problem.model.preload();
        self.steps += 1.0;
        self.time = self.steps * h;
        let acceleration = problem.acceleration(self.time);
        let base = (1.0 - alpha_f) * acceleration + alpha_f * self.acceleration;
        // Without the new force.
        let force = alpha_f * self.force - preload.force;
        let mut d = preload.indentation + problem.support_rate * self.time;
        let mut rate = problem.support_rate;
        for (motion, mode) in self.modes.iter_mut().zip(problem.model.modes()) {
            let ModeMotion { q, v, a, mobility } = *motion;
            let q_free = q + h * v + h * h * (0.5 - beta) * a;
            let v_free = v + h * (1.0 - gamma) * a;
            let load = mode.tip * force - mode.participation * base;
            let inner = alpha_m * a
                + mode.damping * ((1.0 - alpha_f) * v_free + alpha_f * v)
                + mode.omega_squared * ((1.0 - alpha_f) * q_free + alpha_f * q);
            let a = (load - inner) * mobility;
            *motion = ModeMotion {
                q: q_free + h * h * beta * a,
                v: v_free + h * gamma * a,
                a,
                mobility,
            };
            d -= mode.tip * motion.q;
            rate -= mode.tip * motion.v;
        }
        let (force, iterations) = self.solve(d, rate)?;
        for (motion, mode) in self.modes.iter_mut().zip(problem.model.modes()) {
            let a = (1.0 - alpha_f) * mode.tip * force * motion.mobility;
            motion.q += h * h * beta * a;
            motion.v += h * gamma * a;
            motion.a += a;
        }
        self.force = force;
        self.acceleration = acceleration;
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
