//! Ports and links: where forces act on the modes, and the laws of these forces.
//!
//! A **port** is a linear functional of the modal coordinates, `y = sum b_i q_i`: the deflection of the spring at its contact, or
//! its displacement along the contact as it turns. A force at a port loads each mode with `b_i` times the force.
//!
//! A **link** is one scalar law at a port. Its approach `d` is the displacement by which the two bodies come together, and the
//! law gives the force `F` between them:
//!
//! ```text
//! d = d_0 + sum of the inputs that move its other body - s y        s = 1 or -1: whether the port opens or closes it
//! F = law(d, d')
//! q_i'' + c_i q_i' + omega_i^2 q_i = sum over the links of s b_i (F - F_0) - g_i a
//! ```
//!
//! with approach `d_0` and force `F_0` of the static equilibrium, of which `q_i` are the deviations. The integrator knows modes,
//! ports and links, and not what they stand for: the contact, the second contact on the other side of the spring, whose
//! approach grows where that of the first one shrinks, and friction are links; so is a displacement that is read, without force.

use std::ops::Range;

use crate::beam::mode::{MAX_MODES, Modal, Mode, ModeState, ModeStates};
use crate::chatter::Criterion;
use crate::contact::friction::Friction;
use crate::contact::law::Law;
use crate::electrical::ElectricalContact;
use crate::magnet::Magnet;
use crate::math::simd::Arithmetic;

pub const MAX_PORTS: usize = 6;

pub const MAX_LINKS: usize = 8;

/// Most links whose forces are unknown at the same time.
pub const MAX_UNKNOWNS: usize = 6;

/// Inputs that move bodies ([`MOVING`](crate::inputs::Inputs::MOVING)): the fixed contact, the second one relative to it, and the pusher.
pub const INPUTS: usize = 3;

/// A displacement (m) or velocity (m/s) for each of [`INPUTS`], in that order.
pub type Ways = [f64; INPUTS];

/// The first contact, which every model has.
pub const CONTACT: usize = 0;

/// A linear functional of the modal coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// Displacement per modal coordinate and load on the mode per force, b_i, 1/sqrt(kg).
    pub shape: Modal,
    /// The modes that it has a part in.
    pub modes: Range<usize>,
    /// Velocity per impulse, 1/kg.
    pub mobility: f64,
    /// Static displacement per force, m/N.
    pub compliance: f64,
}

impl Port {
    /// From the displacement per coordinate of each mode.
    pub fn new(modes: &[Mode], displacement: impl Fn(&Mode) -> f64) -> Self {
        let mut shape = [0.0; MAX_MODES];
        for (entry, mode) in shape.iter_mut().zip(modes) {
            *entry = displacement(mode);
        }
        let moves = |entry: &f64| *entry != 0.0;
        let first = shape.iter().position(moves).unwrap_or(0);
        let last = shape.iter().rposition(moves).map_or(first, |last| last + 1);
        let mobility = shape.iter().map(|b| b * b).sum();
        let at_rest = shape.iter().zip(modes).filter(|(b, mode)| **b != 0.0 && mode.omega_squared > 0.0);
        let compliance = at_rest.map(|(b, mode)| b * b / mode.omega_squared).sum();
        Self { shape, modes: first..last, mobility, compliance }
    }

    /// Of the first states of modes those of the modes that it has a part in.
    #[inline(always)]
    pub fn part<'a>(&self, states: &'a [ModeState]) -> &'a [ModeState] {
        let end = self.modes.end.min(states.len());
        states.get(self.modes.start..end).unwrap_or_default()
    }

    /// Displacement (m) of the first modes.
    pub fn displacement(&self, states: &[ModeState]) -> f64 {
        self.shape.iter().zip(states).map(|(b, at)| b * at.q).sum()
    }

    /// Displacement (m) and velocity (m/s).
    #[inline(always)]
    pub fn motion<A: Arithmetic>(&self, modes: &ModeStates) -> (f64, f64) {
        let (mut y, mut rate) = (0.0, 0.0);
        for (b, mode) in self.shape.iter().zip(modes).take(self.modes.end) {
            y = A::mul_add(*b, mode.q, y);
            rate = A::mul_add(*b, mode.v, rate);
        }
        (y, rate)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkLaw {
    /// A contact, which opens.
    Contact(Law),
    /// Friction at the first contact.
    Friction(Friction),
    /// A magnet, which draws over the gap that is its approach.
    Magnet(Magnet),
    /// No force: its approach is a displacement that is read.
    Gauge,
}

#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// What the user calls it.
    pub name: &'static str,
    pub law: LinkLaw,
    /// The index of its port.
    pub port: usize,
    /// 1: a displacement of the port opens it; -1: closes it.
    pub sense: f64,
    /// Approach per displacement of each input, 1.
    pub driven: Ways,
    /// Force at the equilibrium F_0, N.
    pub force: f64,
    /// Approach at the equilibrium d_0, m; of a contact the indentation, negative: a gap.
    pub approach: f64,
    /// Electrical model, of a contact.
    pub electrical: Option<ElectricalContact>,
    /// Criterion for its interruptions, if they are counted.
    pub criterion: Option<Criterion>,
    /// The circuit that it closes ([`crate::circuits`]); `None`: it conducts nothing.
    pub circuit: Option<usize>,
}

impl Link {
    /// A link that no input moves, without force or approach at the equilibrium.
    pub fn passive(name: &'static str, law: LinkLaw, port: usize) -> Self {
        Self {
            name,
            law,
            port,
            sense: 1.0,
            driven: [0.0; INPUTS],
            force: 0.0,
            approach: 0.0,
            electrical: None,
            criterion: None,
            circuit: None,
        }
    }

    /// The contact law, if it is a contact.
    #[inline(always)]
    pub fn contact(&self) -> Option<&Law> {
        match &self.law {
            LinkLaw::Contact(law) => Some(law),
            LinkLaw::Friction(_) | LinkLaw::Magnet(_) | LinkLaw::Gauge => None,
        }
    }

    /// Approach or its velocity that inputs displaced so far, or moving so fast, give it.
    #[inline(always)]
    pub fn offset(&self, inputs: &Ways) -> f64 {
        let pairs = self.driven.iter().zip(inputs);
        pairs.fold(0.0, |sum, (driven, input)| sum + driven * input)
    }

    /// A length with the sign of the contact force, m: [`Law::engagement`] at an approach given as deviation (m); negative
    /// without a contact law.
    #[inline(always)]
    pub fn engagement(&self, deviation: f64, rate: f64) -> f64 {
        self.contact().map_or(-1.0, |law| law.engagement(self.approach + deviation, rate))
    }

    /// Force of the contact law at an approach given as deviation (m), N; 0 without one.
    pub fn force_at(&self, deviation: f64, rate: f64) -> f64 {
        self.contact().map_or(0.0, |law| law.force(self.approach + deviation, rate))
    }
}
