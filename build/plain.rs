//! The description with all numbers as Reals, choices and Booleans too: for tools that cannot set enumerations, or read
//! and set everything as Real. The value references and the library stay the same.

use std::error::Error;

use roxmltree::{Document, Node};

use crate::description::declared;

/// The plain description. What the numbers stand for moves to the descriptions of the variables.
pub fn description(xml: &str) -> Result<String, Box<dyn Error>> {
    let document = Document::parse(xml)?;
    let discrete = |node: &Node| ["Enumeration", "Integer", "Boolean"].contains(&node.tag_name().name());
    let mut text = xml.to_owned();
    let values: Vec<_> = document.descendants().filter(discrete).collect();
    // From the end, so that positions further up remain valid.
    for value in values.iter().rev() {
        let parent = value.parent().ok_or("a value without a parent")?;
        if parent.has_tag_name("SimpleType") {
            text.replace_range(parent.range(), "");
            continue;
        }
        let numbers = numbers(&document, value);
        let real = match (value.attribute("start"), numbers.first(), numbers.last()) {
            (None, ..) => "<Real/>".to_owned(),
            (Some(start), Some((least, _)), Some((most, _))) => {
                let start = match start {
                    "true" => "1",
                    "false" => "0",
                    choice => choice,
                };
                format!("<Real start=\"{start}\" min=\"{least}\" max=\"{most}\"/>")
            }
            _ => xml[value.range()].replacen("Integer", "Real", 1),
        };
        text.replace_range(value.range(), &real);
        if !numbers.is_empty() {
            let described = parent.attribute_node("description").ok_or("no description")?;
            let numbers = numbers.iter().map(|(number, name)| format!("{number} {name}"));
            let numbers = numbers.collect::<Vec<_>>().join(", ");
            text.insert_str(described.range_value().end, &format!(": {numbers}"));
        }
    }
    Ok(text.replacen("modelName=\"RelayContact\"", "modelName=\"RelayContact-plain\"", 1))
}

/// What the numbers of a value stand for: none for an Integer.
fn numbers<'a>(document: &'a Document, value: &Node) -> Vec<(&'a str, &'a str)> {
    if value.has_tag_name("Boolean") {
        return vec![("0", "false"), ("1", "true")];
    }
    let items = declared(document, *value).into_iter().flat_map(|definition| definition.descendants());
    let numbers = items.filter_map(|item| Some((item.attribute("value")?, item.attribute("name")?)));
    numbers.collect()
}
