//! What is to be simulated: every parameter with its value, and the effects asked for.
//!
//! The names, ranges and start values are those of `modelDescription.xml`; [`Scene::default`] is the specimen of
//! Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52, with the values the paper leaves out identified from its results.

use crate::BARE;
use crate::error::SceneError;
use crate::variables::{
    AxialForceKind, BooleanParameter, ContactLawKind, EnumerationParameter, ExcitationKind, Group, IntegerParameter,
    RealParameter, ResistanceKind, VARIABLES, Variable,
};
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
    /// The electrical side.
    pub resistance: Resistance,
    /// The base acceleration generated inside.
    pub excitation: Excitation,
    /// What surrounds the contact.
    pub environment: Environment,
    /// What counts as an interruption.
    pub chatter: Chatter,
    /// What accuracy is bought.
    pub solver: Solver,
    /// What is simulated at all.
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

/// Contact resistance, by power law or by Holm, in series with a film, both beside the open resistance.
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
    /// Amplitude, m/s2.
    pub amplitude: f64,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Phase at the start, rad.
    pub phase: f64,
    /// Start, s.
    pub start_time: f64,
    /// Frequency at the end of the sweep, or upper end of the band, Hz.
    pub end_frequency: f64,
    /// Of the sweep or the half sine, s.
    pub duration: f64,
    /// Largest displacement amplitude, m; 0: no limit.
    pub displacement_limit: f64,
    /// Of the random acceleration, one-sided, (m/s2)^2/Hz.
    pub spectral_density: f64,
    /// Of the random phases.
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

/// What counts as an interruption.
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
    /// Error allowed in the contact force, relative to its scale; 0: [`Solver::DEFAULT_TOLERANCE`].
    pub tolerance: f64,
    /// Number of beam modes; 0: chosen from the tolerance.
    pub modes: i32,
    /// Longest integration step, s; 0: no limit.
    pub maximum_step: f64,
}

impl Solver {
    /// Tolerance where neither the scene nor the experiment gives one.
    pub const DEFAULT_TOLERANCE: f64 = 1e-6;
    /// Tolerances below are raised to this one.
    pub const TOLERANCE_FLOOR: f64 = 1e-11;

    /// The tolerance in force.
    pub fn effective_tolerance(&self) -> f64 {
        if self.tolerance > 0.0 {
            self.tolerance.max(Self::TOLERANCE_FLOOR)
        } else {
            Self::DEFAULT_TOLERANCE
        }
    }
}

/// Effects asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is a parameter of its own")]
pub struct Effects {
    /// Generated base acceleration.
    pub excitation: ExcitationKind,
    /// Contact law.
    pub contact_law: ContactLawKind,
    /// Axial force.
    pub axial_force: AxialForceKind,
    /// Whether the contact dissipates.
    pub contact_damping: bool,
    /// Contact resistance.
    pub resistance: ResistanceKind,
    /// Whether the current heats the contact.
    pub heating: bool,
    /// Whether interruptions are counted.
    pub chatter: bool,
    /// Whether extremes within communication steps are found.
    pub extremes: bool,
    /// Whether the balance of energy is kept.
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

impl Scene {
    /// Value of a real parameter, in its SI unit.
    pub fn real(&self, parameter: RealParameter) -> f64 {
        let mut scene = *self;
        *scene.real_mut(parameter)
    }

    /// Value of an integer parameter.
    pub fn integer(&self, parameter: IntegerParameter) -> i32 {
        match parameter {
            IntegerParameter::SolverModes => self.solver.modes,
            IntegerParameter::ExcitationSeed => self.excitation.seed,
        }
    }

    /// Value of a Boolean parameter.
    pub fn boolean(&self, parameter: BooleanParameter) -> bool {
        let mut scene = *self;
        *scene.boolean_mut(parameter)
    }

    /// Sets a Boolean parameter.
    pub fn set_boolean(&mut self, parameter: BooleanParameter, value: bool) {
        *self.boolean_mut(parameter) = value;
    }

    fn boolean_mut(&mut self, parameter: BooleanParameter) -> &mut bool {
        use BooleanParameter as P;
        match parameter {
            P::EffectsContactDamping => &mut self.effects.contact_damping,
            P::EffectsHeating => &mut self.effects.heating,
            P::EffectsChatter => &mut self.effects.chatter,
            P::EffectsExtremes => &mut self.effects.extremes,
            P::EffectsEnergy => &mut self.effects.energy,
        }
    }

    /// Value of an enumeration parameter.
    pub fn enumeration(&self, parameter: EnumerationParameter) -> i32 {
        match parameter {
            EnumerationParameter::EffectsExcitation => self.effects.excitation as i32,
            EnumerationParameter::EffectsContactLaw => self.effects.contact_law as i32,
            EnumerationParameter::EffectsAxialForce => self.effects.axial_force as i32,
            EnumerationParameter::EffectsResistance => self.effects.resistance as i32,
        }
    }

    /// Sets a real parameter, in its SI unit.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the scene is then unchanged.
    pub fn set_real(&mut self, parameter: RealParameter, value: f64) -> Result<(), SceneError> {
        check_range(parameter.variable(), value, bounds_excluded(parameter))?;
        *self.real_mut(parameter) = value;
        Ok(())
    }

    /// Sets an integer parameter.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the scene is then unchanged.
    pub fn set_integer(&mut self, parameter: IntegerParameter, value: i32) -> Result<(), SceneError> {
        check_range(parameter.variable(), f64::from(value), false)?;
        match parameter {
            IntegerParameter::SolverModes => self.solver.modes = value,
            IntegerParameter::ExcitationSeed => self.excitation.seed = value,
        }
        Ok(())
    }

    /// Sets an enumeration parameter by the number of the choice.
    ///
    /// # Errors
    /// [`SceneError::UnknownChoice`] for a number that is none of the choices; the scene is then unchanged.
    pub fn set_enumeration(&mut self, parameter: EnumerationParameter, value: i32) -> Result<(), SceneError> {
        let unknown = || SceneError::UnknownChoice {
            name: parameter.variable().name,
            value: value.to_string(),
            allowed: choices(parameter)
                .iter()
                .map(|(label, number)| format!("{number} ({label})"))
                .collect::<Vec<_>>()
                .join(", "),
        };
        match parameter {
            EnumerationParameter::EffectsExcitation => {
                self.effects.excitation = ExcitationKind::from_value(value).ok_or_else(unknown)?;
            }
            EnumerationParameter::EffectsContactLaw => {
                self.effects.contact_law = ContactLawKind::from_value(value).ok_or_else(unknown)?;
            }
            EnumerationParameter::EffectsAxialForce => {
                self.effects.axial_force = AxialForceKind::from_value(value).ok_or_else(unknown)?;
            }
            EnumerationParameter::EffectsResistance => {
                self.effects.resistance = ResistanceKind::from_value(value).ok_or_else(unknown)?;
            }
        }
        Ok(())
    }

    /// Checks every parameter against its range, for scenes whose fields were written directly, and whether this build has
    /// the effects.
    ///
    /// # Errors
    /// The first [`SceneError`] met.
    pub fn validate(&self) -> Result<(), SceneError> {
        let longest = self.solver.maximum_step;
        if longest > 0.0 && longest < SHORTEST_LIMIT {
            let variable = RealParameter::SolverMaximumStep.variable();
            let allowed = format!("allowed is 0, for no limit, or {SHORTEST_LIMIT} or more");
            return Err(SceneError::out_of_range(variable, longest, allowed));
        }
        let effects = &self.effects;
        let beyond_bare = [
            ("effects.contactDamping", effects.contact_damping),
            ("effects.chatter", effects.chatter),
            ("effects.extremes", effects.extremes),
            ("effects.energy", effects.energy),
            (
                "effects.excitation",
                !matches!(effects.excitation, ExcitationKind::None | ExcitationKind::Sine),
            ),
            (
                "effects.axialForce",
                effects.axial_force == AxialForceKind::FromDeflection,
            ),
        ];
        if BARE && let Some((name, _)) = beyond_bare.into_iter().find(|(_, asked)| *asked) {
            return Err(SceneError::Bare(name));
        }
        let mut copy = *self;
        VARIABLES.iter().try_for_each(|variable| match variable.group {
            Group::RealParameter(parameter) => copy.set_real(parameter, self.real(parameter)),
            Group::IntegerParameter(parameter) => copy.set_integer(parameter, self.integer(parameter)),
            _ => Ok(()),
        })
    }

    fn real_mut(&mut self, parameter: RealParameter) -> &mut f64 {
        use RealParameter as P;
        match parameter {
            P::BeamLength => &mut self.beam.length,
            P::BeamWidth => &mut self.beam.width,
            P::BeamThickness => &mut self.beam.thickness,
            P::BeamYoungsModulus => &mut self.beam.youngs_modulus,
            P::BeamDensity => &mut self.beam.density,
            P::BeamMassDamping => &mut self.beam.mass_damping,
            P::BeamStiffnessDamping => &mut self.beam.stiffness_damping,
            P::BeamAxialForce => &mut self.beam.axial_force,
            P::TipMass => &mut self.tip.mass,
            P::TipRotaryInertia => &mut self.tip.rotary_inertia,
            P::ContactOvertravel => &mut self.contact.overtravel,
            P::ContactCurvatureRadius => &mut self.contact.curvature_radius,
            P::ContactDamping => &mut self.contact.damping,
            P::ContactMeltingVoltage => &mut self.contact.melting_voltage,
            P::ContactMovingYoungsModulus => &mut self.contact.moving.youngs_modulus,
            P::ContactMovingPoissonRatio => &mut self.contact.moving.poisson_ratio,
            P::ContactFixedYoungsModulus => &mut self.contact.fixed.youngs_modulus,
            P::ContactFixedPoissonRatio => &mut self.contact.fixed.poisson_ratio,
            P::ResistanceCoefficient => &mut self.resistance.coefficient,
            P::ResistanceExponent => &mut self.resistance.exponent,
            P::ResistanceFilm => &mut self.resistance.film,
            P::ResistanceOpen => &mut self.resistance.open,
            P::ResistanceResistivity => &mut self.resistance.resistivity,
            P::ResistanceHardness => &mut self.resistance.hardness,
            P::ExcitationAmplitude => &mut self.excitation.amplitude,
            P::ExcitationFrequency => &mut self.excitation.frequency,
            P::ExcitationPhase => &mut self.excitation.phase,
            P::ExcitationStartTime => &mut self.excitation.start_time,
            P::ExcitationEndFrequency => &mut self.excitation.end_frequency,
            P::ExcitationDuration => &mut self.excitation.duration,
            P::ExcitationDisplacementLimit => &mut self.excitation.displacement_limit,
            P::ExcitationSpectralDensity => &mut self.excitation.spectral_density,
            P::EnvironmentGravity => &mut self.environment.gravity,
            P::EnvironmentTemperature => &mut self.environment.temperature,
            P::ChatterResistanceThreshold => &mut self.chatter.resistance_threshold,
            P::ChatterMinimumDuration => &mut self.chatter.minimum_duration,
            P::SolverTolerance => &mut self.solver.tolerance,
            P::SolverMaximumStep => &mut self.solver.maximum_step,
        }
    }
}

/// Names and numbers of the choices of an enumeration parameter.
pub fn choices(parameter: EnumerationParameter) -> &'static [(&'static str, i32)] {
    match parameter {
        EnumerationParameter::EffectsExcitation => ExcitationKind::CHOICES,
        EnumerationParameter::EffectsContactLaw => ContactLawKind::CHOICES,
        EnumerationParameter::EffectsAxialForce => AxialForceKind::CHOICES,
        EnumerationParameter::EffectsResistance => ResistanceKind::CHOICES,
    }
}

/// Smallest limit that can be put on the integration step, s: the steps of a run have to come to an end.
const SHORTEST_LIMIT: f64 = 1e-9;

/// Whether the bounds of the range are themselves refused: at a Poisson's ratio of -1 or 0.5 a material has no finite moduli.
fn bounds_excluded(parameter: RealParameter) -> bool {
    matches!(
        parameter,
        RealParameter::ContactMovingPoissonRatio | RealParameter::ContactFixedPoissonRatio
    )
}

/// Refuses a value that is not a number or outside the range of its variable.
pub(crate) fn check_range(variable: &Variable, value: f64, excluded: bool) -> Result<(), SceneError> {
    let Variable { min, max, .. } = *variable;
    let inside = if excluded {
        min < value && value < max
    } else {
        min <= value && value <= max
    };
    if inside && value.is_finite() {
        return Ok(());
    }
    let allowed = match (min.is_finite(), max.is_finite()) {
        (true, true) if excluded => format!("allowed is more than {min} and less than {max}"),
        (true, true) => format!("allowed is {min} to {max}"),
        _ => "allowed is any finite number".to_owned(),
    };
    Err(SceneError::out_of_range(variable, value, allowed))
}
