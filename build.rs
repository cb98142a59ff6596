//! Turns `modelDescription.xml` into Rust: one enum for each group of variables, the table of their
//! properties, the enumeration types, and the GUID. Also writes the plain description, and the C header, with GUID, value
//! references and choices as constants; and computes the polynomials of a step.

#[path = "build/collocation.rs"]
mod collocation;
#[path = "build/description.rs"]
mod description;
#[path = "src/fingerprint.rs"]
mod fingerprint;
#[path = "build/plain.rs"]
mod plain;
#[path = "build/scene.rs"]
mod scene;
#[path = "src/math"]
#[expect(dead_code, reason = "the library uses more of it")]
mod math {
    pub mod legendre;
    pub mod roots;
    pub mod series;
}

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use description::{Variable, attribute};
use heck::{ToShoutySnakeCase, ToUpperCamelCase};
use roxmltree::{Document, Node};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=modelDescription.xml");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=build");
    println!("cargo:rerun-if-changed=src/fingerprint.rs");
    println!("cargo:rerun-if-changed=src/math");
    println!("cargo:rerun-if-changed=src/fmi2");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("collocation.rs"), collocation::all())?;
    let xml = fs::read_to_string("modelDescription.xml")?;
    let guid = identified(&xml, &out.join("modelDescription.xml"))?;
    let plain_guid = identified(&plain::description(&xml)?, &out.join("plain.xml"))?;
    let document = Document::parse(&xml)?;
    let declared = description::variables(&document)?;
    fs::write(out.join("variables.rs"), variables(&document, &declared, &guid, &plain_guid)?)?;
    fs::write(out.join("scene.rs"), scene::scene(&declared)?)?;
    fs::write(out.join("inputs.rs"), scene::inputs(&declared)?)?;
    header(&out, &constants(&document, &declared, &guid)?)
}

/// Writes a description with its GUID, so that any change of the description changes the GUID, and returns that.
fn identified(xml: &str, path: &Path) -> Result<String, Box<dyn Error>> {
    let guid = fingerprint::guid(&[xml.as_bytes()]);
    let described = xml.replacen("guid=\"\"", &format!("guid=\"{guid}\""), 1);
    if described == xml {
        return Err("modelDescription.xml: guid=\"\" not found".into());
    }
    fs::write(path, &described)?;
    Ok(guid)
}

/// The groups of variables; each becomes an enum, so that a `match` over it must handle every variable.
const GROUPS: [(&str, &str); 9] = [
    ("RealInput", "Continuous inputs."),
    ("RealParameter", "Real parameters."),
    ("IntegerParameter", "Integer parameters."),
    ("BooleanParameter", "Boolean parameters."),
    ("EnumerationParameter", "Enumeration parameters."),
    ("StringParameter", "String parameters."),
    ("RealOutput", "Real outputs and calculated parameters."),
    ("IntegerOutput", "Integer outputs and calculated parameters."),
    ("BooleanOutput", "Boolean outputs."),
];

fn variables(
    document: &Document,
    declared: &[Variable],
    guid: &str,
    plain_guid: &str,
) -> Result<String, Box<dyn Error>> {
    let mut code = format!(
        "/// Identifies the variables of this library: a hash of `modelDescription.xml`.\npub const GUID: &str = \"{guid}\";\n\
         /// The same of the plain description.\npub const PLAIN_GUID: &str = \"{plain_guid}\";\n"
    );
    for list in document.descendants().filter(|node| node.has_tag_name("Enumeration")) {
        let definition = list.parent().ok_or("an enumeration without a name")?;
        if definition.has_tag_name("SimpleType") {
            enumeration(&mut code, definition, list)?;
        }
    }
    let mut table = String::new();
    let [mut members, mut arms, mut all] = [(); 3].map(|()| GROUPS.map(|_| String::new()));
    for (index, variable) in declared.iter().enumerate() {
        let Variable { name, kind, unit, value, .. } = *variable;
        let role = match variable.causality {
            "input" => "Input",
            "parameter" => "Parameter",
            _ => "Output",
        };
        let group = format!("{kind}{role}");
        let position = GROUPS.iter().position(|(name, _)| *name == group);
        let position = position.ok_or(format!("{name}: no group {group} in build.rs"))?;
        let variant = name.to_upper_camel_case();
        let doc = scene::doc(variable);
        writeln!(members[position], "    /// {doc}.\n    {variant},")?;
        writeln!(arms[position], "            Self::{variant} => &VARIABLES[{index}],")?;
        write!(all[position], "Self::{variant}, ")?;
        let number = |name: &str, default: &str| match value.attribute(name) {
            Some("true") => "1.0".to_owned(),
            Some("false") => "0.0".to_owned(),
            Some(number) if kind != "String" => format!("{number}_f64"),
            _ => default.to_owned(),
        };
        writeln!(
            table,
            "    Variable {{ name: {name:?}, value_reference: {}, group: Group::{group}({group}::{variant}), unit: {unit:?}, \
             start: {}, min: {}, max: {} }},",
            attribute(variable.element, "valueReference")?,
            number("start", "0.0"),
            number("min", "f64::NEG_INFINITY"),
            number("max", "f64::INFINITY"),
        )?;
    }
    writeln!(
        code,
        "/// Every variable of the component, in the order of `modelDescription.xml`.\n#[allow(clippy::unreadable_literal)]\npub static VARIABLES: [Variable; {}] = [\n{table}];",
        declared.len()
    )?;
    writeln!(code, "{}", by_reference(declared)?)?;
    writeln!(
        code,
        "/// A variable, as a value of the enum of its group.\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\npub enum Group {{"
    )?;
    for (name, doc) in GROUPS {
        writeln!(code, "    /// {doc}\n    {name}({name}),")?;
    }
    writeln!(code, "}}")?;
    for (position, (name, doc)) in GROUPS.iter().enumerate() {
        writeln!(
            code,
            "/// {doc}\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\npub enum {name} {{\n{}}}\n\
             impl {name} {{\n    /// All of them.\n    pub const ALL: &[Self] = &[{}];\n    /// Name, unit, range and start value.\n    \
             pub fn variable(self) -> &'static Variable {{\n        match self {{\n{}        }}\n    }}\n}}",
            members[position], all[position], arms[position]
        )?;
    }
    Ok(code)
}

/// For each value reference up to the largest, the index of its variable in the table; `u16::MAX` for none.
fn by_reference(declared: &[Variable]) -> Result<String, Box<dyn Error>> {
    let mut positions = Vec::new();
    for (index, variable) in declared.iter().enumerate() {
        let reference = usize::from(attribute(variable.element, "valueReference")?.parse::<u16>()?);
        positions.resize(positions.len().max(reference + 1), u16::MAX);
        if positions[reference] != u16::MAX {
            return Err(format!("value reference {reference} is used twice").into());
        }
        positions[reference] = u16::try_from(index)?;
    }
    let count = positions.len();
    Ok(format!("static BY_VALUE_REFERENCE: [u16; {count}] = {positions:?};"))
}

/// An enumeration type of the description as a Rust enum, with its values and names.
fn enumeration(code: &mut String, definition: Node, list: Node) -> Result<(), Box<dyn Error>> {
    let name = attribute(definition, "name")?;
    writeln!(
        code,
        "/// {}.\n#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]\npub enum {name} {{",
        attribute(definition, "description")?
    )?;
    let (mut from, mut table) = (String::new(), String::new());
    for item in list.children().filter(Node::is_element) {
        let (label, value) = (attribute(item, "name")?, attribute(item, "value")?);
        writeln!(code, "    /// {}.\n    {label} = {value},", attribute(item, "description")?)?;
        writeln!(from, "            {value} => Some(Self::{label}),")?;
        write!(table, "({label:?}, {value}), ")?;
    }
    writeln!(
        code,
        "}}\nimpl {name} {{\n    /// Names and values of the choices.\n    pub const CHOICES: &[(&str, i32)] = &[{table}];\n    \
         /// The choice with this value.\n    pub fn from_value(value: i32) -> Option<Self> {{\n        match value {{\n{from}            _ => None,\n        }}\n    }}\n}}"
    )?;
    Ok(())
}

/// For C: the GUID, the value reference of every variable, and the choices of the enumerations.
fn constants(document: &Document, declared: &[Variable], guid: &str) -> Result<String, Box<dyn Error>> {
    let mut code = String::new();
    let mut define = |doc: &str, name: &str, value: &str| {
        let name = name.to_shouty_snake_case();
        writeln!(code, "\n/**\n * {doc}.\n */\n#define RELAY_CONTACT_{name} {value}")
    };
    let doc = "The argument `fmuGUID` of `fmi2Instantiate`: a hash of modelDescription.xml";
    define(doc, "GUID", &format!("\"{guid}\""))?;
    for Variable { name, description, element, kind, unit, .. } in declared {
        let unit = match *unit {
            "" | "1" => String::new(),
            unit => format!(" in {unit}"),
        };
        let doc = format!("`{name}`, {kind}{unit}: {description}");
        define(&doc, name, &format!("{}u", attribute(*element, "valueReference")?))?;
    }
    for item in document.descendants().filter(|node| node.has_tag_name("Item")) {
        let kind = item.ancestors().find(|node| node.has_tag_name("SimpleType"));
        let kind = attribute(kind.ok_or("an item without a type")?, "name")?;
        let name = format!("{kind} {}", attribute(item, "name")?);
        define(attribute(item, "description")?, &name, attribute(item, "value")?)?;
    }
    Ok(code)
}

/// The C header of the exported functions, for C programs that link the library.
fn header(out: &Path, constants: &str) -> Result<(), Box<dyn Error>> {
    let include = out.join("include");
    fs::create_dir_all(&include)?;
    println!("cargo:rustc-env=RELAY_CONTACT_INCLUDE={}", include.display());
    let sources = ["types", "common", "values", "fmu_state", "co_simulation", "course"];
    sources
        .iter()
        .fold(cbindgen::Builder::new(), |builder, source| builder.with_src(format!("src/fmi2/{source}.rs")))
        .with_language(cbindgen::Language::C)
        .with_no_includes()
        .with_sys_include("stddef.h")
        .with_after_include(constants)
        .with_cpp_compat(true)
        .with_include_guard("RELAY_CONTACT_H")
        .with_documentation(true)
        .generate()?
        .write_to_file(include.join("relay_contact.h"));
    Ok(())
}
