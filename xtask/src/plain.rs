//! The description with its choices as integers, for tools that cannot set enumerations. The value references, the GUID
//! and the library stay the same: FMI 2.0 sets an enumeration with `fmi2SetInteger` too.

use anyhow::{Context, Result, bail};
use relay_contact::MODEL_DESCRIPTION;
use roxmltree::{Document, Node};

/// The names and numbers of the choices move to the descriptions of the variables.
pub fn description() -> Result<String> {
    let document = Document::parse(MODEL_DESCRIPTION)?;
    let lists: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("Enumeration"))
        .collect();
    let mut text = MODEL_DESCRIPTION.to_owned();
    // From the end, so that positions further up remain valid.
    for list in lists.iter().rev() {
        let parent = list.parent().context("an enumeration without a parent")?;
        let Some(name) = list.attribute("declaredType") else {
            text.replace_range(parent.range(), "");
            continue;
        };
        let start = list.attribute("start").unwrap_or("1");
        let items: Vec<_> = lists
            .iter()
            .filter(|other| other.parent_element().and_then(|kind| kind.attribute("name")) == Some(name))
            .flat_map(|kind| kind.children().filter(Node::is_element))
            .filter_map(|item| Some((item.attribute("value")?, item.attribute("name")?)))
            .collect();
        let (Some((first, _)), Some((last, _)), Some(described)) =
            (items.first(), items.last(), parent.attribute_node("description"))
        else {
            bail!("{name} has no choices, or a variable of it no description");
        };
        let choices: Vec<_> = items.iter().map(|(value, name)| format!("{value} {name}")).collect();
        text.replace_range(
            list.range(),
            &format!("<Integer start=\"{start}\" min=\"{first}\" max=\"{last}\"/>"),
        );
        text.insert_str(described.range_value().end, &format!(": {}", choices.join(", ")));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use relay_contact::variables::VARIABLES;

    use super::*;

    #[test]
    fn choices_become_integers_and_nothing_else_changes() -> Result<()> {
        let text = description()?;
        assert!(!text.contains("Enumeration") && !text.contains("Kind"));
        let (given, plain) = (Document::parse(MODEL_DESCRIPTION)?, Document::parse(&text)?);
        let guid = |document: &Document| document.root_element().attribute("guid").map(str::to_owned);
        assert_eq!(guid(&plain), guid(&given));
        let variables = |document: &Document| -> Vec<String> {
            let nodes = document
                .descendants()
                .filter(|node| node.has_tag_name("ScalarVariable"));
            nodes
                .filter_map(|node| Some(node.attribute("name")?.to_owned() + node.attribute("valueReference")?))
                .collect()
        };
        assert_eq!(variables(&plain), variables(&given));
        assert_eq!(variables(&plain).len(), VARIABLES.len());
        assert!(text.contains("added to base.acceleration: 1 None, 2 Sine, 3 LogSweep"));
        assert!(text.contains(r#"<Integer start="1" min="1" max="5"/>"#));
        Ok(())
    }
}
