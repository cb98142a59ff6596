//! The modes that oscillate in a trial: what a look at a few instants misses of the motion of a contact.

use crate::beam::mode::Mode;
use crate::integrator::collocation::part::Whole;
use crate::link::Link;

/// Bound of what fast modes do: displacement (m), velocity (m/s) and acceleration (m/s2).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ripple {
    pub(super) displacement: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
}

/// The modes that oscillate in a trial.
#[derive(Clone, Debug)]
pub(crate) struct Swings(Vec<Swing>);

/// A mode that oscillates.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// Circular frequency, rad/s.
    omega: f64,
    /// Displacement of the contact by it, m.
    amplitude: f64,
}

impl Swings {
    /// Room for this many modes.
    pub(crate) fn room(modes: usize) -> Self {
        Self(Vec::with_capacity(modes))
    }

    /// Sets them to those of a link in a trial, about the equilibrium under the loads at its start.
    pub(super) fn set<const S: usize>(&mut self, whole: Whole<S>, sought: &Link) {
        let Whole {
            model, state, drive, ..
        } = whole;
        let acceleration = drive.acceleration(state.time);
        let swings = |mode: &Mode| mode.damping * mode.damping < 4.0 * mode.omega_squared;
        let modes = model.modes.iter().zip(&state.modes).enumerate();
        self.0.clear();
        self.0
            .extend(modes.filter(|(_, (mode, _))| swings(mode)).map(|(i, (mode, at))| {
                let factor = |port: usize| {
                    let shape = model.ports.get(port).map(|port| &port.shape);
                    shape.and_then(|shape| shape.get(i)).copied().unwrap_or_default()
                };
                let omega = mode.omega_squared.sqrt();
                let links = model.links.iter().zip(&state.links);
                let load = links.fold(-mode.participation * acceleration, |load, (link, at)| {
                    load + link.sense * factor(link.port) * (at.force - link.force)
                });
                let (q, v) = (at.q - load / mode.omega_squared, at.v / omega);
                let amplitude = factor(sought.port).abs() * (q * q + v * v).sqrt();
                Swing { omega, amplitude }
            }));
    }

    /// Bound of the motion of the contact by those that oscillate within `interval` seconds or less.
    pub(super) fn ripple(&self, interval: f64) -> Ripple {
        let mut ripple = Ripple::default();
        let fast = |swing: &&Swing| swing.omega * interval > 1.0;
        for Swing { omega, amplitude } in self.0.iter().filter(fast) {
            let velocity = omega * amplitude;
            ripple.displacement += amplitude;
            ripple.velocity += velocity;
            ripple.acceleration += omega * velocity;
        }
        ripple
    }
}
