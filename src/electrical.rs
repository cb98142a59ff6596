//! Contact resistance and temperature as functions of contact force and current.
//!
//! The constriction is a power law of the force: Machines 2025, 13(1), 52, eqs. (28), (29), `R_c = H F^(-n)`, or
//! Holm's `R_c = (rho / 2) sqrt(pi H_B / F)`, or follows from the tangent stiffness of the contact, `R_c = rho E* / k(F)`: the
//! incremental stiffness and the conductance of any two rough bodies are proportional (J. R. Barber, Proc. R. Soc. A 459
//! (2003) 53); a circle of radius `a` has `k = 2 E* a` and `R = rho / (2 a)`. The film is in series with it, the open resistance in parallel to both:
//! `G = 1 / (R_c + R_film) + 1 / R_open`, without the first term at zero force. Arcs are not modelled.

use std::f64::consts::PI;

use crate::contact::law::{Law, reduced_modulus};
use crate::scene::Scene;
use crate::variables::ResistanceKind;

/// Lorenz number: thermal conductivity over the product of electrical conductivity and temperature, V2/K2.
const LORENZ: f64 = 2.45e-8;

/// Electrical model of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElectricalContact {
    /// Resistance of the constriction at 1 N, Ohm.
    coefficient: f64,
    /// Exponent of the force: the constriction is proportional to `F^(-exponent)`.
    exponent: f64,
    /// Film resistance, Ohm.
    film: f64,
    /// Resistance of the open contact, Ohm.
    open: f64,
}

impl ElectricalContact {
    /// From the scene and its contact law; `None` without `effects.resistance`.
    pub fn new(scene: &Scene, law: &Law) -> Option<Self> {
        let resistance = &scene.resistance;
        let (coefficient, exponent) = match scene.effects.resistance {
            ResistanceKind::PowerLaw => (resistance.coefficient, resistance.exponent),
            ResistanceKind::Holm => (0.5 * resistance.resistivity * (PI * resistance.hardness).sqrt(), 0.5),
            ResistanceKind::Barber => {
                let (stiffness, exponent) = law.stiffness_by_force();
                (resistance.resistivity * reduced_modulus(&scene.contact) / stiffness, exponent)
            }
            ResistanceKind::None => return None,
        };
        Some(Self { coefficient, exponent, film: resistance.film, open: resistance.open })
    }

    /// Resistance of the constriction at a force (N) above 0, Ohm.
    fn constriction(&self, force: f64) -> f64 {
        self.coefficient * force.powf(-self.exponent)
    }

    /// Conductance of the contact at a force (N), S; never 0.
    pub fn conductance(&self, force: f64) -> f64 {
        self.beside(self.spot(force))
    }

    /// Conductance with the open resistance in parallel to that of all spots, S.
    pub fn beside(&self, spots: f64) -> f64 {
        spots + 1.0 / self.open
    }

    /// Conductance of the spot at a force (N), with the film, S; 0 of an open contact.
    pub fn spot(&self, force: f64) -> f64 {
        if force > 0.0 { 1.0 / (self.constriction(force) + self.film) } else { 0.0 }
    }

    /// Its derivative, S/N.
    pub fn conductance_slope(&self, force: f64) -> f64 {
        if force <= 0.0 {
            return 0.0;
        }
        let constriction = self.constriction(force);
        let closed = 1.0 / (constriction + self.film);
        self.exponent * (constriction * closed) * (closed / force)
    }

    /// Force below which the resistance exceeds a threshold (Ohm), N: 0 if it does not even when open, infinite if it
    /// does at any force.
    pub fn force_at(&self, threshold: f64) -> f64 {
        let closed = 1.0 / threshold - 1.0 / self.open;
        if closed <= 0.0 {
            return 0.0;
        }
        let constriction = 1.0 / closed - self.film;
        if constriction <= 0.0 {
            return f64::INFINITY;
        }
        if self.exponent == 0.0 {
            // A resistance that does not depend on the force: the contact is interrupted while it is open.
            return if self.coefficient > constriction { f64::INFINITY } else { f64::MIN_POSITIVE };
        }
        // At a small exponent, a force below all that can be told from none.
        (self.coefficient / constriction).powf(1.0 / self.exponent).max(f64::MIN_POSITIVE)
    }

    /// Temperature of the contact spot at a force (N) and a current (A), K: `T^2 = T_0^2 + V^2 / (4 L)` with the
    /// voltage across constriction and film, at most that of the source and the melting voltage (R. Holm, Electric
    /// Contacts, 1967, section 15; L the Lorenz number).
    pub fn temperature(&self, scene: &Scene, force: f64, current: f64) -> f64 {
        let surroundings = scene.environment.temperature;
        if force <= 0.0 {
            return surroundings;
        }
        let voltage = current.abs() * (self.constriction(force) + self.film);
        let voltage = voltage.min(highest_voltage(scene));
        surroundings.hypot(voltage / (2.0 * LORENZ.sqrt()))
    }

    /// Derivatives of the temperature with respect to force and to the magnitude of the current, K/N and K/A.
    pub fn temperature_slopes(&self, scene: &Scene, force: f64, current: f64) -> (f64, f64) {
        if force <= 0.0 {
            return (0.0, 0.0);
        }
        let constriction = self.constriction(force);
        let resistance = constriction + self.film;
        let voltage = current.abs() * resistance;
        if voltage >= highest_voltage(scene) {
            return (0.0, 0.0);
        }
        let by_voltage = voltage / (4.0 * LORENZ * self.temperature(scene, force, current));
        (-by_voltage * current.abs() * self.exponent * constriction / force, by_voltage * resistance)
    }
}

/// The largest voltage that heats the contact spot, V.
fn highest_voltage(scene: &Scene) -> f64 {
    scene.contact.melting_voltage.min(scene.contact.open_voltage)
}
