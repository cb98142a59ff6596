//! Variants of the component: all have the same library, and each its own description, by whose GUID importers and the
//! library tell them apart.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use relay_contact::scene::spring::SpringFile;
use relay_contact::variables::{GUID, PLAIN_GUID, guid_carrying};
use relay_contact::{MODEL_DESCRIPTION, PLAIN_MODEL_DESCRIPTION};
use roxmltree::Document;

/// What is packed beside the library.
pub struct Variant {
    /// `RelayContact`, with `-plain` if all numbers are Reals, and with the name of the spring carried.
    pub name: String,
    /// `modelDescription.xml`.
    pub description: String,
    /// Name and text of the spring file carried.
    pub spring: Option<(String, String)>,
}

impl Variant {
    /// The variant whose numbers are all Reals if `plain`, and that carries a spring file, which is then the start value of
    /// `beam.file`.
    pub fn new(plain: bool, spring: Option<&Path>) -> Result<Self> {
        let (name, description, guid) = if plain {
            ("RelayContact-plain", PLAIN_MODEL_DESCRIPTION, PLAIN_GUID)
        } else {
            ("RelayContact", MODEL_DESCRIPTION, GUID)
        };
        let mut variant = Self { name: name.to_owned(), description: description.to_owned(), spring: None };
        if let Some(path) = spring {
            let (file, text) = read(path)?;
            variant.name = format!("{name}-{}", file.trim_end_matches(".toml"));
            let document = Document::parse(description)?;
            let model = document.root_element();
            let variable = model.descendants().find(|node| node.attribute("name") == Some("beam.file"));
            let value = variable.and_then(|variable| variable.first_element_child()).unwrap_or(model);
            // From the end, so that places further up remain valid.
            for (element, attribute, carrying) in [
                (value, "start", &file),
                (model, "guid", &guid_carrying(guid, &file, &text)),
                (model, "modelName", &variant.name),
            ] {
                let given = element.attribute_node(attribute).with_context(|| format!("no {attribute}"))?;
                variant.description.replace_range(given.range_value(), carrying);
            }
            variant.spring = Some((file, text));
        }
        Ok(variant)
    }
}

/// Name and text of a spring file, checked.
fn read(path: &Path) -> Result<(String, String)> {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let ordinary = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    ensure!(
        !name.is_empty() && name.chars().all(ordinary),
        "{}: allowed in the name are letters of ASCII, digits and -_.",
        path.display()
    );
    SpringFile::read(Path::new(""), &path.to_string_lossy())?;
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    Ok((name.to_owned(), text))
}

#[cfg(test)]
mod tests {
    use crate::commands::root;

    use super::*;

    #[test]
    fn a_spring_is_the_start_value_of_beam_file_and_part_of_name_and_guid() -> Result<()> {
        for (plain, own) in [(false, GUID), (true, PLAIN_GUID)] {
            let path = root().join("scenes/springs/tapered-cube.toml");
            let variant = Variant::new(plain, Some(&path))?;
            let text = std::fs::read_to_string(path)?;
            let guid = guid_carrying(own, "tapered-cube.toml", &text);
            assert!(variant.name.ends_with("-tapered-cube") && guid != own);
            let model = format!("modelName=\"{}\" guid=\"{guid}\"", variant.name);
            assert_eq!(variant.description.matches(&model).count(), 1, "{model}");
            let document = Document::parse(&variant.description)?;
            let mut carrying =
                document.descendants().filter(|node| node.attribute("start") == Some("tapered-cube.toml"));
            let declared = carrying.next().and_then(|value| value.parent()?.attribute("name"));
            assert_eq!((declared, carrying.next()), (Some("beam.file"), None));
        }
        for wrong in ["a&b.toml", "none.toml", "\u{e4}.toml"] {
            assert!(Variant::new(false, Some(Path::new(wrong))).is_err(), "{wrong}");
        }
        Ok(())
    }
}
