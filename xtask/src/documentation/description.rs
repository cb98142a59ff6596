//! What `modelDescription.xml` says of a variable.

use roxmltree::{Document, Node};

/// What the declared type of a variable's value says.
fn declared<'a>(document: &'a Document, value: Node) -> Option<Node<'a, 'a>> {
    let name = value.attribute("declaredType")?;
    let mut types = document.descendants().filter(|node| node.has_tag_name("SimpleType"));
    types
        .find(|node| node.attribute("name") == Some(name))?
        .first_element_child()
}

pub fn unit<'a>(document: &'a Document, value: Node) -> &'a str {
    declared(document, value).map_or("", |declared| attribute(declared, "unit"))
}

/// The start value; of an enumeration, the choice's name.
pub fn start<'a>(document: &'a Document, value: Node<'a, 'a>) -> &'a str {
    let start = attribute(value, "start");
    let items = declared(document, value)
        .into_iter()
        .flat_map(|declared| declared.children());
    let mut items = items.filter(|item| item.has_tag_name("Item"));
    items
        .find(|item| attribute(*item, "value") == start)
        .map_or(start, |item| attribute(item, "name"))
}

/// An attribute, or nothing.
pub fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or("")
}
