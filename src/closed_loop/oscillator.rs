//! A pair of eigenvalues of beam and linear contact as a damped oscillator, and its motion in closed form.

use std::f64::consts::TAU;

use nalgebra::Complex;

use crate::beam::mode::MAX_MODES;
use crate::math::free_motion::FreeMotion;

/// Displacements of the oscillators, then their velocities; or displacement and velocity of mode after mode.
pub type Coordinates = [f64; 2 * MAX_MODES];

/// A pair of eigenvalues as the oscillator `x'' + c x' + nu x = 0`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Oscillator {
    /// nu, 1/s2.
    pub(crate) omega_squared: f64,
    /// c, 1/s.
    pub(crate) damping: f64,
    /// Forcing by unit base acceleration: velocity added to x', and acceleration.
    pub(crate) load: [f64; 2],
    /// Forcing by a unit tip force.
    pub(crate) push: [f64; 2],
    /// Its roots if real and distinct, 1/s, each with its contact force.
    pub(crate) apart: Option<[(f64, f64); 2]>,
    /// Contact force per displacement and per velocity.
    pub(crate) force: [f64; 2],
}

/// Sets displacement and velocity of an oscillator.
pub(crate) fn set(coordinates: &mut Coordinates, oscillator: usize, count: usize, [x, v]: [f64; 2]) {
    for (at, value) in [(oscillator, x), (count + oscillator, v)] {
        if let Some(entry) = coordinates.get_mut(at) {
            *entry = value;
        }
    }
}

impl Oscillator {
    /// Displacement and velocity under base acceleration, from those of the oscillator under a unit acceleration `x''`.
    pub(crate) fn loaded(&self, [y, y_rate]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
        let [kick, push] = self.load;
        [(y_rate + y * self.damping) * kick + y * push, y_rate * push - y * (self.omega_squared * kick)]
    }

    /// Upper bound of the contact force of the free motion.
    pub(crate) fn largest_force(&self, x: f64, v: f64) -> f64 {
        if let Some([(l1, force1), (l2, force2)]) = self.apart {
            // Each root decays without oscillation.
            return (((v - l2 * x) * force1).abs() + ((l1 * x - v) * force2).abs()) / (l1 - l2).abs();
        }
        // The energy does not grow.
        let [per_x, per_v] = self.force;
        ((x * x + v * v / self.omega_squared) * (per_x * per_x + per_v * per_v * self.omega_squared)).sqrt()
    }

    /// Displacement and velocity at equilibrium under a constant load.
    pub(crate) fn at_rest(&self, [kick, push]: [f64; 2]) -> [f64; 2] {
        [(push + self.damping * kick) / self.omega_squared, -kick]
    }

    /// Displacement and velocity at the start of a particular solution under a load that grows linearly with time.
    pub(crate) fn at_ramp(&self, load: [f64; 2]) -> [f64; 2] {
        let [x, v] = self.at_rest(load);
        [-(v + self.damping * x) / self.omega_squared, x]
    }

    /// Complex amplitudes of displacement and velocity under unit harmonic acceleration of the frequency (Hz).
    pub(crate) fn steady(&self, frequency: f64) -> [Complex<f64>; 2] {
        let omega = TAU * frequency;
        let y = 1.0 / Complex::new(self.omega_squared - omega * omega, omega * self.damping);
        [y, y * Complex::new(0.0, omega)]
    }

    /// Displacement and velocity `length` seconds after rest under the acceleration `e^(i omega t)`, `turn` there.
    pub(crate) fn driven_from_rest(
        &self,
        free: &FreeMotion,
        frequency: f64,
        turn: Complex<f64>,
        length: f64,
    ) -> [Complex<f64>; 2] {
        let omega = Complex::new(0.0, TAU * frequency);
        let half = 0.5 * self.damping;
        let w = (self.omega_squared - half * half).max(0.0).sqrt();
        if w <= half {
            // Far from resonance: the steady state less a free motion.
            let [y, y_rate] = self.steady(frequency);
            return [
                y * turn - (y * free.q_from_q + y_rate * free.q_from_v),
                y_rate * turn - (y * free.v_from_q + y_rate * free.v_from_v),
            ];
        }
        // For each root l the integral of e^(l (length - t)) e^(i omega t).
        let driven = |root: Complex<f64>| {
            let free = (root * length).exp();
            let rate = omega - root;
            let z = rate * length;
            if z.norm() > 0.5 { (turn - free) / rate } else { free * length * growth(z) }
        };
        let root = Complex::new(-half, w);
        let (upper, lower) = (driven(root), driven(root.conj()));
        let both = Complex::new(0.0, 2.0 * w);
        [(upper - lower) / both, (root * upper - root.conj() * lower) / both]
    }
}

/// (e^z - 1) / z for small z, by its power series.
fn growth(z: Complex<f64>) -> Complex<f64> {
    let (mut term, mut sum) = (Complex::from(1.0), Complex::from(1.0));
    for n in 2..20 {
        term *= z / f64::from(n);
        sum += term;
    }
    sum
}
