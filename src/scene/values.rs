//! The parameters by variable: reading, setting and range checks.

use std::path::Path;
use std::sync::Arc;

use crate::error::{SceneError, number};
use crate::scene::names::list;
use crate::scene::spring::SpringFile;
use crate::scene::{Scene, choices};
use crate::variables::{EnumerationParameter, Group, RealParameter, StringParameter, VARIABLES, Variable};

impl Scene {
    /// A choice as messages name it, such as `effects.friction = Coulomb`.
    pub(crate) fn chosen(&self, parameter: EnumerationParameter) -> String {
        let number = self.enumeration(parameter);
        let mut choice = choices(parameter).iter().filter(|(_, value)| *value == number);
        let label = choice.next().map_or("", |(label, _)| label);
        format!("{} = {label}", parameter.variable().name)
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

    /// A parameter as a number, in its SI unit: a choice by its number, true as 1; `None` for a file or another variable.
    pub fn number(&self, variable: &Variable) -> Option<f64> {
        match variable.group {
            Group::RealParameter(parameter) => Some(self.real(parameter)),
            Group::IntegerParameter(parameter) => Some(self.integer(parameter).into()),
            Group::EnumerationParameter(parameter) => Some(self.enumeration(parameter).into()),
            Group::BooleanParameter(parameter) => Some(u8::from(self.boolean(parameter)).into()),
            _ => None,
        }
    }

    /// Sets a parameter that is a number, as [`Self::number`] has it.
    ///
    /// # Errors
    /// A [`SceneError`] if the variable does not allow it; the scene is then unchanged.
    pub fn set_number(&mut self, variable: &Variable, value: f64) -> Result<(), SceneError> {
        match variable.group {
            Group::RealParameter(parameter) => {
                check_range(variable, value)?;
                *self.real_mut(parameter) = value;
            }
            Group::IntegerParameter(parameter) => {
                let whole = whole(variable, value)?;
                check_range(variable, value)?;
                *self.integer_mut(parameter) = whole;
            }
            Group::EnumerationParameter(parameter) => {
                let choice = whole(variable, value)?;
                self.choose(parameter, choice).ok_or_else(|| SceneError::UnknownChoice {
                    name: variable.name,
                    value: choice.to_string(),
                    allowed: list(choices(parameter).iter().map(|(label, number)| format!("{number} ({label})"))),
                })?;
            }
            Group::BooleanParameter(parameter) if value == 0.0 || value == 1.0 => {
                *self.boolean_mut(parameter) = value == 1.0;
            }
            Group::BooleanParameter(_) => return Err(refused(variable, value, "0 or 1")),
            _ => return Err(refused(variable, value, "no number")),
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
            let allowed = format!("0 (no limit), or {} or more", number(SHORTEST_LIMIT));
            return Err(refused(RealParameter::SolverMaximumStep.variable(), longest, &allowed));
        }
        for spring in self.spring.iter().chain(&self.fixed_spring) {
            spring.check()?;
        }
        let mut copy = self.clone();
        let mut numbers = VARIABLES.iter().filter_map(|variable| Some((variable, self.number(variable)?)));
        numbers.try_for_each(|(variable, number)| copy.set_number(variable, number))
    }
}

/// Smallest limit of the integration step, s, so that the number of steps stays finite in practice.
const SHORTEST_LIMIT: f64 = 1e-9;

/// Rejects a value that is not a number or outside the range of its variable.
pub(crate) fn check_range(variable: &Variable, value: f64) -> Result<(), SceneError> {
    use RealParameter::{ContactFixedPoissonRatio, ContactMovingPoissonRatio};
    let Variable { min, max, .. } = *variable;
    // At a Poisson's ratio of -1 or 0.5 the moduli are not finite.
    let poisson = [ContactMovingPoissonRatio, ContactFixedPoissonRatio].map(Group::RealParameter);
    let excluded = poisson.contains(&variable.group);
    let on_bound = value == min || value == max;
    if (min..=max).contains(&value) && value.is_finite() && !(excluded && on_bound) {
        return Ok(());
    }
    let (least, greatest) = (number(min), number(max));
    let allowed = match (min.is_finite(), max.is_finite()) {
        (true, true) if excluded => format!("more than {least} and less than {greatest}"),
        (true, true) => format!("{least} to {greatest}"),
        _ => "any finite number".to_owned(),
    };
    Err(refused(variable, value, &allowed))
}

/// The integer that a number is.
#[expect(clippy::cast_possible_truncation, reason = "what is lost is refused")]
fn whole(variable: &Variable, value: f64) -> Result<i32, SceneError> {
    let whole = value as i32;
    if f64::from(whole) == value { Ok(whole) } else { Err(refused(variable, value, "a whole number")) }
}

/// A value that its variable does not allow, with what it does.
pub(crate) fn refused(variable: &Variable, value: f64, allowed: &str) -> SceneError {
    SceneError::out_of_range(variable.name, value, variable.unit, allowed)
}
