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

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use toml::Spanned;
use toml::de::DeValue;

use crate::error::SceneError;
use crate::inputs::Inputs;
use crate::scene::document::{Entry, Value, of_file, parsed};
use crate::scene::input_table::InputTable;
use crate::scene::names::{Role, list, variable};
use crate::scene::{Scene, choices};
use crate::variables::{Group, Variable};

/// The key of the input table among the inputs.
const FILE: &str = "file";

const OUTPUTS: &str = "a list of output names";

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
        let folder = path.parent().unwrap_or(Path::new(""));
        of_file(path, fs::read_to_string(path), |text| Self::parse(text, folder))
    }

    fn parse(text: &str, folder: &Path) -> Result<Self, SceneError> {
        let document = parsed(text)?;
        let top = Entry::whole(text, &document);
        top.knows(&["title", "stop", "communicationStep", "outputs", "parameters", "inputs"])?;
        let missing = |name, allowed| SceneError::MissingKey { name, allowed };
        let seconds = |name| {
            let seconds = top.get(name, |value| positive(name, value))?;
            seconds.ok_or(missing(name, "a positive number of seconds"))
        };
        let table = |name| top.get(name, |value| value.table(name, "a table"));
        let (parameters, inputs) = (table("parameters")?, table("inputs")?);
        let title = top.get("title", |value| value.string("title", "a string"))?;
        let outputs = top.value("outputs").ok_or(missing("outputs", OUTPUTS))?;
        let outputs = outputs.at(outputs.list("outputs", OUTPUTS))?.map(|output| {
            let name = output.string("outputs", OUTPUTS);
            output.at(name.and_then(|name| variable(Role::Output, name)))
        });
        let driving = inputs.as_ref().map(|inputs| {
            inputs.get(FILE, |value| {
                let name = value.string(FILE, "the path of an input table, as a string")?;
                InputTable::read(&folder.join(name))
            })
        });
        let mut file = Self {
            title: title.unwrap_or_default().to_owned(),
            stop: seconds("stop")?,
            communication_step: seconds("communicationStep")?,
            outputs: outputs.collect::<Result<_, _>>()?,
            scene: Scene::default(),
            inputs: Inputs::default(),
            table: driving.transpose()?.flatten().unwrap_or_default(),
            folder: folder.to_owned(),
        };
        file.table.check_overlap(file.stop)?;
        for (role, table) in [(Role::Parameter, parameters), (Role::Input, inputs)] {
            table.map_or(Ok(()), |table| file.apply(role, "", &table, &mut HashSet::new()))?;
        }
        Ok(file)
    }

    /// The communication steps of the run: start time and length, s; the last ends with the run.
    pub fn steps(&self) -> impl Iterator<Item = (f64, f64)> {
        // A remainder due to rounding is not a step.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive count, saturating")]
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

    /// The inputs over the first communication step, with which a run starts.
    ///
    /// # Errors
    /// As [`Self::inputs_over`].
    pub fn first_inputs(&self) -> Result<Inputs, SceneError> {
        self.inputs_over(0.0, self.communication_step.min(self.stop))
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
        let parsed = DeValue::parse(value);
        let node = parsed.unwrap_or_else(|_| Spanned::new(0..value.len(), DeValue::String(value.into())));
        let value = Value { text: value, node: &node };
        match name {
            "stop" => self.stop = positive("stop", value)?,
            "communicationStep" => self.communication_step = positive("communicationStep", value)?,
            _ => self.set_variable(Role::Settable, name, value)?,
        }
        Ok(())
    }

    /// Sets every variable of a table, nested tables as dotted names; `seen` has those that were set.
    fn apply(&mut self, role: Role, prefix: &str, table: &Entry, seen: &mut HashSet<String>) -> Result<(), SceneError> {
        let mut named = table.values().map(|(key, value)| (format!("{prefix}{key}"), value));
        named.try_for_each(|(name, value)| match value.table(&name, "a table") {
            Ok(table) => self.apply(role, &format!("{name}."), &table, seen),
            Err(_) if role == Role::Input && name == FILE => Ok(()),
            // TOML tells a name with dots from the same in quotes.
            Err(_) if seen.contains(&name) => value.at(Err(SceneError::GivenTwice { name, allowed: "one value" })),
            Err(_) => {
                value.at(self.set_variable(role, &name, value))?;
                seen.insert(name);
                Ok(())
            }
        })
    }

    fn set_variable(&mut self, role: Role, name: &str, value: Value) -> Result<(), SceneError> {
        let variable = variable(role, name)?;
        let number = match variable.group {
            Group::RealParameter(_) => value.number(name)?,
            Group::RealInput(input) => {
                if role == Role::Input && self.table.drives(input) {
                    return Err(SceneError::GivenTwice {
                        name: name.to_owned(),
                        allowed: "either a value here or a column of the file",
                    });
                }
                self.inputs.set_real(input, value.number(name)?)?;
                self.table.release(input);
                return Ok(());
            }
            Group::IntegerParameter(_) => value.whole(name)?.into(),
            Group::BooleanParameter(_) => u8::from(value.boolean(name)?).into(),
            Group::StringParameter(parameter) => {
                let file = value.string(name, "a string")?;
                return self.scene.set_string(parameter, file, &self.folder);
            }
            Group::EnumerationParameter(parameter) => {
                let choice = value.string(name, "the name of a choice, as a string")?;
                let choices = choices(parameter);
                let known = choices.iter().find(|(label, _)| *label == choice);
                let (_, number) = known.ok_or_else(|| SceneError::UnknownChoice {
                    name: variable.name,
                    value: choice.to_owned(),
                    allowed: list(choices.iter().map(|(label, _)| *label)),
                })?;
                f64::from(*number)
            }
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => return Ok(()),
        };
        self.scene.set_number(variable, number)
    }
}

fn positive(name: &'static str, value: Value) -> Result<f64, SceneError> {
    let value = value.number(name)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SceneError::out_of_range(name, value, "s", "any positive finite number"))
    }
}
