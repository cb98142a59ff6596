//! The contact law of a scene.

use crate::contact::Branch;
use crate::contact::hertz::Hertz;
use crate::contact::linear::Linear;

/// A contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Hertz with viscoelastic damping.
    Hertz(Hertz),
    /// Linearised about the preload.
    Linear(Linear),
}

impl Law {
    /// Hertz, if it is that.
    #[inline(always)]
    pub fn hertz(&self) -> Option<&Hertz> {
        match self {
            Self::Hertz(hertz) => Some(hertz),
            Self::Linear(_) => None,
        }
    }

    /// A length with the sign of the contact force: positive while the contact is closed, m.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.engagement(d, rate),
            Self::Linear(linear) => linear.engagement(d, rate),
        }
    }

    /// Contact force at the indentation `d` (m) growing at `rate` (m/s), N.
    pub fn force(&self, d: f64, rate: f64) -> f64 {
        if self.engagement(d, rate) > 0.0 {
            self.closed_branch(d, rate).force
        } else {
            0.0
        }
    }

    /// Force and derivatives on the closed branch, continued where the contact would be open.
    #[inline(always)]
    pub fn closed_branch(&self, d: f64, rate: f64) -> Branch {
        match self {
            Self::Hertz(hertz) => hertz.closed_branch(d, rate),
            Self::Linear(linear) => linear.closed_branch(d, rate),
        }
    }

    /// Constant force over a step from one indentation to another (m) that does the work of the elastic force and
    /// dissipates, N: the discrete gradient of the elastic energy, plus damping time times mean stiffness times `speed`
    /// (m/s), the mean velocity. It increases with the second indentation, and is never tensile unless bonded.
    pub fn mean_force(&self, from: f64, to: f64, speed: f64) -> f64 {
        let (elastic, stiffness) = match self {
            Self::Hertz(hertz) => (hertz.mean_force(from, to), hertz.mean_stiffness(from, to)),
            Self::Linear(linear) => (linear.mean_force(from, to), linear.mean_stiffness(from, to)),
        };
        self.without_pull(elastic + self.damping() * stiffness * speed)
    }

    /// Elastic energy at the indentation `d0 + deviation` above its tangent at `d0` (m), J; never negative.
    pub fn energy_above_tangent(&self, d0: f64, deviation: f64) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.energy_above_tangent(d0, deviation),
            Self::Linear(linear) => linear.energy_above_tangent(d0, deviation),
        }
    }

    /// As hard and as damped as the harder and the more damped of two.
    #[must_use]
    pub fn hardest(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Hertz(a), Self::Hertz(b)) => Self::Hertz(Hertz {
                coefficient: a.coefficient.max(b.coefficient),
                damping: a.damping.max(b.damping),
            }),
            _ => *self,
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

    /// Static indentation beyond first touch under `force` (N), m.
    pub fn overlap(&self, force: f64) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.indentation(force),
            Self::Linear(linear) => force / linear.stiffness,
        }
    }

    /// Tangent stiffness under `force` (N), N/m.
    pub fn tangent_stiffness(&self, force: f64) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.tangent_stiffness(hertz.indentation(force)),
            Self::Linear(linear) => linear.stiffness,
        }
    }

    /// Tangent stiffness at the indentation `d` (m), N/m.
    #[inline(always)]
    pub fn stiffness(&self, d: f64) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.tangent_stiffness(d),
            Self::Linear(linear) => linear.stiffness,
        }
    }

    /// Damping time beta_c, s.
    pub fn damping(&self) -> f64 {
        match self {
            Self::Hertz(hertz) => hertz.damping,
            Self::Linear(linear) => linear.damping,
        }
    }
}
