//! What `modelDescription.xml` says of the type of a variable's value: for the build script and the documentation page.

use roxmltree::{Document, Node};

/// The definition of the type a value is declared as.
pub fn declared<'a, 'input>(document: &'a Document<'input>, value: Node) -> Option<Node<'a, 'input>> {
    let declared = value.attribute("declaredType")?;
    document.descendants().find(|node| node.has_tag_name("SimpleType") && node.attribute("name") == Some(declared))
}

/// The unit of a value, by the type it is declared as; empty where there is none.
pub fn unit<'a>(document: &'a Document, value: Node) -> &'a str {
    declared(document, value)
        .and_then(|definition| definition.first_element_child())
        .and_then(|real| real.attribute("unit"))
        .unwrap_or("")
}
