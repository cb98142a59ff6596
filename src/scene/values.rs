//! The parameters by variable: reading, setting and range checks.

use std::path::Path;
use std::sync::Arc;

use crate::error::{SceneError, number};
use crate::scene::Scene;
use crate::scene::spring::SpringFile;
use crate::variables::{
    AxialForceKind, BooleanParameter, ContactLawKind, EnumerationParameter, ExcitationKind, FrictionKind, Group,
    IntegerParameter, RealParameter, ResistanceKind, StringParameter, VARIABLES, Variable,
};

impl Scene {
    /// Whether the contact rubs.
    pub(crate) fn rubs(&self) -> bool {
        self.effects.friction != FrictionKind::None
    }

    /// Value of a real parameter, in its SI unit.
    pub fn real(&self, parameter: RealParameter) -> f64 {
        let mut scene = self.clone();
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
        let mut scene = self.clone();
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
            P::EffectsSecondContact => &mut self.effects.second_contact,
        }
    }

    /// Value of an enumeration parameter.
    pub fn enumeration(&self, parameter: EnumerationParameter) -> i32 {
        match parameter {
            EnumerationParameter::EffectsExcitation => self.effects.excitation as i32,
            EnumerationParameter::EffectsContactLaw => self.effects.contact_law as i32,
            EnumerationParameter::EffectsAxialForce => self.effects.axial_force as i32,
            EnumerationParameter::EffectsResistance => self.effects.resistance as i32,
            EnumerationParameter::EffectsFriction => self.effects.friction as i32,
        }
    }

    /// Value of a string parameter: the file as it was named.
    pub fn string(&self, parameter: StringParameter) -> &str {
        match parameter {
            StringParameter::BeamFile => self.spring.as_ref().map_or("", |spring| &spring.name),
        }
    }

    /// Sets a string parameter, and reads the file that it names; a relative name is one in `folder`.
    ///
    /// # Errors
    /// A [`SceneError`] if the file cannot be read or is wrong; the scene is then unchanged.
    pub fn set_string(&mut self, parameter: StringParameter, value: &str, folder: &Path) -> Result<(), SceneError> {
        match parameter {
            StringParameter::BeamFile => {
                let read = |name| SpringFile::read(folder, name).map(Arc::new);
                self.spring = Some(value).filter(|name| !name.is_empty()).map(read).transpose()?;
            }
        }
        Ok(())
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
    /// [`SceneError::UnknownChoice`] for a number without a choice; the scene is then unchanged.
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
            EnumerationParameter::EffectsFriction => {
                self.effects.friction = FrictionKind::from_value(value).ok_or_else(unknown)?;
            }
        }
        Ok(())
    }

    /// Checks every parameter against its range, for scenes whose fields were written directly.
    ///
    /// # Errors
    /// The first [`SceneError`] met.
    pub fn validate(&self) -> Result<(), SceneError> {
        let longest = self.solver.maximum_step;
        if longest > 0.0 && longest < SHORTEST_LIMIT {
            let variable = RealParameter::SolverMaximumStep.variable();
            let allowed = format!("allowed is 0 (no limit), or {} or more", number(SHORTEST_LIMIT));
            return Err(SceneError::out_of_range(variable, longest, allowed));
        }
        if let Some(spring) = &self.spring {
            spring.check()?;
        }
        let mut copy = self.clone();
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
            P::TipContactHeight => &mut self.tip.contact_height,
            P::ContactOvertravel => &mut self.contact.overtravel,
            P::ContactCurvatureRadius => &mut self.contact.curvature_radius,
            P::ContactStiffness => &mut self.contact.stiffness,
            P::ContactStiffnessForce => &mut self.contact.stiffness_force,
            P::ContactStiffnessExponent => &mut self.contact.stiffness_exponent,
            P::ContactDamping => &mut self.contact.damping,
            P::ContactMeltingVoltage => &mut self.contact.melting_voltage,
            P::ContactOpenVoltage => &mut self.contact.open_voltage,
            P::ContactMovingYoungsModulus => &mut self.contact.moving.youngs_modulus,
            P::ContactMovingPoissonRatio => &mut self.contact.moving.poisson_ratio,
            P::ContactFixedYoungsModulus => &mut self.contact.fixed.youngs_modulus,
            P::ContactFixedPoissonRatio => &mut self.contact.fixed.poisson_ratio,
            P::SecondGap => &mut self.second.gap,
            P::SecondCurvatureRadius => &mut self.second.curvature_radius,
            P::SecondStiffness => &mut self.second.stiffness,
            P::SecondDamping => &mut self.second.damping,
            P::SecondMinimumDuration => &mut self.second.minimum_duration,
            P::FrictionCoefficient => &mut self.friction.coefficient,
            P::FrictionInitial => &mut self.friction.initial,
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
        EnumerationParameter::EffectsFriction => FrictionKind::CHOICES,
    }
}

/// Smallest limit of the integration step, s, so that the number of steps stays finite in practice.
const SHORTEST_LIMIT: f64 = 1e-9;

/// Whether the bounds of the range are excluded: at a Poisson's ratio of -1 or 0.5 the moduli are not finite.
fn bounds_excluded(parameter: RealParameter) -> bool {
    matches!(
        parameter,
        RealParameter::ContactMovingPoissonRatio | RealParameter::ContactFixedPoissonRatio
    )
}

/// Rejects a value that is not a number or outside the range of its variable.
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
    let (least, greatest) = (number(min), number(max));
    let allowed = match (min.is_finite(), max.is_finite()) {
        (true, true) if excluded => format!("allowed is more than {least} and less than {greatest}"),
        (true, true) => format!("allowed is {least} to {greatest}"),
        _ => "allowed is any finite number".to_owned(),
    };
    Err(SceneError::out_of_range(variable, value, allowed))
}
