//! The parameters and effects, grouped by what they describe, and their start values, those of `modelDescription.xml`: the specimen.

use crate::variables::{AxialForceKind, ContactLawKind, ExcitationKind, FrictionKind, ResistanceKind, start};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

use crate::scene::spring::SpringFile;

/// Parameters and effects of a simulation. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The spring.
    pub beam: Beam,
    /// The spring of `beam.file`, in place of the length, width and thickness of the beam.
    pub spring: Option<Arc<SpringFile>>,
    /// The rivet at the tip of the spring.
    pub tip: Tip,
    /// The two contact surfaces.
    pub contact: Contact,
    /// The second contact, on the other side of the spring.
    pub second: Second,
    /// Friction between the contacts.
    pub friction: Friction,
    /// Contact resistance.
    pub resistance: Resistance,
    /// Generated base acceleration.
    pub excitation: Excitation,
    /// Surroundings.
    pub environment: Environment,
    /// Criterion for interruptions.
    pub chatter: Chatter,
    /// Accuracy.
    pub solver: Solver,
    /// Effects.
    pub effects: Effects,
}

/// Cantilever spring, as an equivalent uniform section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Beam {
    /// Free length, m.
    pub length: f64,
    /// Width, m.
    pub width: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Density, kg/m3.
    pub density: f64,
    /// Rayleigh damping alpha, 1/s.
    pub mass_damping: f64,
    /// Rayleigh damping beta, s.
    pub stiffness_damping: f64,
    /// Prescribed axial force, compression positive, N.
    pub axial_force: f64,
}

/// Rivet at the tip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tip {
    /// Mass, kg.
    pub mass: f64,
    /// Rotary inertia, kg m2.
    pub rotary_inertia: f64,
    /// Distance of the contact point from the neutral axis of the spring, m.
    pub contact_height: f64,
}

/// Contact geometry and law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Overtravel s, m.
    pub overtravel: f64,
    /// Radius of the camber R, m.
    pub curvature_radius: f64,
    /// Rough: tangent stiffness k_r at the force F_r, N/m.
    pub stiffness: f64,
    /// Rough: the force F_r, N.
    pub stiffness_force: f64,
    /// Rough: exponent n of the force in the stiffness.
    pub stiffness_exponent: f64,
    /// Viscoelastic damping time, s.
    pub damping: f64,
    /// Voltage at which the constriction melts, V.
    pub melting_voltage: f64,
    /// Voltage of the source, which the contact has at most, V.
    pub open_voltage: f64,
    /// The contact at the tip of the spring.
    pub moving: Material,
    /// The fixed contact.
    pub fixed: Material,
}

/// Second contact: of the materials of the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Second {
    /// Gap at the preload, m.
    pub gap: f64,
    /// Radius of the camber, m.
    pub curvature_radius: f64,
    /// Rough: tangent stiffness at the force F_r of the first, N/m.
    pub stiffness: f64,
    /// Viscoelastic damping time, s.
    pub damping: f64,
    /// Shortest make of an open contact, first or second, that counts, s.
    pub minimum_duration: f64,
}

/// Elastic material of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

/// Friction between the contacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// Coefficient mu.
    pub coefficient: f64,
    /// Friction force at the preload as a share of its limit; -1: as closing has left it.
    pub initial: f64,
}

/// Contact resistance, by power law or by Holm, in series with a film, both in parallel with the open resistance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Resistance {
    /// H, Ohm at 1 N.
    pub coefficient: f64,
    /// n.
    pub exponent: f64,
    /// Film, Ohm.
    pub film: f64,
    /// Open contact, Ohm.
    pub open: f64,
    /// Resistivity of the metal, Ohm m.
    pub resistivity: f64,
    /// Hardness of the softer metal, Pa.
    pub hardness: f64,
}

/// Generated base acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Excitation {
    /// Amplitude of sine, sweep and half sine, m/s2; a negative one begins by pulling.
    pub amplitude: f64,
    /// Frequency of the sine, at the start of the sweep, or lower end of the band, Hz.
    pub frequency: f64,
    /// Phase of sine and sweep at the start, rad.
    pub phase: f64,
    /// Start, s.
    pub start_time: f64,
    /// Frequency at the end of the sweep, or upper end of the band, Hz.
    pub end_frequency: f64,
    /// Duration of the sweep or the half sine, s.
    pub duration: f64,
    /// Largest displacement amplitude, m; 0: no limit.
    pub displacement_limit: f64,
    /// One-sided power spectral density of the random acceleration, (m/s2)^2/Hz.
    pub spectral_density: f64,
    /// Seed of the random phases and frequencies.
    pub seed: i32,
}

/// Surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// Constant acceleration, m/s2.
    pub gravity: f64,
    /// Temperature, K.
    pub temperature: f64,
}

/// Criterion for interruptions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chatter {
    /// Resistance above which the contact is interrupted, Ohm.
    pub resistance_threshold: f64,
    /// Shortest interruption that counts, s.
    pub minimum_duration: f64,
}

/// Accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Solver {
    /// Allowed error of the contact force, relative to its scale; 0: [`Solver::DEFAULT_TOLERANCE`].
    pub tolerance: f64,
    /// Number of beam modes; 0: chosen from the tolerance.
    pub modes: i32,
    /// Longest integration step, s; 0: no limit.
    pub maximum_step: f64,
}

impl Solver {
    /// Tolerance if neither the scene nor the experiment sets one.
    pub const DEFAULT_TOLERANCE: f64 = 1e-6;
    /// Smaller tolerances are raised to this one.
    pub const TOLERANCE_FLOOR: f64 = 1e-11;

    /// The effective tolerance.
    pub fn effective_tolerance(&self) -> f64 {
        if self.tolerance > 0.0 {
            self.tolerance.max(Self::TOLERANCE_FLOOR)
        } else {
            Self::DEFAULT_TOLERANCE
        }
    }
}

/// Effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is a parameter of its own")]
pub struct Effects {
    /// Generated base acceleration.
    pub excitation: ExcitationKind,
    /// Contact law.
    pub contact_law: ContactLawKind,
    /// Axial force.
    pub axial_force: AxialForceKind,
    /// Whether the contact is damped.
    pub contact_damping: bool,
    /// Contact resistance.
    pub resistance: ResistanceKind,
    /// Whether the current heats the contact.
    pub heating: bool,
    /// Whether interruptions are counted.
    pub chatter: bool,
    /// Whether extremes within communication steps are computed.
    pub extremes: bool,
    /// Whether the energy balance is computed.
    pub energy: bool,
    /// Whether there is a second contact.
    pub second_contact: bool,
    /// Friction.
    pub friction: FrictionKind,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            beam: Beam {
                length: start::BEAM_LENGTH,
                width: start::BEAM_WIDTH,
                thickness: start::BEAM_THICKNESS,
                youngs_modulus: start::BEAM_YOUNGS_MODULUS,
                density: start::BEAM_DENSITY,
                mass_damping: start::BEAM_MASS_DAMPING,
                stiffness_damping: start::BEAM_STIFFNESS_DAMPING,
                axial_force: start::BEAM_AXIAL_FORCE,
            },
            spring: None,
            tip: Tip {
                mass: start::TIP_MASS,
                rotary_inertia: start::TIP_ROTARY_INERTIA,
                contact_height: start::TIP_CONTACT_HEIGHT,
            },
            contact: Contact {
                overtravel: start::CONTACT_OVERTRAVEL,
                curvature_radius: start::CONTACT_CURVATURE_RADIUS,
                stiffness: start::CONTACT_STIFFNESS,
                stiffness_force: start::CONTACT_STIFFNESS_FORCE,
                stiffness_exponent: start::CONTACT_STIFFNESS_EXPONENT,
                damping: start::CONTACT_DAMPING,
                melting_voltage: start::CONTACT_MELTING_VOLTAGE,
                open_voltage: start::CONTACT_OPEN_VOLTAGE,
                moving: Material {
                    youngs_modulus: start::CONTACT_MOVING_YOUNGS_MODULUS,
                    poisson_ratio: start::CONTACT_MOVING_POISSON_RATIO,
                },
                fixed: Material {
                    youngs_modulus: start::CONTACT_FIXED_YOUNGS_MODULUS,
                    poisson_ratio: start::CONTACT_FIXED_POISSON_RATIO,
                },
            },
            second: Second {
                gap: start::SECOND_GAP,
                curvature_radius: start::SECOND_CURVATURE_RADIUS,
                stiffness: start::SECOND_STIFFNESS,
                damping: start::SECOND_DAMPING,
                minimum_duration: start::SECOND_MINIMUM_DURATION,
            },
            friction: Friction {
                coefficient: start::FRICTION_COEFFICIENT,
                initial: start::FRICTION_INITIAL,
            },
            resistance: Resistance {
                coefficient: start::RESISTANCE_COEFFICIENT,
                exponent: start::RESISTANCE_EXPONENT,
                film: start::RESISTANCE_FILM,
                open: start::RESISTANCE_OPEN,
                resistivity: start::RESISTANCE_RESISTIVITY,
                hardness: start::RESISTANCE_HARDNESS,
            },
            excitation: Excitation {
                amplitude: start::EXCITATION_AMPLITUDE,
                frequency: start::EXCITATION_FREQUENCY,
                phase: start::EXCITATION_PHASE,
                start_time: start::EXCITATION_START_TIME,
                end_frequency: start::EXCITATION_END_FREQUENCY,
                duration: start::EXCITATION_DURATION,
                displacement_limit: start::EXCITATION_DISPLACEMENT_LIMIT,
                spectral_density: start::EXCITATION_SPECTRAL_DENSITY,
                seed: start::EXCITATION_SEED,
            },
            environment: Environment {
                gravity: start::ENVIRONMENT_GRAVITY,
                temperature: start::ENVIRONMENT_TEMPERATURE,
            },
            chatter: Chatter {
                resistance_threshold: start::CHATTER_RESISTANCE_THRESHOLD,
                minimum_duration: start::CHATTER_MINIMUM_DURATION,
            },
            solver: Solver {
                tolerance: start::SOLVER_TOLERANCE,
                modes: start::SOLVER_MODES,
                maximum_step: start::SOLVER_MAXIMUM_STEP,
            },
            effects: Effects {
                excitation: start::EFFECTS_EXCITATION,
                contact_law: start::EFFECTS_CONTACT_LAW,
                axial_force: start::EFFECTS_AXIAL_FORCE,
                contact_damping: start::EFFECTS_CONTACT_DAMPING,
                resistance: start::EFFECTS_RESISTANCE,
                heating: start::EFFECTS_HEATING,
                chatter: start::EFFECTS_CHATTER,
                extremes: start::EFFECTS_EXTREMES,
                energy: start::EFFECTS_ENERGY,
                second_contact: start::EFFECTS_SECOND_CONTACT,
                friction: start::EFFECTS_FRICTION,
            },
        }
    }
}
