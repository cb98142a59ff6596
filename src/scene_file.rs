//! Scene files: a scene, its constant inputs, how long to run it and what to look at, in TOML.
//!
//! ```toml
//! title = "Contact at rest, 0.3 mm overtravel"
//! stop = 0.001                # s
//! communicationStep = 1e-5    # s
//! outputs = ["contact.force", "contact.resistance"]
//!
//! [parameters]                # by variable name, in SI units; what is not named keeps its start value
//! contact.overtravel = 3e-4
//! effects.excitation = "None"
//!
//! [inputs]                    # held during the whole run; what is not named is 0
//! contact.current = 0.1
//! ```

use std::str::FromStr;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::error::SceneError;
use crate::inputs::Inputs;
use crate::scene::{Scene, choices};
use crate::variables::{Group, VARIABLES, Variable};

/// A scene file as read and checked: every name known, every value inside its range.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// What the scene shows.
    pub title: String,
    /// End of the run, s; it begins at 0.
    pub stop: f64,
    /// Length of a communication step, s.
    pub communication_step: f64,
    /// The outputs to look at.
    pub outputs: Vec<&'static Variable>,
    /// Parameters and effects.
    pub scene: Scene,
    /// Inputs, held during the whole run.
    pub inputs: Inputs,
}

const KEYS: [&str; 6] = ["title", "stop", "communicationStep", "outputs", "parameters", "inputs"];

impl FromStr for SceneFile {
    type Err = SceneError;

    /// Reads a scene file.
    ///
    /// # Errors
    /// The first [`SceneError`] met, as [`SceneError::AtLine`] wherever it has a line.
    fn from_str(text: &str) -> Result<Self, SceneError> {
        let table = DeTable::parse(text).map_err(|error| SceneError::Syntax(error.to_string()))?;
        let table = table.get_ref();
        let mut file = Self {
            title: String::new(),
            stop: f64::NAN,
            communication_step: f64::NAN,
            outputs: Vec::new(),
            scene: Scene::default(),
            inputs: Inputs::default(),
        };
        for (key, value) in table {
            let at_line = |error| at_line(text, key.span().start, error);
            match key.get_ref().as_ref() {
                "title" => {
                    let DeValue::String(title) = value.get_ref() else {
                        return Err(at_line(wrong_type("title", value.get_ref(), "a text")));
                    };
                    file.title = title.to_string();
                }
                "stop" => file.stop = positive("stop", value.get_ref()).map_err(at_line)?,
                "communicationStep" => {
                    file.communication_step = positive("communicationStep", value.get_ref()).map_err(at_line)?;
                }
                "outputs" => file.outputs = outputs(value.get_ref()).map_err(at_line)?,
                "parameters" => file.apply(Role::Parameter, text, "parameters", "", key.span().start, value)?,
                "inputs" => file.apply(Role::Input, text, "inputs", "", key.span().start, value)?,
                unknown => return Err(at_line(unknown_name(unknown, "key of a scene file", KEYS.into_iter()))),
            }
        }
        for (name, allowed) in [
            ("stop", "a positive number of seconds"),
            ("communicationStep", "a positive number of seconds"),
            ("outputs", "a list of output names"),
        ] {
            if !table.contains_key(name) {
                return Err(SceneError::MissingKey { name, allowed });
            }
        }
        Ok(file)
    }
}

impl SceneFile {
    /// Sets `stop`, `communicationStep`, a parameter or an input by name, from text such as `0.0155` or `Sine`.
    ///
    /// # Errors
    /// A [`SceneError`] for a name that does not exist or a value it cannot take; nothing is changed then.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), SceneError> {
        let line = format!("value = {value}");
        let parsed = DeTable::parse(&line)
            .ok()
            .and_then(|table| table.into_inner().remove("value"))
            .map_or_else(|| DeValue::String(value.into()), Spanned::into_inner);
        match name {
            "stop" => self.stop = positive("stop", &parsed)?,
            "communicationStep" => self.communication_step = positive("communicationStep", &parsed)?,
            _ => self.set_variable(Role::Settable, name, &parsed)?,
        }
        Ok(())
    }

    /// Sets every variable of a table, nested tables as dotted names.
    fn apply(
        &mut self,
        role: Role,
        text: &str,
        key: &str,
        prefix: &str,
        start: usize,
        value: &Spanned<DeValue>,
    ) -> Result<(), SceneError> {
        match value.get_ref() {
            DeValue::Table(table) => table.iter().try_for_each(|(key, value)| {
                let name = if prefix.is_empty() {
                    key.get_ref().to_string()
                } else {
                    format!("{prefix}.{}", key.get_ref())
                };
                self.apply(role, text, &name, &name, key.span().start, value)
            }),
            value if prefix.is_empty() => Err(at_line(text, start, wrong_type(key, value, "a table"))),
            value => self
                .set_variable(role, prefix, value)
                .map_err(|error| at_line(text, start, error)),
        }
    }

    fn set_variable(&mut self, role: Role, name: &str, value: &DeValue) -> Result<(), SceneError> {
        let names = || VARIABLES.iter().filter(|variable| role.covers(variable));
        let Some(variable) = names().find(|variable| variable.name == name) else {
            let names = names().map(|variable| variable.name);
            return Err(unknown_name(name, role.noun(), names));
        };
        match variable.group {
            Group::RealParameter(parameter) => self.scene.set_real(parameter, number(name, value)?),
            Group::RealInput(input) => self.inputs.set_real(input, number(name, value)?),
            Group::IntegerParameter(parameter) => {
                let allowed = "a whole number";
                let number = integer(value).ok_or_else(|| wrong_type(name, value, allowed))?;
                self.scene.set_integer(parameter, number)
            }
            Group::EnumerationParameter(parameter) => {
                let DeValue::String(choice) = value else {
                    return Err(wrong_type(name, value, "the name of a choice, as a text"));
                };
                let choices = choices(parameter);
                let number = choices
                    .iter()
                    .find(|(label, _)| label == choice)
                    .map(|(_, number)| *number);
                let number = number.ok_or_else(|| SceneError::UnknownChoice {
                    name: variable.name,
                    value: choice.to_string(),
                    allowed: list(choices.iter().map(|(label, _)| *label)),
                })?;
                self.scene.set_enumeration(parameter, number)
            }
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => Ok(()),
        }
    }
}

/// What a name may stand for at a place of the file.
#[derive(Clone, Copy)]
enum Role {
    Parameter,
    Input,
    Settable,
    Output,
}

impl Role {
    fn covers(self, variable: &Variable) -> bool {
        let role = match variable.group {
            Group::RealInput(_) => return matches!(self, Self::Input | Self::Settable),
            Group::RealParameter(_) | Group::IntegerParameter(_) | Group::EnumerationParameter(_) => {
                return matches!(self, Self::Parameter | Self::Settable);
            }
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => self,
        };
        matches!(role, Self::Output)
    }

    fn noun(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Input => "input",
            Self::Settable => "parameter or input",
            Self::Output => "output",
        }
    }
}

fn outputs(value: &DeValue) -> Result<Vec<&'static Variable>, SceneError> {
    let allowed = "a list of output names";
    let DeValue::Array(array) = value else {
        return Err(wrong_type("outputs", value, allowed));
    };
    let array: &DeArray = array;
    array
        .iter()
        .map(|item| {
            let DeValue::String(name) = item.get_ref() else {
                return Err(wrong_type("outputs", item.get_ref(), allowed));
            };
            let outputs = || VARIABLES.iter().filter(|variable| Role::Output.covers(variable));
            outputs()
                .find(|variable| variable.name == name)
                .ok_or_else(|| unknown_name(name, Role::Output.noun(), outputs().map(|variable| variable.name)))
        })
        .collect()
}

fn number(name: &str, value: &DeValue) -> Result<f64, SceneError> {
    let number = match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => integer(value).map(f64::from),
    };
    number.ok_or_else(|| wrong_type(name, value, "a number"))
}

fn integer(value: &DeValue) -> Option<i32> {
    let DeValue::Integer(integer) = value else {
        return None;
    };
    i32::from_str_radix(integer.as_str(), integer.radix()).ok()
}

fn positive(name: &'static str, value: &DeValue) -> Result<f64, SceneError> {
    let value = number(name, value)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        let allowed = "allowed is a positive number of seconds";
        Err(SceneError::KeyOutOfRange { name, value, allowed })
    }
}

fn wrong_type(name: &str, value: &DeValue, allowed: &'static str) -> SceneError {
    let value = match value {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(integer) => integer.to_string(),
        DeValue::Float(float) => float.to_string(),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(datetime) => datetime.to_string(),
        DeValue::Array(_) => "[...]".to_owned(),
        DeValue::Table(_) => "{...}".to_owned(),
    };
    SceneError::WrongType {
        name: name.to_owned(),
        value,
        allowed,
    }
}

/// The error for a name that is none of `names`, with the three that come nearest to it.
fn unknown_name(name: &str, what: &'static str, names: impl Iterator<Item = &'static str>) -> SceneError {
    // A user may have left out the group, so the last word counts as much as the whole.
    let likeness = |known: &str| {
        let word = known.rsplit('.').next().unwrap_or(known);
        strsim::jaro_winkler(name, known).max(strsim::jaro_winkler(name, word))
    };
    let mut names: Vec<_> = names.collect();
    names.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
    SceneError::UnknownName {
        name: name.to_owned(),
        what,
        nearest: list(names.into_iter().take(3)),
    }
}

fn list(names: impl Iterator<Item = &'static str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

fn at_line(text: &str, position: usize, error: SceneError) -> SceneError {
    let line = 1 + text.bytes().take(position).filter(|byte| *byte == b'\n').count();
    SceneError::AtLine {
        line,
        error: Box::new(error),
    }
}
