//! The parameters by variable: reading, setting and range checks.

use std::path::Path;
use std::sync::Arc;

use crate::error::{SceneError, number};
use crate::scene::names::list;
use crate::scene::spring::SpringFile;
use crate::scene::{Scene, choices};
use crate::variables::{
    BooleanParameter, EnumerationParameter, Group, IntegerParameter, RealParameter, StringParameter, VARIABLES,
    Variable,
};

impl Scene {
    /// A choice as messages name it, such as `effects.friction = Coulomb`.
    pub(crate) fn chosen(&self, parameter: EnumerationParameter) -> String {
        let number = self.enumeration(parameter);
        let mut choice = choices(parameter).iter().filter(|(_, value)| *value == number);
        let label = choice.next().map_or("", |(label, _)| label);
        format!("{} = {label}", parameter.variable().name)
    }

    /// Sets a Boolean parameter.
    pub fn set_boolean(&mut self, parameter: BooleanParameter, value: bool) {
        *self.boolean_mut(parameter) = value;
    }

    /// Value of a string parameter: the file as it was named.
    pub fn string(&self, parameter: StringParameter) -> &str {
        let spring = match parameter {
            StringParameter::BeamFile => self.spring.as_ref(),
            StringParameter::FixedFile => self.fixed_spring.as_ref(),
        };
        spring.map_or("", |spring| &spring.name)
    }

    /// Sets a string parameter, and reads the file that it names; a relative name is one in `folder`.
    ///
    /// # Errors
    /// A [`SceneError`] if the file cannot be read or is wrong; the scene is then unchanged.
    pub fn set_string(&mut self, parameter: StringParameter, value: &str, folder: &Path) -> Result<(), SceneError> {
        let read = |name| SpringFile::read(folder, name).map(Arc::new);
        let spring = Some(value).filter(|name| !name.is_empty()).map(read).transpose()?;
        match parameter {
            StringParameter::BeamFile => self.spring = spring,
            StringParameter::FixedFile => self.fixed_spring = spring,
        }
        Ok(())
    }

    /// Sets a real parameter, in its SI unit.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the scene is then unchanged.
    pub fn set_real(&mut self, parameter: RealParameter, value: f64) -> Result<(), SceneError> {
        use RealParameter::{ContactFixedPoissonRatio, ContactMovingPoissonRatio};
        // At a Poisson's ratio of -1 or 0.5 the moduli are not finite.
        let excluded = matches!(parameter, ContactMovingPoissonRatio | ContactFixedPoissonRatio);
        check_range(parameter.variable(), value, excluded)?;
        *self.real_mut(parameter) = value;
        Ok(())
    }

    /// Sets an integer parameter.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the scene is then unchanged.
    pub fn set_integer(&mut self, parameter: IntegerParameter, value: i32) -> Result<(), SceneError> {
        check_range(parameter.variable(), f64::from(value), false)?;
        *self.integer_mut(parameter) = value;
        Ok(())
    }

    /// Sets an enumeration parameter by the number of the choice.
    ///
    /// # Errors
    /// [`SceneError::UnknownChoice`] for a number without a choice; the scene is then unchanged.
    pub fn set_enumeration(&mut self, parameter: EnumerationParameter, value: i32) -> Result<(), SceneError> {
        let choices = choices(parameter);
        let unknown = || SceneError::UnknownChoice {
            name: parameter.variable().name,
            value: value.to_string(),
            allowed: list(choices.iter().map(|(label, number)| format!("{number} ({label})"))),
        };
        self.choose(parameter, value).ok_or_else(unknown)
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
            return Err(SceneError::out_of_range(variable.name, longest, variable.unit, allowed));
        }
        for spring in self.spring.iter().chain(&self.fixed_spring) {
            spring.check()?;
        }
        let mut copy = self.clone();
        VARIABLES.iter().try_for_each(|variable| match variable.group {
            Group::RealParameter(parameter) => copy.set_real(parameter, self.real(parameter)),
            Group::IntegerParameter(parameter) => copy.set_integer(parameter, self.integer(parameter)),
            _ => Ok(()),
        })
    }
}

/// Smallest limit of the integration step, s, so that the number of steps stays finite in practice.
const SHORTEST_LIMIT: f64 = 1e-9;

/// Rejects a value that is not a number or outside the range of its variable.
pub(crate) fn check_range(variable: &Variable, value: f64, excluded: bool) -> Result<(), SceneError> {
    let Variable { min, max, .. } = *variable;
    let on_bound = value == min || value == max;
    if (min..=max).contains(&value) && value.is_finite() && !(excluded && on_bound) {
        return Ok(());
    }
    let (least, greatest) = (number(min), number(max));
    let allowed = match (min.is_finite(), max.is_finite()) {
        (true, true) if excluded => format!("allowed is more than {least} and less than {greatest}"),
        (true, true) => format!("allowed is {least} to {greatest}"),
        _ => "allowed is any finite number".to_owned(),
    };
    Err(SceneError::out_of_range(variable.name, value, variable.unit, allowed))
}
