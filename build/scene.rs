//! The parameters of the description as Rust structs, one for each group of names, with the start values and access by variable; and
//! the inputs.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;

use heck::{ToSnakeCase, ToUpperCamelCase};

use crate::description::{Variable, attribute};

/// What the groups of parameters describe.
const GROUPS: [(&str, &str); 15] = [
    ("beam", "Cantilever spring, as an equivalent uniform section."),
    ("tip", "Rivet at the tip."),
    ("contact", "Contact geometry and law."),
    ("second", "Second contact: of the materials of the first."),
    ("parallel", "Contact beside the first: of its materials."),
    ("fixed", "Spring of the fixed contact."),
    ("pusher", "Pusher between clamp and contact."),
    ("armature", "Armature that moves the pusher."),
    ("friction", "Friction between the contacts."),
    ("resistance", "Contact resistance, in series with a film, both in parallel with the open resistance."),
    ("excitation", "Generated base acceleration."),
    ("environment", "Surroundings."),
    ("chatter", "Criterion for interruptions."),
    ("solver", "Accuracy."),
    ("effects", "Effects."),
];

/// Of groups within groups, which are all of this kind.
const INNER: (&str, &str) = ("Material", "Elastic material of a contact.");

/// The parameters that a match over one of the groups of variables has an arm for.
#[derive(Default)]
struct Arms {
    read: String,
    write: String,
}

/// The fields of a struct, and their start values.
#[derive(Default)]
struct Fields {
    code: String,
    starts: String,
}

impl Fields {
    fn add(&mut self, doc: &str, field: &str, kind: &str, start: &str) -> Result<(), Box<dyn Error>> {
        writeln!(self.code, "    /// {doc}.\n    pub {field}: {kind},")?;
        Ok(write!(self.starts, "{field}: {start}, ")?)
    }
}

/// What is said of a variable, with its unit.
pub fn doc(variable: &Variable) -> String {
    let Variable { name, description, .. } = variable;
    let note = match variable.unit {
        "" => String::new(),
        unit => format!(" \\[{unit}\\]"),
    };
    format!("`{name}`: {description}{note}")
}

/// The Rust type of a parameter, and its start value.
fn start(variable: &Variable) -> Result<(String, String), String> {
    let start = attribute(variable.value, "start")?;
    Ok(match variable.kind {
        "Real" => ("f64".to_owned(), format!("{start}_f64")),
        "Integer" => ("i32".to_owned(), start.to_owned()),
        "Boolean" => ("bool".to_owned(), start.to_owned()),
        _ => {
            let kind = attribute(variable.value, "declaredType")?;
            let choice = variable.choice(start).ok_or(format!("{kind} has no choice {start}"))?;
            (kind.to_owned(), format!("{kind}::{choice}"))
        }
    })
}

/// The code of the structs and of the access to their fields.
pub fn scene(declared: &[Variable]) -> Result<String, Box<dyn Error>> {
    let mut groups: BTreeMap<&str, Fields> = BTreeMap::new();
    let mut arms: BTreeMap<&str, Arms> = BTreeMap::new();
    let mut choices = String::new();
    let parameters = declared.iter().filter(|variable| variable.causality == "parameter" && variable.kind != "String");
    for variable in parameters {
        let Variable { name, kind, .. } = *variable;
        let (rust, start) = start(variable)?;
        let (group, field) = name.rsplit_once('.').ok_or(format!("{name} is in no group"))?;
        let field = field.to_snake_case();
        groups.entry(group).or_default().add(&doc(variable), &field, &rust, &start)?;
        let path = format!("{group}.{field}");
        let variant = name.to_upper_camel_case();
        let Arms { read, write } = arms.entry(kind).or_default();
        if kind == "Enumeration" {
            writeln!(read, "            EnumerationParameter::{variant} => self.{path} as i32,")?;
            writeln!(
                write,
                "            EnumerationParameter::{variant} => self.{path} = {rust}::from_value(value)?,"
            )?;
            writeln!(choices, "        EnumerationParameter::{variant} => {rust}::CHOICES,")?;
        } else {
            writeln!(read, "            {kind}Parameter::{variant} => self.{path},")?;
            writeln!(write, "            {kind}Parameter::{variant} => &mut self.{path},")?;
        }
    }
    let mut code = structs(groups)?;
    access(&mut code, &arms)?;
    writeln!(
        code,
        "/// Names and numbers of the choices of an enumeration parameter.\npub fn choices(parameter: EnumerationParameter) -> \
         &'static [(&'static str, i32)] {{\n    match parameter {{\n{choices}    }}\n}}"
    )?;
    Ok(code)
}

/// The structs with their start values.
fn structs(mut groups: BTreeMap<&str, Fields>) -> Result<String, Box<dyn Error>> {
    const DERIVE: &str = "#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]\n";
    let (kind, doc) = INNER;
    let (mut code, mut fields, mut all) = (String::new(), String::new(), String::new());
    let mut inner = None;
    for (group, doc) in GROUPS {
        let mut own = groups.remove(group).ok_or(format!("no parameters {group}"))?;
        let prefix = format!("{group}.");
        let (inside, others): (BTreeMap<_, _>, _) = groups.into_iter().partition(|(name, _)| name.starts_with(&prefix));
        groups = others;
        for (name, fields) in inside {
            let start = format!("{kind} {{ {} }}", fields.starts);
            own.add(&format!("`{name}`"), name.trim_start_matches(&prefix), kind, &start)?;
            inner.get_or_insert(fields.code);
        }
        let name = group.to_upper_camel_case();
        writeln!(code, "/// {doc}\n{DERIVE}pub struct {name} {{\n{}}}", own.code)?;
        writeln!(fields, "    /// {doc}\n    pub {group}: {name},")?;
        writeln!(all, "            {group}: {name} {{ {}}},", own.starts)?;
    }
    if let Some(group) = groups.keys().next() {
        return Err(format!("build/scene.rs says nothing of the parameters {group}").into());
    }
    let inner = inner.ok_or(format!("no group is a {kind}"))?;
    writeln!(code, "/// {doc}\n{DERIVE}pub struct {kind} {{\n{inner}}}")?;
    writeln!(
        code,
        "/// Parameters and effects of a simulation. SI units.\n#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]\n\
         pub struct Scene {{\n{fields}    /// The spring of `beam.file`, in place of the length, width and thickness of the beam.\n    \
         pub spring: Option<Arc<SpringFile>>,\n    /// The spring of `fixed.file`, which carries the fixed contact; rigid without one.\n    \
         pub fixed_spring: Option<Arc<SpringFile>>,\n}}\n\
         impl Default for Scene {{\n    /// The start values of `modelDescription.xml`.\n    fn default() -> Self {{\n        Self {{\n{all}            \
         spring: None,\n            fixed_spring: None,\n        }}\n    }}\n}}"
    )?;
    Ok(code)
}

/// Reading and writing by variable.
fn access(code: &mut String, arms: &BTreeMap<&str, Arms>) -> Result<(), Box<dyn Error>> {
    writeln!(code, "impl Scene {{")?;
    for (kind, rust, name) in [("Real", "f64", "real"), ("Integer", "i32", "integer"), ("Boolean", "bool", "boolean")] {
        let Arms { read, write } = arms.get(kind).ok_or(format!("no {kind} parameters"))?;
        writeln!(
            code,
            "    /// Value of a parameter, in its SI unit.\n    pub fn {name}(&self, parameter: {kind}Parameter) -> {rust} {{\n        match \
             parameter {{\n{read}        }}\n    }}\n    pub(crate) fn {name}_mut(&mut self, parameter: {kind}Parameter) -> &mut {rust} {{\n        \
             match parameter {{\n{write}        }}\n    }}"
        )?;
    }
    let Arms { read, write } = arms.get("Enumeration").ok_or("no enumeration parameters")?;
    writeln!(
        code,
        "    /// Number of the choice of a parameter.\n    pub fn enumeration(&self, parameter: EnumerationParameter) -> i32 {{\n        \
         match parameter {{\n{read}        }}\n    }}\n    /// Sets a choice by its number; `None` if there is no such choice.\n    \
         pub(crate) fn choose(&mut self, parameter: EnumerationParameter, value: i32) -> Option<()> {{\n        match parameter {{\n{write}        \
         }}\n        Some(())\n    }}\n}}"
    )?;
    Ok(())
}

/// The code of the inputs: their values and rates, with the start values, and access to both by variable.
pub fn inputs(declared: &[Variable]) -> Result<String, Box<dyn Error>> {
    let (mut values, mut rates, mut arms) = (Fields::default(), Fields::default(), String::new());
    for variable in declared.iter().filter(|variable| variable.causality == "input") {
        let Variable { name, unit, .. } = *variable;
        let (field, variant) = (name.to_snake_case(), name.to_upper_camel_case());
        let (_, start) = start(variable)?;
        values.add(&doc(variable), &field, "f64", &start)?;
        let of = format!("Rate of `{name}` \\[{unit} per s\\]");
        rates.add(&of, &format!("{field}_rate"), "f64", "0.0")?;
        writeln!(arms, "            RealInput::{variant} => (&mut self.{field}, &mut self.{field}_rate),")?;
    }
    Ok(format!(
        "/// Values of the inputs and their rates. SI units. With rates of 0 the inputs are held, and displacements lag one step\n\
         /// behind.\n#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]\npub struct Inputs {{\n{}{}}}\n\
         impl Default for Inputs {{\n    /// The start values of `modelDescription.xml`.\n    fn default() -> Self {{\n        \
         Self {{ {}{}}}\n    }}\n}}\nimpl Inputs {{\n    /// An input and its rate.\n    fn course_mut(&mut self, input: \
         RealInput) -> (&mut f64, &mut f64) {{\n        match input {{\n{arms}        }}\n    }}\n}}\n",
        values.code, rates.code, values.starts, rates.starts
    ))
}
