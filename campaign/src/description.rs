//! `modelDescription.xml`, read as by an importer.

use std::collections::HashMap;
use std::sync::LazyLock;

use relay_contact::MODEL_DESCRIPTION;
use roxmltree::{Document, Node};

use crate::texts;

/// The type of a variable by the function that reads it: enumerations are integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Real,
    Integer,
    Boolean,
    String,
}

impl Kind {
    pub const ALL: [Self; 4] = [Self::Real, Self::Integer, Self::Boolean, Self::String];
}

/// Who sets the value of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The importer, before every step.
    Input,
    /// The importer, until initialisation ends.
    Parameter,
    /// The component.
    Output,
}

#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub reference: u32,
    pub kind: Kind,
    pub role: Role,
    pub continuous: bool,
    /// Start value; 0 for outputs and the empty text.
    pub start: f64,
    pub min: f64,
    pub max: f64,
    /// Values of an enumeration, numbers of texts.
    pub choices: Vec<f64>,
}

impl Variable {
    /// Whether the value is allowed. The bounds of Poisson's ratio are excluded, as its description states.
    pub fn allows(&self, value: f64) -> bool {
        let open = self.name.ends_with("poissonRatio") && (value == self.min || value == self.max);
        value.is_finite()
            && value >= self.min
            && value <= self.max
            && !open
            && (self.choices.is_empty() || self.choices.contains(&value))
    }
}

/// The description.
#[derive(Clone, Debug)]
pub struct Description {
    pub guid: String,
    /// In the order of the file.
    pub variables: Vec<Variable>,
    /// Their indices by reference.
    positions: HashMap<u32, usize>,
    pub categories: Vec<String>,
}

/// The description of this component.
pub static DESCRIPTION: LazyLock<Description> = LazyLock::new(|| Description::parse(MODEL_DESCRIPTION));

impl Description {
    pub fn parse(xml: &str) -> Self {
        let document = Document::parse(xml).expect("modelDescription.xml is XML");
        let element = |name| document.descendants().find(|node| node.has_tag_name(name));
        let children = |name| element(name).into_iter().flat_map(|node| node.children().filter(Node::is_element));
        let choices = |name: &str| {
            children("TypeDefinitions")
                .filter(|definition| definition.attribute("name") == Some(name))
                .flat_map(|definition| definition.descendants())
                .filter_map(|item| item.attribute("value")?.parse().ok())
                .collect()
        };
        let variables: Vec<_> = children("ModelVariables").map(|node| variable(node, choices)).collect();
        Self {
            guid: document.root_element().attribute("guid").unwrap_or_default().to_owned(),
            positions: variables.iter().enumerate().map(|(at, variable)| (variable.reference, at)).collect(),
            variables,
            categories: children("LogCategories").filter_map(|node| Some(node.attribute("name")?.to_owned())).collect(),
        }
    }

    /// The index of a variable.
    pub fn position(&self, reference: u32) -> Option<usize> {
        self.positions.get(&reference).copied()
    }

    /// The variable of a reference.
    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(self.position(reference)?)
    }

    /// The reference of a name.
    pub fn reference(&self, name: &str) -> u32 {
        let variable = self.variables.iter().find(|variable| variable.name == name);
        variable.unwrap_or_else(|| panic!("modelDescription.xml has no variable {name}")).reference
    }

    /// The references of the outputs of a type.
    pub fn outputs(&self, kind: Kind) -> Vec<u32> {
        self.references(|variable| variable.role == Role::Output && variable.kind == kind)
    }

    /// The references of the selected variables.
    pub fn references(&self, wanted: impl Fn(&Variable) -> bool) -> Vec<u32> {
        let wanted = self.variables.iter().filter(|variable| wanted(variable));
        wanted.map(|variable| variable.reference).collect()
    }
}

fn variable<'a>(node: Node<'a, 'a>, choices: impl Fn(&str) -> Vec<f64>) -> Variable {
    let attribute = |name| node.attribute(name).unwrap_or_default();
    let value = node.first_element_child().expect("a variable has a type");
    let number = |name, default| {
        value
            .attribute(name)
            .map_or(default, |text| text.parse().unwrap_or_else(|_| f64::from(u8::from(text == "true"))))
    };
    let kind = match value.tag_name().name() {
        "Real" => Kind::Real,
        "Boolean" => Kind::Boolean,
        "String" => Kind::String,
        _ => Kind::Integer,
    };
    Variable {
        name: attribute("name").to_owned(),
        reference: attribute("valueReference").parse().expect("a value reference is a number"),
        kind,
        role: match attribute("causality") {
            "input" => Role::Input,
            "parameter" => Role::Parameter,
            _ => Role::Output,
        },
        continuous: attribute("variability") == "continuous",
        start: number("start", 0.0),
        min: number("min", f64::NEG_INFINITY),
        max: number("max", f64::INFINITY),
        choices: match value.tag_name().name() {
            "Enumeration" => choices(value.attribute("declaredType").unwrap_or_default()),
            "String" => texts::ALLOWED.to_vec(),
            _ => Vec::new(),
        },
    }
}
