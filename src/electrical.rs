//! Contact resistance and temperature as functions of contact force and current.
//!
//! The constriction is a power law of the force: Machines 2025, 13(1), 52, eqs. (28), (29), `R_c = H F^(-n)`, or
//! Holm's `R_c = (rho / 2) sqrt(pi H_B / F)`, or follows from the tangent stiffness of the contact, `R_c = rho E* / k(F)`: the
//! incremental stiffness and the conductance of any two rough bodies are proportional (J. R. Barber, Proc. R. Soc. A 459
//! (2003) 53); a circle of radius `a` has `k = 2 E* a` and `R = rho / (2 a)`. The film is in series with it, the open resistance in parallel to both:
//! `G = 1 / (R_c + R_film) + 1 / R_open`, without the first term at zero force. Arcs are not modelled.

use std::f64::consts::PI;

use crate::contact::law::Law;
use crate::contact::power::reduced_modulus;
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
                (
                    resistance.resistivity * reduced_modulus(&scene.contact) / stiffness,
                    exponent,
                )
            }
            ResistanceKind::None => return None,
        };
        Some(Self {
            coefficient,
            exponent,
            film: resistance.film,
            open: resistance.open,
        })
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
        if force > 0.0 {
            1.0 / (self.constriction(force) + self.film)
        } else {
            0.0
        }
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
            return if self.coefficient > constriction {
                f64::INFINITY
            } else {
                f64::MIN_POSITIVE
            };
        }
        (self.coefficient / constriction).powf(1.0 / self.exponent)
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
        (
            -by_voltage * current.abs() * self.exponent * constriction / force,
            by_voltage * resistance,
        )
    }
}

/// The largest voltage that heats the contact spot, V.
fn highest_voltage(scene: &Scene) -> f64 {
    scene.contact.melting_voltage.min(scene.contact.open_voltage)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::power::Power;
    use crate::variables::ContactLawKind;

    fn scene(kind: ResistanceKind) -> Scene {
        let mut scene = Scene::default();
        scene.effects.resistance = kind;
        scene
    }

    fn of(scene: &Scene) -> Option<ElectricalContact> {
        ElectricalContact::new(scene, &Law::Power(Power::of(scene)))
    }

    #[test]
    fn published_values() {
        let electrical = of(&scene(ResistanceKind::PowerLaw)).unwrap();
        // The power law at the ends of the published waveform, 34.25 and 63.9 mOhm.
        assert!((1.0 / electrical.conductance(0.200_149) - 34.252e-3).abs() < 1e-6);
        assert!((1.0 / electrical.conductance(0.103_905) - 63.90e-3).abs() < 1e-4);
        let holm = of(&scene(ResistanceKind::Holm)).unwrap();
        // (2.2e-8 / 2) sqrt(pi 0.785e9 / 0.152) by hand.
        assert!((1.0 / holm.conductance(0.152) - 1.401e-3).abs() < 1e-6);
        assert!(of(&scene(ResistanceKind::None)).is_none());
    }

    #[test]
    fn stiffness_gives_resistance() {
        // A circle of Hertz: R = rho / (2 a), a = sqrt(R d), at 0.152 N.
        let mut smooth = scene(ResistanceKind::Barber);
        let d = Power::of(&smooth).indentation(0.152);
        let circle = 0.5 * smooth.resistance.resistivity / (smooth.contact.curvature_radius * d).sqrt();
        let found = 1.0 / of(&smooth).unwrap().conductance(0.152);
        assert!((found / circle - 1.0).abs() < 1e-9, "{found} {circle}");
        // Rough: rho E* / k_r at F_r, and as k there.
        smooth.effects.contact_law = ContactLawKind::Rough;
        let rough = of(&smooth).unwrap();
        let at_given = smooth.resistance.resistivity * reduced_modulus(&smooth.contact) / 4.37e4;
        for (force, factor) in [
            (0.152, 1.0),
            (0.304, 2_f64.powf(0.54)),
            (0.01, (0.01_f64 / 0.152).powf(0.54)),
        ] {
            let found = 1.0 / rough.conductance(force);
            assert!((found * factor / at_given - 1.0).abs() < 1e-9, "{found} at {force} N");
        }
        // Linear: one resistance while closed, so that any force is enough, or none.
        smooth.contact.stiffness_exponent = 0.0;
        let linear = of(&smooth).unwrap();
        assert_eq!(linear.conductance(1e-9), linear.conductance(1.0));
        assert_eq!(linear.force_at(60.0), f64::MIN_POSITIVE);
        assert_eq!(linear.force_at(1e-3), f64::INFINITY);
    }

    #[test]
    fn the_force_at_a_threshold_is_where_the_resistance_passes_it() {
        for kind in [ResistanceKind::PowerLaw, ResistanceKind::Holm, ResistanceKind::Barber] {
            for film in [0.0, 0.5] {
                let mut scene = scene(kind);
                scene.resistance.film = film;
                let electrical = of(&scene).unwrap();
                for threshold in [1.0, 60.0, 1e6, 9e8] {
                    let force = electrical.force_at(threshold);
                    let found = 1.0 / electrical.conductance(force);
                    assert!(
                        (found / threshold - 1.0).abs() < 1e-9,
                        "{kind:?} {film} {threshold}: {found}"
                    );
                }
                assert_eq!(electrical.force_at(1e9), 0.0);
                assert_eq!(electrical.force_at(2e9), 0.0);
            }
        }
        let mut filmed = scene(ResistanceKind::PowerLaw);
        filmed.resistance.film = 100.0;
        assert_eq!(of(&filmed).unwrap().force_at(60.0), f64::INFINITY);
    }

    #[test]
    fn the_melting_voltage_gives_the_melting_temperature() {
        let scene = scene(ResistanceKind::PowerLaw);
        let electrical = of(&scene).unwrap();
        // 0.37 V: sqrt(298.15^2 + 0.37^2 / (4 2.45e-8)) = 1218.9 K, near the melting point of silver (1235 K).
        assert!((electrical.temperature(&scene, 0.15, 1e3) - 1218.9).abs() < 0.1);
        assert_eq!(electrical.temperature(&scene, 0.15, 0.0), 298.15);
        assert_eq!(electrical.temperature(&scene, 0.0, 1e3), 298.15);
        // A source of less than that, and its derivatives: 0.1 V gives sqrt(298.15^2 + 0.1^2 / (4 2.45e-8)).
        let mut weak = scene.clone();
        weak.contact.open_voltage = 0.1;
        assert!((electrical.temperature(&weak, 0.15, 1e3) - 436.960).abs() < 1e-3);
        assert_eq!(electrical.temperature_slopes(&weak, 0.15, 1e3), (0.0, 0.0));
        // Below it the derivatives are the slopes.
        let (force, current, step) = (0.15, -3.0, 1e-6);
        let slopes = electrical.temperature_slopes(&scene, force, current);
        let by_force = electrical.temperature(&scene, force + step, current)
            - electrical.temperature(&scene, force - step, current);
        let by_current = electrical.temperature(&scene, force, current - step)
            - electrical.temperature(&scene, force, current + step);
        assert!((by_force / (2.0 * step) / slopes.0 - 1.0).abs() < 1e-6, "{slopes:?}");
        assert!((by_current / (2.0 * step) / slopes.1 - 1.0).abs() < 1e-6, "{slopes:?}");
    }
}
