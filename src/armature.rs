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
use crate::contact::law::Law;
use crate::magnet::{Magnet, damping_ratio};
use crate::math::roots;
use crate::scene::{self, Scene};
use crate::variables::PusherKind;

/// Places between the stops at which the armature is looked for where it is at neither.
const PLACES: u32 = 200;

#[derive(Clone, Copy, Debug)]
pub struct Armature {
    /// As the scene gives it.
    pub given: scene::Armature,
    gravity: f64,
    pub magnet: Magnet,
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
        let given = scene.armature;
        (scene.effects.pusher == PusherKind::Armature).then_some(Self {
            given,
            gravity: scene.environment.gravity,
            magnet: Magnet { hold: given.hold_force, constant: given.gap_constant },
        })
    }

    pub fn mode(&self) -> Mode {
        let given = &self.given;
        let root = given.mass.sqrt();
        Mode {
            omega_squared: given.stiffness / given.mass,
            damping: given.damping / given.mass,
            participation: -given.unbalance * root,
            pusher: 1.0 / root,
            armature: 1.0 / root,
            ..Mode::default()
        }
    }

    pub fn stop(&self) -> Law {
        let given = &self.given;
        let critical = 2.0 * (given.stop_stiffness * given.mass).sqrt();
        Law::linear(given.stop_stiffness, critical * damping_ratio(given.stop_restitution))
    }

    /// Where it rests with this current of the coil (relative), and with the force of the pusher at a place (m); `None` where
    /// nothing holds it.
    pub fn at_rest(&self, current: f64, pushed: impl Fn(f64) -> f64) -> Option<AtRest> {
        let given = &self.given;
        let (stop, rest, core) = (given.stop_stiffness, given.rest_position, given.core_position);
        let load = |p: f64| {
            let spring = given.return_force + given.stiffness * (p - rest);
            self.magnet.force(core - p, current).0 - spring - pushed(p) + given.unbalance * given.mass * self.gravity
        };
        let stops = |p: f64| stop * (rest - p).max(0.0) - stop * (p - core).max(0.0);
        let balance = |p: f64| load(p) + stops(p);
        // As far as a stop gives way under all that draws, and under all that presses back.
        let beyond = (load(core).abs() + load(rest).abs()) / stop + 1e-9 * (core - rest);
        let at_core = || roots::bracketed(balance, core, core + beyond);
        let at_rest = || roots::bracketed(balance, rest - beyond, rest);
        let between = || {
            let place = |n: u32| rest + (core - rest) * f64::from(n) / f64::from(PLACES);
            (0..PLACES).find_map(|n| roots::bracketed(balance, place(n), place(n + 1)))
        };
        let place = if current == 0.0 {
            at_rest().or_else(between).or_else(at_core)
        } else {
            at_core().or_else(at_rest).or_else(between)
        }?;
        Some(AtRest {
            place,
            core_force: stop * (place - core).max(0.0),
            rest_force: stop * (rest - place).max(0.0),
            magnet_force: self.magnet.force(core - place, current).0,
        })
    }
}
