//! The contact law of a scene.

use crate::contact::linear::Linear;
use crate::contact::power::{HERTZ, Power};
use crate::contact::{Branch, Branches};
use crate::math::nodal::Nodal;

/// A contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// A power of the indentation, with viscoelastic damping: Hertz, or rough.
    Power(Power),
    /// Linearised about the preload.
    Linear(Linear),
}

impl Law {
    /// The power of the indentation, if it is that.
    #[inline(always)]
    pub fn power(&self) -> Option<&Power> {
        match self {
            Self::Power(power) => Some(power),
            Self::Linear(_) => None,
        }
    }

    /// A length with the sign of the contact force: positive while the contact is closed, m.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        match self {
            Self::Power(power) => power.engagement(d, rate),
            Self::Linear(linear) => linear.engagement(d, rate),
        }
    }

    /// Whether the engagement of bodies that approach this fast (m/s), or faster, is their way alone.
    pub(crate) fn engages_by_way(&self, slowest: f64) -> bool {
        match self {
            Self::Power(power) => power.by_rate() * slowest >= -power.least,
            Self::Linear(linear) => linear.damping == 0.0,
        }
    }

    /// Time (s) by which the velocity counts in the engagement.
    pub(crate) fn by_rate(&self) -> f64 {
        match self {
            Self::Power(power) => power.by_rate(),
            Self::Linear(linear) => linear.damping,
        }
    }

    /// The part of the engagement that the damper resists, m; the engagement is no more than that.
    pub(crate) fn resisted(&self, d: f64, rate: f64) -> f64 {
        match self {
            Self::Power(power) => d + power.by_rate() * rate,
            Self::Linear(linear) => linear.engagement(d, rate),
        }
    }

    /// Whether it is all of the engagement at this indentation (m): bodies without a force that are still indented, as their
    /// damper holds what they would push.
    pub(crate) fn is_indented(&self, d: f64) -> bool {
        self.power().is_none_or(|power| d > power.least)
    }

    /// Contact force at the indentation `d` (m) growing at `rate` (m/s), N.
    pub fn force(&self, d: f64, rate: f64) -> f64 {
        if self.engagement(d, rate) > 0.0 { self.closed_branch(d, rate).force } else { 0.0 }
    }

    /// Force and derivatives on the closed branch, continued where the contact would be open.
    #[inline(always)]
    pub fn closed_branch(&self, d: f64, rate: f64) -> Branch {
        self.closed_branches(&[d], &[rate]).into()
    }

    /// The same at several indentations (m) and velocities (m/s).
    #[inline(always)]
    pub(crate) fn closed_branches<const S: usize>(&self, d: &Nodal<S>, rate: &Nodal<S>) -> Branches<S> {
        match self {
            Self::Power(power) => power.closed_branches(d, rate),
            Self::Linear(linear) => linear.closed_branches(d, rate),
        }
    }

    /// Constant force over a step from one indentation to another (m) that does the work of the elastic force and
    /// dissipates, N: the discrete gradient of the elastic energy, plus damping time times mean stiffness times `speed`
    /// (m/s), the mean velocity. It increases with the second indentation, and is never tensile unless bonded.
    pub fn mean_force(&self, from: f64, to: f64, speed: f64) -> f64 {
        let (elastic, stiffness) = match self {
            Self::Power(power) => (power.mean_force(from, to), power.mean_stiffness(from, to)),
            Self::Linear(linear) => (linear.mean_force(from, to), linear.mean_stiffness(from, to)),
        };
        self.without_pull(elastic + self.damping() * stiffness * speed)
    }

    /// Elastic energy at the indentation `d0 + deviation` above its tangent at `d0` (m), J; never negative.
    pub fn energy_above_tangent(&self, d0: f64, deviation: f64) -> f64 {
        match self {
            Self::Power(power) => power.energy_above_tangent(d0, deviation),
            Self::Linear(linear) => linear.energy_above_tangent(d0, deviation),
        }
    }

    /// Whether the contact can bear tension.
    pub fn never_opens(&self) -> bool {
        matches!(self, Self::Linear(linear) if linear.bonded)
    }

    /// The force (N), or zero if tensile in a contact that cannot bear tension.
    pub fn without_pull(&self, force: f64) -> f64 {
        // Not `max`, which would make zero of NaN: an opening that never was.
        if force < 0.0 && !self.never_opens() { 0.0 } else { force }
    }

    /// The same law, opening where its force is lost in what is allowed ([`Power::parting`]).
    pub(crate) fn parting(self, tolerance: f64, scale: f64) -> Self {
        match self {
            Self::Power(power) => Self::Power(power.parting(tolerance, scale)),
            Self::Linear(_) => self,
        }
    }

    /// Force that counts as none where the contact opens, N.
    pub(crate) fn traces(&self) -> f64 {
        self.power().map_or(0.0, |power| power.traces)
    }

    /// Whether the force of its damper grows more steeply at first touch than a root of time, `d^(p-1)` with `1 < p < 3/2`: nearly
    /// a jump, which no polynomial follows.
    pub(crate) fn is_steep_at_touch(&self) -> bool {
        let steep = |power: &Power| power.damping > 0.0 && power.exponent > 1.0 && power.exponent < HERTZ;
        self.power().is_some_and(steep)
    }

    /// Static indentation beyond first touch under `force` (N), m.
    pub fn overlap(&self, force: f64) -> f64 {
        match self {
            Self::Power(power) => power.indentation(force),
            Self::Linear(linear) => force / linear.stiffness,
        }
    }

    /// Tangent stiffness under `force` (N), N/m.
    pub fn tangent_stiffness(&self, force: f64) -> f64 {
        self.stiffness(self.overlap(force))
    }

    /// Tangent stiffness of the closed contact as a power of the elastic force: factor (at 1 N, N/m) and exponent (1).
    pub fn stiffness_by_force(&self) -> (f64, f64) {
        match self {
            Self::Power(power) => power.stiffness_by_force(),
            Self::Linear(linear) => (linear.stiffness, 0.0),
        }
    }

    /// Tangent stiffness at the indentation `d` (m), N/m.
    #[inline(always)]
    pub fn stiffness(&self, d: f64) -> f64 {
        match self {
            Self::Power(power) => power.tangent_stiffness(d),
            Self::Linear(linear) => linear.stiffness,
        }
    }

    /// Damping time beta_c, s.
    pub fn damping(&self) -> f64 {
        match self {
            Self::Power(power) => power.damping,
            Self::Linear(linear) => linear.damping,
        }
    }
}
