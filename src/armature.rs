//! The armature (`effects.pusher` Armature): one degree of freedom that moves the pusher, reduced to it.
//!
//! ```text
//! m p'' + c p' + k (p - p_0) = F_m(g) - F_r - F_p - F_core + F_rest + e m a
//! ```
//!
//! with the return spring `k` and its force `F_r` at the rest position `p_0`, the pusher's force `F_p`, the magnet
//! ([`crate::magnet`]) over the gap `g = p_1 - p` to the core at `p_1`, one-sided stops there and at `p_0`, and the share `e` of the
//! mass that feels the base acceleration. It counts towards the contact, as the inertia of the spring does. As one more mode, with
//! `p` over the root of its mass as coordinate, it joins those of the springs.

use crate::beam::mode::Mode;
use crate::contact::power::Power;
use crate::magnet::{Magnet, damping_ratio};
use crate::math::roots;
use crate::scene::Scene;
use crate::variables::PusherKind;

/// Places between the stops at which the armature is looked for where it is at neither.
const PLACES: u32 = 200;

/// Constants of the armature.
#[derive(Clone, Copy, Debug)]
pub struct Armature {
    mass: f64,
    stiffness: f64,
    damping: f64,
    return_force: f64,
    unbalance: f64,
    gravity: f64,
    /// The magnet.
    pub magnet: Magnet,
    /// Position at the rest stop p_0, m.
    pub rest: f64,
    /// Position at the core p_1, m.
    pub core: f64,
    stop_stiffness: f64,
    stop_restitution: f64,
}

/// The armature in its equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AtRest {
    /// Position p, m.
    pub place: f64,
    /// Force of the core on it, N.
    pub core_force: f64,
    /// Force of the rest stop on it, N.
    pub rest_force: f64,
    /// Force of the magnet, N.
    pub magnet_force: f64,
}

impl Armature {
    /// That of a scene, if it has one.
    pub fn new(scene: &Scene) -> Option<Self> {
        let given = &scene.armature;
        (scene.effects.pusher == PusherKind::Armature).then_some(Self {
            mass: given.mass,
            stiffness: given.stiffness,
            damping: given.damping,
            return_force: given.return_force,
            unbalance: given.unbalance,
            gravity: scene.environment.gravity,
            magnet: Magnet {
                hold: given.hold_force,
                constant: given.gap_constant,
            },
            rest: given.rest_position,
            core: given.core_position,
            stop_stiffness: given.stop_stiffness,
            stop_restitution: given.stop_restitution,
        })
    }

    /// As a mode.
    pub fn mode(&self) -> Mode {
        let root = self.mass.sqrt();
        Mode {
            omega_squared: self.stiffness / self.mass,
            damping: self.damping / self.mass,
            participation: -self.unbalance * root,
            pusher: 1.0 / root,
            armature: 1.0 / root,
            ..Mode::default()
        }
    }

    /// The law of a stop.
    pub fn stop(&self) -> Power {
        let critical = 2.0 * (self.stop_stiffness * self.mass).sqrt();
        Power::linear(self.stop_stiffness, critical * damping_ratio(self.stop_restitution))
    }

    /// Where it rests with this current of the coil (relative), and with the force of the pusher at a place (m); `None` where
    /// nothing holds it.
    pub fn at_rest(&self, current: f64, pushed: impl Fn(f64) -> f64) -> Option<AtRest> {
        let stop = self.stop_stiffness;
        let load = |p: f64| {
            let spring = self.return_force + self.stiffness * (p - self.rest);
            self.magnet.force(self.core - p, current).0 - spring - pushed(p) + self.unbalance * self.mass * self.gravity
        };
        let stops = |p: f64| stop * (self.rest - p).max(0.0) - stop * (p - self.core).max(0.0);
        let balance = |p: f64| load(p) + stops(p);
        // As far as a stop gives way under all that draws, and under all that presses back.
        let beyond = (load(self.core).abs() + load(self.rest).abs()) / stop + 1e-9 * (self.core - self.rest);
        let at_core = || roots::bracketed(balance, self.core, self.core + beyond);
        let at_rest = || roots::bracketed(balance, self.rest - beyond, self.rest);
        let between = || {
            let place = |n: u32| self.rest + (self.core - self.rest) * f64::from(n) / f64::from(PLACES);
            (0..PLACES).find_map(|n| roots::bracketed(balance, place(n), place(n + 1)))
        };
        let place = if current == 0.0 {
            at_rest().or_else(between).or_else(at_core)
        } else {
            at_core().or_else(at_rest).or_else(between)
        }?;
        Some(AtRest {
            place,
            core_force: stop * (place - self.core).max(0.0),
            rest_force: stop * (self.rest - place).max(0.0),
            magnet_force: self.magnet.force(self.core - place, current).0,
        })
    }
}
