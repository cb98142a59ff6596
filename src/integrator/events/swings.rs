//! The modes that oscillate in a trial, or that settle at once after a jump: what a look at a few instants misses of the motion of
//! a contact.

use crate::beam::mode::Mode;
use crate::integrator::collocation::part::Whole;
use crate::integrator::events::cubic::Cubic;
use crate::link::Link;
use crate::math::free_motion::{FADED, Roots};

/// Bound of what fast modes do: displacement (m), velocity (m/s) and acceleration (m/s2).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ripple {
    pub(super) displacement: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
}

/// Square of damping over natural frequency below which both exponentials of a mode that settles count, 1: the faster one is less than
/// twice as fast as the other.
const NEARLY_CRITICAL: f64 = 4.5;

/// The modes that oscillate or settle in a trial.
#[derive(Clone, Debug)]
pub(crate) struct Swings(Vec<Swing>);

/// A mode that oscillates or settles.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// Circular frequency, or rate at which it settles, rad/s.
    omega: f64,
    /// Displacement of the contact by it, m.
    amplitude: f64,
    /// Rate at which it certainly decays, 1/s.
    decay: f64,
}

impl Swing {
    /// Of a mode with this displacement and velocity, relative to its equilibrium. Of two exponentials the faster: the other shows in
    /// samples. Of two that are nearly the same `|x(t)| <= (|x| + |v| / omega) (1 + omega t) exp(-omega t)`, so with twice as much
    /// that decays half as fast.
    fn new(mode: &Mode, x: f64, v: f64) -> Self {
        let Roots { creeps: [creeps], slow: [slow], fast: [fast], .. } =
            Roots::of([mode.omega_squared], [mode.damping]);
        if !creeps && 0.5 * mode.damping < fast {
            let v = v / fast;
            return Self { omega: fast, amplitude: (x * x + v * v).sqrt(), decay: 0.0 };
        }
        if is_nearly_critical(mode) {
            return Self { omega: fast, amplitude: 2.0 * (x.abs() + v.abs() / slow), decay: 0.5 * slow };
        }
        Self { omega: fast, amplitude: (v + slow * x).abs() / (fast - slow), decay: fast }
    }
}

/// Or less than critically damped.
fn is_nearly_critical(mode: &Mode) -> bool {
    mode.damping * mode.damping < NEARLY_CRITICAL * mode.omega_squared
}

impl Swings {
    /// Room for this many modes.
    pub(crate) fn room(modes: usize) -> Self {
        Self(Vec::with_capacity(modes))
    }

    /// Sets them to those of a link in a trial, about the equilibrium under the loads at its start.
    pub(super) fn set<const S: usize>(&mut self, whole: Whole<S>, sought: &Link) {
        let Whole { model, state, drive, .. } = whole;
        let acceleration = drive.acceleration(state.time);
        let modes = model.modes.iter().zip(&state.modes).enumerate();
        self.0.clear();
        // One that settles at once has nothing to settle but after a jump.
        let moves = |mode: &Mode| !state.kink_is_closing || is_nearly_critical(mode);
        self.0.extend(modes.filter(|(_, (mode, _))| moves(mode)).map(|(i, (mode, at))| {
            let links = model.links.iter().zip(&state.links);
            let load = links.fold(-mode.participation * acceleration, |load, (link, at)| {
                load + link.sense * model.displacement(link.port, i) * (at.force - link.force)
            });
            let swing = Swing::new(mode, at.q - load / mode.omega_squared, at.v);
            Swing { amplitude: model.displacement(sought.port, i).abs() * swing.amplitude, ..swing }
        }));
    }

    /// Bound of the motion of the contact by those that oscillate or settle within the interval of a cubic, or less.
    pub(super) fn ripple(&self, cubic: &Cubic) -> Ripple {
        let (at, interval) = (cubic.a.at, cubic.length());
        let mut ripple = Ripple::default();
        let fast = |swing: &&Swing| swing.omega * interval > 1.0 && -swing.decay * at > FADED;
        for Swing { omega, amplitude, decay } in self.0.iter().filter(fast) {
            let amplitude = if *decay > 0.0 { amplitude * (-decay * at).exp() } else { *amplitude };
            let velocity = omega * amplitude;
            ripple.displacement += amplitude;
            ripple.velocity += velocity;
            ripple.acceleration += omega * velocity;
        }
        ripple
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::free_motion::FreeMotion;

    /// Also where rounding makes a damping of just the critical one less than that: were the bound not a number, nothing would be
    /// looked for.
    #[test]
    fn no_free_motion_exceeds_its_bound() {
        let omega = 1e9_f64;
        for ratio in [0.01, 0.9, 1.0 - f64::EPSILON, 1.0, 1.0 + f64::EPSILON, 1.001, 1.06, 1.07, 3.0, 1e4] {
            let mode = Mode { omega_squared: omega * omega, damping: 2.0 * ratio * omega, ..Mode::default() };
            let [slow] = Roots::of([mode.omega_squared], [mode.damping]).slow;
            for (x, v) in [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-0.3, 0.4)] {
                let v = v * omega;
                let Swing { omega: fastest, amplitude, decay } = Swing::new(&mode, x, v);
                // Of a strongly damped one the slower exponential is no part of it.
                let slower = if ratio > 1.0 && decay > omega { x + amplitude * (v + slow * x).signum() } else { 0.0 };
                for k in 0..60 {
                    let t = 1e-12 * 1.4_f64.powi(k);
                    let free = FreeMotion::new(mode.omega_squared, mode.damping, t);
                    let moved = free.q_from_q * x + free.q_from_v * v - slower * (-slow * t).exp();
                    let bound = amplitude * (-decay * t).exp();
                    assert!(moved.abs() <= bound + 1e-12, "{ratio} {x} {v} {t}: {moved} {bound}");
                    let rate = free.v_from_q * x + free.v_from_v * v + slow * slower * (-slow * t).exp();
                    assert!(rate.abs() <= fastest * bound + 1e-12 * omega, "{ratio} {x} {v} {t}: {rate} {bound}");
                }
            }
        }
    }
}
