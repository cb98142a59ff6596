//! Scenes as parameter sets for tools that read SSP 1.0 (`SystemStructureParameterValues`).

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use commands::root;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use relay_contact::scene::choices;
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::{Group, VARIABLES};

use super as scene;

const NAMESPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// Writes `out/ssv/<name>.ssv` for every scene.
pub fn write() -> Result<()> {
    let folder = root().join("out/ssv");
    fs::create_dir_all(&folder)?;
    for (name, file) in scene::all()? {
        let path = folder.join(format!("{name}.ssv"));
        fs::write(&path, parameter_set(&name, &file)?).with_context(|| format!("cannot write {}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}

/// Every parameter of the scene, and its inputs at the start, by name, in SI units.
fn parameter_set(name: &str, file: &SceneFile) -> Result<Vec<u8>> {
    let inputs = file.inputs_over(0.0, file.communication_step)?;
    let scene = &file.scene;
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element("ssv:ParameterSet")
        .with_attributes([
            ("xmlns:ssv", NAMESPACE),
            ("version", "1.0"),
            ("name", name),
            ("description", &file.title),
        ])
        .write_inner_content(|xml| {
            xml.create_element("ssv:Parameters").write_inner_content(|xml| {
                for variable in &VARIABLES {
                    let (kind, value) = match variable.group {
                        Group::RealInput(input) => ("ssv:Real", inputs.real(input).to_string()),
                        Group::RealParameter(parameter) => ("ssv:Real", scene.real(parameter).to_string()),
                        Group::IntegerParameter(parameter) => ("ssv:Integer", scene.integer(parameter).to_string()),
                        Group::BooleanParameter(parameter) => ("ssv:Boolean", scene.boolean(parameter).to_string()),
                        Group::StringParameter(parameter) => {
                            let text = scene.string(parameter);
                            // A parameter set lies elsewhere than the scene.
                            let path = if text.is_empty() {
                                PathBuf::new()
                            } else {
                                root().join("scenes").join(text)
                            };
                            ("ssv:String", path.display().to_string())
                        }
                        Group::EnumerationParameter(parameter) => {
                            let number = scene.enumeration(parameter);
                            let choice = choices(parameter).iter().find(|(_, known)| *known == number);
                            ("ssv:Enumeration", choice.map_or("", |(label, _)| label).to_owned())
                        }
                        Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => continue,
                    };
                    xml.create_element("ssv:Parameter")
                        .with_attribute(("name", variable.name))
                        .write_inner_content(|xml| {
                            xml.create_element(kind)
                                .with_attribute(("value", value.as_str()))
                                .write_empty()?;
                            Ok(())
                        })?;
                }
                Ok(())
            })?;
            Ok(())
        })?;
    let mut text = xml.into_inner();
    text.push(b'\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_by_type_and_read_back_to_the_last_bit() -> Result<()> {
        let text = "title = \"A < B & \\\"C\\\"\"\nstop = 1\ncommunicationStep = 1e-3\noutputs = []\n[parameters]\n\
                    beam.length = 0.012345678901234567\nresistance.open = 1e15\neffects.excitation = \"Sine\"\n\
                    effects.chatter = false\nexcitation.seed = 7\n[inputs]\ncontact.current = 0.1\n";
        let xml = String::from_utf8(parameter_set("named", &text.parse()?)?)?;
        let document = roxmltree::Document::parse(&xml)?;
        assert_eq!(document.root_element().attribute("description"), Some("A < B & \"C\""));
        let value = |name: &str| {
            let mut parameters = document
                .descendants()
                .filter(|node| node.has_tag_name((NAMESPACE, "Parameter")));
            let value = parameters
                .find(|node| node.attribute("name") == Some(name))?
                .first_element_child()?;
            Some((value.tag_name().name(), value.attribute("value")?))
        };
        let (kind, length) = value("beam.length").context("no length")?;
        assert_eq!((kind, length.parse::<f64>()?), ("Real", 0.012_345_678_901_234_567));
        assert_eq!(value("effects.excitation"), Some(("Enumeration", "Sine")));
        assert_eq!(value("effects.chatter"), Some(("Boolean", "false")));
        assert_eq!(value("excitation.seed"), Some(("Integer", "7")));
        assert_eq!(value("contact.current"), Some(("Real", "0.1")));
        assert_eq!(value("contact.force"), None);
        Ok(())
    }
}
