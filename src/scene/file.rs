//! Scene files in TOML: parameters, inputs, length of the run and outputs to record.
//!
//! ```toml
//! title = "Contact at rest, 0.3 mm overtravel"
//! stop = 0.001                # s
//! communicationStep = 1e-5    # s
//! outputs = ["contact.force", "contact.resistance"]
//!
//! [parameters]                # by variable name, in SI units; all others keep their start values
//! contact.overtravel = 3e-4
//! beam.file = "my-spring.toml"    # beside this file
//! effects.excitation = "None"
//!
//! [inputs]                    # held during the whole run; all others are 0
//! contact.current = 0.1
//! file = "closing.csv"        # further inputs over time, in the same folder: see `input_table`
//! ```

use crate::scene::names::{Role, list, located, variable};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::{fmt, fs};

use serde::de::{self, Deserialize, Deserializer, MapAccess, Unexpected, Visitor};
use toml::Spanned;
use toml::de::ValueDeserializer;

use crate::error::SceneError;
use crate::inputs::Inputs;
use crate::scene::input_table::InputTable;
use crate::scene::{Scene, choices};
use crate::variables::{Group, Variable};

/// A scene file, read and checked: all names exist, all values are in range.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// What the scene shows.
    pub title: String,
    /// End of the run, s; it begins at 0.
    pub stop: f64,
    /// Length of a communication step, s.
    pub communication_step: f64,
    /// The outputs to record.
    pub outputs: Vec<&'static Variable>,
    /// Parameters and effects.
    pub scene: Scene,
    /// Inputs held during the whole run.
    pub inputs: Inputs,
    /// Inputs over time.
    pub table: InputTable,
    /// The folder of relative paths.
    folder: PathBuf,
}

/// The file as parsed; names and values of variables are checked afterwards.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Document {
    #[serde(default)]
    title: String,
    stop: Option<Spanned<Value>>,
    communication_step: Option<Spanned<Value>>,
    outputs: Option<Vec<Spanned<String>>>,
    #[serde(default)]
    parameters: Table,
    #[serde(default)]
    inputs: Table,
}

/// Keys with their position in the file, from which errors get their line.
type Table = BTreeMap<Spanned<String>, Value>;

enum Value {
    Integer(i64),
    Real(f64),
    Boolean(bool),
    Text(String),
    Table(Table),
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValueVisitor;
        impl<'de> Visitor<'de> for ValueVisitor {
            type Value = Value;

            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a number, true or false, a string or a table")
            }

            fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
                Ok(Value::Integer(value))
            }

            fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
                Ok(Value::Real(value))
            }

            fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
                Ok(Value::Boolean(value))
            }

            fn visit_str<E>(self, value: &str) -> Result<Value, E> {
                Ok(Value::Text(value.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
                let mut table = Table::new();
                // A date is also a map, the only one whose key has no position.
                let no_place = |_| de::Error::invalid_type(Unexpected::Other("date or time"), &self);
                while let Some(key) = map.next_key().map_err(no_place)? {
                    table.insert(key, map.next_value()?);
                }
                Ok(Value::Table(table))
            }
        }
        deserializer.deserialize_any(ValueVisitor)
    }
}

impl FromStr for SceneFile {
    type Err = SceneError;

    /// Parses the text of a scene file; the path of an input table is relative to the current folder.
    ///
    /// # Errors
    /// The first [`SceneError`] found, with its line, except for a missing key.
    fn from_str(text: &str) -> Result<Self, SceneError> {
        Self::parse(text, Path::new(""))
    }
}

impl SceneFile {
    /// Reads a scene file, and the input table it names, whose path is relative to it.
    ///
    /// # Errors
    /// The first [`SceneError`] found, with its file and line; a missing key has no line.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let file = || path.display().to_string();
        let text = fs::read_to_string(path).map_err(|error| SceneError::Unreadable {
            file: file(),
            cause: error.to_string(),
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|error| SceneError::InFile {
            file: file(),
            error: Box::new(error),
        })
    }

    fn parse(text: &str, folder: &Path) -> Result<Self, SceneError> {
        let mut document: Document = toml::from_str(text).map_err(|error| {
            let place = error.span().unwrap_or_default();
            located(text, &place, SceneError::Syntax(error.message().to_owned()))
        })?;
        let missing = |name, allowed| SceneError::MissingKey { name, allowed };
        let seconds = |name, value: Option<Spanned<Value>>| {
            let value = value.ok_or(missing(name, "a positive number of seconds"))?;
            at_line(text, &value, positive(name, value.get_ref()))
        };
        let output = |name: &Spanned<String>| at_line(text, name, variable(Role::Output, name.get_ref()));
        let outputs = document.outputs.ok_or(missing("outputs", "a list of output names"))?;
        let table = document.inputs.iter().find(|(key, _)| key.get_ref() == "file");
        let table = table.map(|(key, value)| at_line(text, key, input_table(folder, value)));
        let mut file = Self {
            title: document.title,
            stop: seconds("stop", document.stop)?,
            communication_step: seconds("communicationStep", document.communication_step)?,
            outputs: outputs.iter().map(output).collect::<Result<_, _>>()?,
            scene: Scene::default(),
            inputs: Inputs::default(),
            table: table.transpose()?.unwrap_or_default(),
            folder: folder.to_owned(),
        };
        document.inputs.retain(|key, _| key.get_ref() != "file");
        file.apply(Role::Parameter, text, "", &document.parameters)?;
        file.apply(Role::Input, text, "", &document.inputs)?;
        Ok(file)
    }

    /// The communication steps of the run: start time and length, s; the last ends with the run.
    pub fn steps(&self) -> impl Iterator<Item = (f64, f64)> {
        // A remainder due to rounding is not a step.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a positive count, saturating"
        )]
        let count = (self.stop / self.communication_step - 1e-9).ceil().max(1.0) as u64;
        let point = |n: u64| (n as f64 * self.communication_step).min(self.stop);
        (0..count).map(move |n| (point(n), point(n + 1) - point(n)))
    }

    /// The inputs over the communication step from `time` of length `size` (s): held, or with the rates that take them
    /// to their values at its end.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] if a rate is not finite.
    pub fn inputs_over(&self, time: f64, size: f64) -> Result<Inputs, SceneError> {
        let mut inputs = self.inputs;
        self.table.set(&mut inputs, time, size)?;
        Ok(inputs)
    }

    /// Sets `stop`, `communicationStep`, `outputs` (names separated by commas), a parameter or an input by name, from
    /// text such as `0.0155` or `Sine`; a relative file is one beside the scene. An input is then held, even if the table
    /// has a column for it.
    ///
    /// # Errors
    /// A [`SceneError`] for an unknown name or a value that is not allowed; nothing is changed then.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), SceneError> {
        if name == "outputs" {
            let outputs = value.split(',').map(|name| variable(Role::Output, name.trim()));
            self.outputs = outputs.collect::<Result<_, _>>()?;
            return Ok(());
        }
        let parsed = ValueDeserializer::parse(value).and_then(Value::deserialize);
        let value = parsed.unwrap_or_else(|_| Value::Text(value.to_owned()));
        match name {
            "stop" => self.stop = positive("stop", &value)?,
            "communicationStep" => self.communication_step = positive("communicationStep", &value)?,
            _ => self.set_variable(Role::Settable, name, &value)?,
        }
        Ok(())
    }

    /// Sets every variable of a table, nested tables as dotted names.
    fn apply(&mut self, role: Role, text: &str, prefix: &str, table: &Table) -> Result<(), SceneError> {
        table.iter().try_for_each(|(key, value)| {
            let name = format!("{prefix}{key}");
            match value {
                Value::Table(table) => self.apply(role, text, &format!("{name}."), table),
                value => at_line(text, key, self.set_variable(role, &name, value)),
            }
        })
    }

    fn set_variable(&mut self, role: Role, name: &str, value: &Value) -> Result<(), SceneError> {
        let variable = variable(role, name)?;
        match variable.group {
            Group::RealParameter(parameter) => self.scene.set_real(parameter, number(name, value)?),
            Group::RealInput(input) => {
                if matches!(role, Role::Input) && self.table.drives(input) {
                    return Err(SceneError::GivenTwice {
                        name: name.to_owned(),
                        allowed: "either a value here or a column of the file",
                    });
                }
                self.inputs.set_real(input, number(name, value)?)?;
                self.table.release(input);
                Ok(())
            }
            Group::IntegerParameter(parameter) => {
                let number = match value {
                    Value::Integer(value) => i32::try_from(*value).ok(),
                    _ => None,
                };
                let number = number.ok_or_else(|| wrong_type(name, value, "a whole number"))?;
                self.scene.set_integer(parameter, number)
            }
            Group::BooleanParameter(parameter) => {
                let Value::Boolean(value) = value else {
                    return Err(wrong_type(name, value, "true or false"));
                };
                self.scene.set_boolean(parameter, *value);
                Ok(())
            }
            Group::StringParameter(parameter) => {
                let Value::Text(text) = value else {
                    return Err(wrong_type(name, value, "a string"));
                };
                self.scene.set_string(parameter, text, &self.folder)
            }
            Group::EnumerationParameter(parameter) => {
                let Value::Text(choice) = value else {
                    return Err(wrong_type(name, value, "the name of a choice, as a string"));
                };
                let choices = choices(parameter);
                let known = choices.iter().find(|(label, _)| label == choice);
                let (_, number) = known.ok_or_else(|| SceneError::UnknownChoice {
                    name: variable.name,
                    value: choice.clone(),
                    allowed: list(choices.iter().map(|(label, _)| *label)),
                })?;
                self.scene.set_enumeration(parameter, *number)
            }
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => Ok(()),
        }
    }
}

/// The input table named by the key `file`.
fn input_table(folder: &Path, value: &Value) -> Result<InputTable, SceneError> {
    match value {
        Value::Text(name) => InputTable::read(&folder.join(name)),
        _ => Err(wrong_type("file", value, "the path of an input table, as a string")),
    }
}

fn number(name: &str, value: &Value) -> Result<f64, SceneError> {
    match value {
        Value::Integer(value) => Ok(*value as f64),
        Value::Real(value) => Ok(*value),
        Value::Boolean(_) | Value::Text(_) | Value::Table(_) => Err(wrong_type(name, value, "a number")),
    }
}

fn positive(name: &'static str, value: &Value) -> Result<f64, SceneError> {
    let value = number(name, value)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SceneError::OutOfRange {
            name,
            value,
            unit: "s",
            allowed: "allowed is any positive finite number".into(),
        })
    }
}

fn wrong_type(name: &str, value: &Value, allowed: &'static str) -> SceneError {
    let value = match value {
        Value::Integer(value) => value.to_string(),
        Value::Real(value) => format!("{value:?}"),
        Value::Boolean(value) => value.to_string(),
        Value::Text(value) => format!("{value:?}"),
        Value::Table(_) => "{...}".to_owned(),
    };
    SceneError::WrongType {
        name: name.to_owned(),
        value,
        allowed,
    }
}

/// Adds the line of a position to an error.
fn at_line<T, U>(text: &str, place: &Spanned<U>, result: Result<T, SceneError>) -> Result<T, SceneError> {
    result.map_err(|error| located(text, &place.span(), error))
}
