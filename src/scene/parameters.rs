//! The parameters and effects, grouped by what they describe, and their start values: the specimen.

use crate::variables::{AxialForceKind, ContactLawKind, ExcitationKind, RealParameter, ResistanceKind};
use serde::{Deserialize, Serialize};

/// Parameters and effects of a simulation. SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The spring.
    pub beam: Beam,
    /// The rivet at the tip of the spring.
    pub tip: Tip,
    /// The two contact surfaces.
    pub contact: Contact,
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
}

/// Contact geometry and law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Overtravel s, m.
    pub overtravel: f64,
    /// Radius of the camber R, m.
    pub curvature_radius: f64,
    /// Viscoelastic damping time, s.
    pub damping: f64,
    /// Voltage at which the constriction melts, V.
    pub melting_voltage: f64,
    /// The contact at the tip of the spring.
    pub moving: Material,
    /// The fixed contact.
    pub fixed: Material,
}

/// Elastic material of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
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
    /// Amplitude of sine, sweep and half sine, m/s2.
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
}

impl Default for Scene {
    fn default() -> Self {
        use RealParameter as P;
        let start = |parameter: P| parameter.variable().start;
        Self {
            beam: Beam {
                length: start(P::BeamLength),
                width: start(P::BeamWidth),
                thickness: start(P::BeamThickness),
                youngs_modulus: start(P::BeamYoungsModulus),
                density: start(P::BeamDensity),
                mass_damping: start(P::BeamMassDamping),
                stiffness_damping: start(P::BeamStiffnessDamping),
                axial_force: start(P::BeamAxialForce),
            },
            tip: Tip {
                mass: start(P::TipMass),
                rotary_inertia: start(P::TipRotaryInertia),
            },
            contact: Contact {
                overtravel: start(P::ContactOvertravel),
                curvature_radius: start(P::ContactCurvatureRadius),
                damping: start(P::ContactDamping),
                melting_voltage: start(P::ContactMeltingVoltage),
                moving: Material {
                    youngs_modulus: start(P::ContactMovingYoungsModulus),
                    poisson_ratio: start(P::ContactMovingPoissonRatio),
                },
                fixed: Material {
                    youngs_modulus: start(P::ContactFixedYoungsModulus),
                    poisson_ratio: start(P::ContactFixedPoissonRatio),
                },
            },
            resistance: Resistance {
                coefficient: start(P::ResistanceCoefficient),
                exponent: start(P::ResistanceExponent),
                film: start(P::ResistanceFilm),
                open: start(P::ResistanceOpen),
                resistivity: start(P::ResistanceResistivity),
                hardness: start(P::ResistanceHardness),
            },
            excitation: Excitation {
                amplitude: start(P::ExcitationAmplitude),
                frequency: start(P::ExcitationFrequency),
                phase: start(P::ExcitationPhase),
                start_time: start(P::ExcitationStartTime),
                end_frequency: start(P::ExcitationEndFrequency),
                duration: start(P::ExcitationDuration),
                displacement_limit: start(P::ExcitationDisplacementLimit),
                spectral_density: start(P::ExcitationSpectralDensity),
                seed: 1,
            },
            environment: Environment {
                gravity: start(P::EnvironmentGravity),
                temperature: start(P::EnvironmentTemperature),
            },
            chatter: Chatter {
                resistance_threshold: start(P::ChatterResistanceThreshold),
                minimum_duration: start(P::ChatterMinimumDuration),
            },
            solver: Solver {
                tolerance: start(P::SolverTolerance),
                modes: 0,
                maximum_step: start(P::SolverMaximumStep),
            },
            effects: Effects {
                excitation: ExcitationKind::None,
                contact_law: ContactLawKind::Hertz,
                axial_force: AxialForceKind::FromPreload,
                contact_damping: true,
                resistance: ResistanceKind::PowerLaw,
                heating: false,
                chatter: true,
                extremes: true,
                energy: false,
            },
        }
    }
}
