//! The description with all numbers as Reals, choices and Booleans too: for tools that cannot set enumerations, or read
//! and set everything as Real. The value references and the library stay the same.

use std::error::Error;

use roxmltree::Document;

use crate::description::variables;

/// The plain description. What the numbers stand for moves to the descriptions of the variables.
pub fn description(xml: &str) -> Result<String, Box<dyn Error>> {
    let document = Document::parse(xml)?;
    let mut text = xml.to_owned();
    // From the end, so that positions further up remain valid.
    for variable in variables(&document)?.into_iter().rev() {
        let numbers = match variable.kind {
            "Real" | "String" => continue,
            "Boolean" => vec![("0", "false"), ("1", "true")],
            _ => variable.choices,
        };
        let value = variable.value;
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
            let described = variable.element.attribute_node("description").ok_or("no description")?;
            let numbers = numbers.iter().map(|(number, name)| format!("{number} {name}"));
            let numbers = numbers.collect::<Vec<_>>().join(", ");
            text.insert_str(described.range_value().end, &format!(": {numbers}"));
        }
    }
    let types: Vec<_> = document.descendants().filter(|node| node.has_tag_name("SimpleType")).collect();
    for definition in types.into_iter().rev() {
        if definition.first_element_child().is_some_and(|value| value.has_tag_name("Enumeration")) {
            text.replace_range(definition.range(), "");
        }
    }
    Ok(text.replacen("modelName=\"RelayContact\"", "modelName=\"RelayContact-plain\"", 1))
}
