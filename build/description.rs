//! The variables that `modelDescription.xml` declares: for the build script and the documentation page.

use roxmltree::{Document, Node};

/// A variable.
pub struct Variable<'a> {
    pub name: &'a str,
    pub description: &'a str,
    pub causality: &'a str,
    /// Its element.
    pub element: Node<'a, 'a>,
    /// `Real`, `Integer`, `Boolean`, `Enumeration` or `String`.
    pub kind: &'a str,
    /// The element of that name, with start value and range.
    pub value: Node<'a, 'a>,
    /// Of the type that the value is declared as; empty where there is none.
    pub unit: &'a str,
    /// Number and name of each choice of an enumeration.
    pub choices: Vec<(&'a str, &'a str)>,
}

impl<'a> Variable<'a> {
    fn read(document: &'a Document<'a>, element: Node<'a, 'a>) -> Result<Self, String> {
        let value = element.first_element_child().ok_or("a variable without a type")?;
        let declared = value.attribute("declaredType").and_then(|declared| {
            let mut types = document.descendants().filter(|node| node.has_tag_name("SimpleType"));
            types.find(|node| node.attribute("name") == Some(declared))
        });
        let items = declared.into_iter().flat_map(|declared| declared.descendants());
        Ok(Self {
            name: attribute(element, "name")?,
            description: attribute(element, "description")?,
            causality: attribute(element, "causality")?,
            element,
            kind: value.tag_name().name(),
            value,
            unit: declared.and_then(|declared| declared.first_element_child()?.attribute("unit")).unwrap_or(""),
            choices: items.filter_map(|item| Some((item.attribute("value")?, item.attribute("name")?))).collect(),
        })
    }

    /// The name of the choice with this number, if there is one.
    pub fn choice(&self, number: &str) -> Option<&'a str> {
        self.choices.iter().find(|(known, _)| *known == number).map(|(_, name)| *name)
    }
}

/// All variables, in the order of the file.
pub fn variables<'a>(document: &'a Document<'a>) -> Result<Vec<Variable<'a>>, String> {
    let elements = document.descendants().filter(|node| node.has_tag_name("ScalarVariable"));
    elements.map(|element| Variable::read(document, element)).collect()
}

/// An attribute that has to be there.
pub fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str, String> {
    node.attribute(name).ok_or_else(|| format!("{:?} has no attribute {name}", node.tag_name().name()))
}
