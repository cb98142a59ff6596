//! Hertzian contact with viscoelastic dissipation.
//!
//! Machines 2025, 13(1), 52, eqs. (7), (8), and (14) with the stiffness updated at every instant, which is the law of
//! Kuwabara and Kono (Jpn. J. Appl. Phys. 26 (1987) 1230):
//!
//! `F = max(0, k_H d^(3/2) + beta_c k_j(d) d')`, `k_j = (3/2) k_H d^(1/2)`, for `d > 0`, else 0.
//!
//! With `g = d + (3/2) beta_c d'` this is `F = k_H d^(1/2) g`: the contact is closed while both `d` and `g` are
//! positive.

use crate::contact::Branch;
use crate::scene::{Contact, Scene};

/// Constants of the contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// k_H = (4/3) E* sqrt(R), N/m^1.5.
    pub coefficient: f64,
    /// Damping time beta_c, s.
    pub damping: f64,
}

impl Hertz {
    /// From the two materials and the radius of curvature.
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

    /// Of the second contact of a scene, if it has one.
    pub(crate) fn of_second(scene: &Scene) -> Option<Self> {
        let (second, damped) = (scene.second, scene.effects.contact_damping);
        scene.effects.second_contact.then(|| {
            Self::new(&Contact {
                curvature_radius: second.curvature_radius,
                damping: if damped { second.damping } else { 0.0 },
                ..scene.contact
            })
        })
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

    /// Mean elastic force between two indentations (m), N: divided difference of the elastic energy
    /// `(2/5) k_H d^(5/2)`. In the square roots of the indentations it is a polynomial over a sum, free of cancellation
    /// if they are close.
    pub fn mean_force(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        if high <= 0.0 {
            return 0.0;
        }
        let y = high.sqrt();
        if low <= 0.0 {
            return 0.4 * self.coefficient * high * y * (high / (high - low));
        }
        let x = low.sqrt();
        let sum = (high * high + low * low) + (high + low) * (x * y) + high * low;
        0.4 * self.coefficient * (sum / (x + y))
    }

    /// Elastic energy at `d0 + deviation` above its tangent at `d0` (m), J; never negative. In the square roots of the
    /// indentations it is a sum of positive terms, free of cancellation for small deviations.
    pub fn energy_above_tangent(&self, d0: f64, deviation: f64) -> f64 {
        let d = d0 + deviation;
        let (x, y) = (d0.max(0.0).sqrt(), d.max(0.0).sqrt());
        self.coefficient
            * if d0 <= 0.0 {
                0.4 * y.powi(5)
            } else if d <= 0.0 {
                x.powi(3) * (0.6 * d0 - d)
            } else {
                let difference = deviation / (x + y);
                difference * difference * (0.4 * y.powi(3) + 0.8 * y * y * x + 1.2 * y * x * x + 0.6 * x.powi(3))
            }
    }

    /// Mean tangent stiffness between two indentations (m), N/m: divided difference of the elastic force.
    pub fn mean_stiffness(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        if high <= 0.0 {
            return 0.0;
        }
        let y = high.sqrt();
        if low <= 0.0 {
            return self.coefficient * y * (high / (high - low));
        }
        let x = low.sqrt();
        self.coefficient * ((high + low + x * y) / (x + y))
    }

    /// `min(d, g)`, m: positive while the contact is closed.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        d.min(d + 1.5 * self.damping * rate)
    }

    /// The closed branch, continued smoothly beyond opening (the force may be negative), for steps in which the contact
    /// opens.
    #[inline(always)]
    pub fn closed_branch(&self, d: f64, rate: f64) -> Branch {
        if d <= 0.0 {
            return Branch {
                force: 0.0,
                stiffness: 0.0,
                damping: 0.0,
            };
        }
        let root = self.coefficient * d.sqrt();
        let g = d + 1.5 * self.damping * rate;
        Branch {
            force: root * g,
            stiffness: root * (1.0 + 0.5 * g / d),
            damping: 1.5 * self.damping * root,
        }
    }
}
