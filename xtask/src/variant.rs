//! Variants of the component: all have the same library, and each its own description, by whose GUID importers and the
//! library tell them apart.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use relay_contact::scene::spring::SpringFile;
use relay_contact::variables::{GUID, PLAIN_GUID, guid_carrying};
use relay_contact::{MODEL_DESCRIPTION, PLAIN_MODEL_DESCRIPTION};

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
            let declaration = declaration("beam.file", description)?;
            variant.name = format!("{name}-{}", file.trim_end_matches(".toml"));
            for (given, carrying) in [
                (format!("modelName=\"{name}\""), format!("modelName=\"{}\"", variant.name)),
                (guid.to_owned(), guid_carrying(guid, &file, &text)),
                (
                    declaration.to_owned(),
                    declaration.replace("<String start=\"\"/>", &format!("<String start=\"{file}\"/>")),
                ),
            ] {
                ensure!(variant.description.matches(&given).count() == 1, "not once in the description: {given}");
                variant.description = variant.description.replace(&given, &carrying);
            }
            variant.spring = Some((file, text));
        }
        Ok(variant)
    }
}

/// The declaration of a variable in a description.
fn declaration<'a>(name: &str, description: &'a str) -> Result<&'a str> {
    let mut declarations = description.split_inclusive("</ScalarVariable>");
    let found = declarations.find(|declaration| declaration.contains(&format!("name=\"{name}\"")));
    let found = found.with_context(|| format!("{name}: not declared"))?;
    Ok(found.split_once("<ScalarVariable ").map_or(found, |(_, own)| own))
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
    use roxmltree::Document;

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
