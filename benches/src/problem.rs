//! The modal equations of a scene in the form general integrators need:
//!
//! `q_i'' + c_i q_i' + omega_i^2 q_i = T_i (F - F_0) - g_i a(t)`, `F` by the contact law from `d = d_0 + u(t) - sum T_i q_i`
//! and its rate. The state is `q_1 ... q_n, v_1 ... v_n`, as deviation from the preload.
//!
//! The law has two branches, open (`F = 0`) and closed. The branch is an argument of the equations, so that each is
//! smooth: an integrator with root finding switches where the engagement changes sign.

use std::f64::consts::TAU;
use std::hint::black_box;

use cpu_time::ThreadTime;
use relay_contact::error::SceneError;
use relay_contact::reference::{Branch, Model};
use relay_contact::scene::Scene;
use relay_contact::variables::ExcitationKind;

/// A scene and the requested results.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Name in tables and figures.
    pub name: &'static str,
    /// Modes, contact law and preload, shared with the component.
    pub model: Model,
    /// Velocity of the fixed contact from the start, m/s.
    pub support_rate: f64,
    /// Length of the simulation, s.
    pub end: f64,
    /// Number of equal communication steps, at whose ends the force is recorded.
    pub cells: u32,
    /// Relative tolerance of the states per tolerance of the force, for general integrators. If the contact opens, the
    /// indentation is a small difference of modal displacements up to a thousand times larger.
    pub relative: f64,
}

impl Problem {
    /// The problem of a scene.
    pub fn new(name: &'static str, scene: &Scene, support_rate: f64, end: f64, cells: u32) -> Result<Self, SceneError> {
        Ok(Self { name, model: Model::new(scene, 0.0)?, support_rate, end, cells, relative: 1.0 })
    }

    /// The same with a change of the scene.
    pub fn with(&self, change: impl FnOnce(&mut Scene)) -> Result<Self, SceneError> {
        let mut scene = self.model.scene.clone();
        change(&mut scene);
        let model = Model::new(&scene, 0.0)?;
        Ok(Self { model, ..self.clone() })
    }

    /// The same with another number of modes than the component chooses.
    pub fn with_modes(&self, modes: i32) -> Result<Self, SceneError> {
        self.with(|scene| scene.solver.modes = modes)
    }

    /// Processor time of making modes, contact law and preload of the parameters, s, the least of three: what other integrators
    /// cannot do without.
    pub fn start(&self) -> f64 {
        let times = [(); 3].map(|()| {
            let start = ThreadTime::now();
            let _ = black_box(Model::new(&self.model.scene, 0.0));
            start.elapsed().as_secs_f64()
        });
        times.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.model.modes.len()
    }

    /// Grid time number `cell`, s.
    pub fn instant(&self, cell: u32) -> f64 {
        self.end * f64::from(cell) / f64::from(self.cells)
    }

    /// Amplitude (m/s2), angular frequency (rad/s) and phase of the base acceleration; the scenes here start it at 0.
    /// Other waveforms panic.
    pub fn sine(&self) -> (f64, f64, f64) {
        let Scene { effects, excitation, .. } = &self.model.scene;
        match effects.excitation {
            ExcitationKind::None => (0.0, 0.0, 0.0),
            ExcitationKind::Sine => (excitation.amplitude, TAU * excitation.frequency, excitation.phase),
            other => panic!("the other integrators do not support {other:?}"),
        }
    }

    /// Base acceleration, m/s2.
    pub fn acceleration(&self, time: f64) -> f64 {
        let (amplitude, omega, phase) = self.sine();
        amplitude * (omega * time + phase).sin()
    }

    /// Indentation (m) and its rate (m/s).
    pub fn indentation(&self, time: f64, state: &[f64]) -> (f64, f64) {
        let (q, v) = state.split_at(self.modes());
        let mut deviation = self.support_rate * time;
        let mut rate = self.support_rate;
        for ((mode, q), v) in self.model.modes.iter().zip(q).zip(v) {
            deviation -= mode.tip * q;
            rate -= mode.tip * v;
        }
        (self.model.preload.indentation + deviation, rate)
    }

    /// Positive while the contact is closed, m.
    pub fn engagement(&self, time: f64, state: &[f64]) -> f64 {
        let (d, rate) = self.indentation(time, state);
        self.model.law.engagement(d, rate)
    }

    /// Whether the contact is closed at the start.
    pub fn starts_closed(&self) -> bool {
        self.model.preload.force > 0.0
    }

    /// Whether it can open at all.
    pub fn can_open(&self) -> bool {
        !self.model.law.never_opens()
    }

    /// Force and derivatives on the branch.
    pub fn branch(&self, closed: bool, time: f64, state: &[f64]) -> Branch {
        let (d, rate) = self.indentation(time, state);
        if closed { self.model.law.closed_branch(d, rate) } else { Branch::default() }
    }

    /// Contact force on the grid, N.
    pub fn force(&self, closed: bool, time: f64, state: &[f64]) -> f64 {
        let force = self.branch(closed, time, state).force;
        if self.can_open() { force.max(0.0) } else { force }
    }

    /// Derivative of the state.
    pub fn derivative(&self, closed: bool, time: f64, state: &[f64], derivative: &mut [f64]) {
        let force = self.branch(closed, time, state).force - self.model.preload.force;
        let acceleration = self.acceleration(time);
        let (q, v) = state.split_at(self.modes());
        let (q_rate, v_rate) = derivative.split_at_mut(self.modes());
        q_rate.copy_from_slice(v);
        for (((rate, mode), q), v) in v_rate.iter_mut().zip(&self.model.modes).zip(q).zip(v) {
            *rate = mode.tip * force - mode.participation * acceleration - mode.damping * v - mode.omega_squared * q;
        }
    }

    /// Derivative of [`Problem::derivative`] by the state in a direction.
    pub fn jacobian_times(&self, closed: bool, time: f64, state: &[f64], direction: &[f64], product: &mut [f64]) {
        let branch = self.branch(closed, time, state);
        let (q, v) = direction.split_at(self.modes());
        let (q_rate, v_rate) = product.split_at_mut(self.modes());
        q_rate.copy_from_slice(v);
        let modes = &self.model.modes;
        let force: f64 = modes
            .iter()
            .zip(q.iter().zip(v))
            .map(|(mode, (q, v))| -mode.tip * (branch.stiffness * q + branch.damping * v))
            .sum();
        for (((rate, mode), q), v) in v_rate.iter_mut().zip(modes).zip(q).zip(v) {
            *rate = mode.tip * force - mode.damping * v - mode.omega_squared * q;
        }
    }

    /// Absolute tolerances of the state for a tolerance of the force relative to the force scale: what moves the tip by the
    /// deviation that the contact's stiffness, or its damping, turns into that force, shared by nobody.
    pub fn absolute(&self, tolerance: f64) -> Vec<f64> {
        let stiffness = self.model.law.tangent_stiffness(self.model.force_scale);
        let displacement = self.model.force_scale / stiffness;
        let velocity = displacement / self.model.law.damping;
        let of = |scale: f64| self.model.modes.iter().map(move |mode| tolerance * (scale / mode.tip.abs()));
        of(displacement).chain(of(velocity)).collect()
    }
}
