//! Hertzian contact with viscoelastic dissipation.
//!
//! Machines 2025, 13(1), 52, eqs. (7), (8), and (14) with the stiffness updated at every instant, which is the law of
//! Kuwabara and Kono (Jpn. J. Appl. Phys. 26 (1987) 1230):
//!
//! `F = max(0, k_H d^(3/2) + beta_c k_j(d) d')`, `k_j = (3/2) k_H d^(1/2)`, for `d > 0`, else 0.
//!
//! With `g = d + (3/2) beta_c d'` this is `F = k_H d^(1/2) g`: the contact is closed while both `d` and `g` are positive.

use crate::scene::Contact;

/// Constants of the contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// k_H = (4/3) E* sqrt(R), N/m^1.5.
    pub coefficient: f64,
    /// Damping time beta_c, s.
    pub damping: f64,
}

/// Force with its partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearised {
    /// Force, N.
    pub force: f64,
    /// dF/dd, N/m.
    pub stiffness: f64,
    /// dF/dd', N s/m.
    pub damping: f64,
}

impl Hertz {
    /// Of the two materials and the camber.
    pub fn new(contact: &Contact) -> Self {
        let compliance = |nu: f64, e: f64| (1.0 - nu * nu) / e;
        let modulus = 1.0
            / (compliance(contact.moving.poisson_ratio, contact.moving.youngs_modulus)
                + compliance(contact.fixed.poisson_ratio, contact.fixed.youngs_modulus));
        Self {
            coefficient: 4.0 / 3.0 * modulus * contact.curvature_radius.sqrt(),
            damping: contact.damping,
        }
    }

    /// Elastic force at the indentation (m), N.
    pub fn elastic_force(&self, indentation: f64) -> f64 {
        let d = indentation.max(0.0);
        self.coefficient * d * d.sqrt()
    }

    /// Tangent stiffness k_j at the indentation (m), N/m.
    pub fn tangent_stiffness(&self, indentation: f64) -> f64 {
        1.5 * self.coefficient * indentation.max(0.0).sqrt()
    }

    /// Indentation at which the elastic force is `force` (N), m.
    pub fn indentation(&self, force: f64) -> f64 {
        (force / self.coefficient).powf(2.0 / 3.0)
    }

    /// Contact force at the indentation `d` (m) growing at `rate` (m/s), N.
    pub fn force(&self, d: f64, rate: f64) -> f64 {
        if d > 0.0 {
            (self.coefficient * d.sqrt() * self.engagement(d, rate)).max(0.0)
        } else {
            0.0
        }
    }

    /// `g = d + (3/2) beta_c d'`, m: has the sign of the force where surfaces overlap, and reaches zero where they part.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        1.5f64.mul_add(self.damping * rate, d)
    }

    /// The closed branch continued smoothly past the release (the force may turn negative), for the steps that end at
    /// the release.
    pub fn closed_branch(&self, d: f64, rate: f64) -> Linearised {
        if d <= 0.0 {
            return Linearised {
                force: 0.0,
                stiffness: 0.0,
                damping: 0.0,
            };
        }
        let root = self.coefficient * d.sqrt();
        let g = self.engagement(d, rate);
        Linearised {
            force: root * g,
            stiffness: root * (1.0 + 0.5 * g / d),
            damping: 1.5 * self.damping * root,
        }
    }
}
