//! Scenes as parameter sets for tools that read SSP 1.0 (`SystemStructureParameterValues`).

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use commands::root;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use relay_contact::inputs::Inputs;
use relay_contact::scene::file::SceneFile;
use relay_contact::scene::{Scene, choices};
use relay_contact::variables::{Group, VARIABLES, Variable};

use super as scene;

const NAMESPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// Writes `out/ssv/<name>.ssv` for every scene, and `<name>-plain.ssv` for the plain component, in which all numbers are
/// Reals.
pub fn write() -> Result<()> {
    let folder = root().join("out/ssv");
    fs::create_dir_all(&folder)?;
    for (name, file) in scene::all()? {
        for (end, plain) in [("", false), ("-plain", true)] {
            let path = folder.join(format!("{name}{end}.ssv"));
            let set = parameter_set(&name, &file, plain)?;
            fs::write(&path, set).with_context(|| format!("cannot write {}", path.display()))?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

/// What differs from the start values, by name, in SI units: parameters of the scene, and its inputs at the start.
fn parameter_set(name: &str, file: &SceneFile, plain: bool) -> Result<Vec<u8>> {
    let inputs = file.inputs_over(0.0, file.communication_step)?;
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
                    let Some((kind, value)) = changed(variable, &file.scene, &inputs, plain) else {
                        continue;
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

/// The type and the value of a parameter or an input that differs from its start value.
fn changed(variable: &Variable, scene: &Scene, inputs: &Inputs, plain: bool) -> Option<(&'static str, String)> {
    let (kind, number) = match variable.group {
        Group::RealInput(input) => ("ssv:Real", inputs.real(input)),
        Group::RealParameter(parameter) => ("ssv:Real", scene.real(parameter)),
        Group::IntegerParameter(parameter) => ("ssv:Integer", scene.integer(parameter).into()),
        Group::BooleanParameter(parameter) => ("ssv:Boolean", u8::from(scene.boolean(parameter)).into()),
        Group::EnumerationParameter(parameter) => ("ssv:Enumeration", scene.enumeration(parameter).into()),
        Group::StringParameter(parameter) => {
            // In the resources of the component, where one that carries it has it.
            let file = Path::new(scene.string(parameter)).file_name()?;
            return Some(("ssv:String", file.to_string_lossy().into_owned()));
        }
        Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => return None,
    };
    if number == variable.start {
        return None;
    }
    Some(match variable.group {
        _ if plain => ("ssv:Real", number.to_string()),
        Group::BooleanParameter(_) => (kind, (number != 0.0).to_string()),
        Group::EnumerationParameter(parameter) => {
            let mut choices = choices(parameter).iter();
            let (label, _) = choices.find(|(_, known)| f64::from(*known) == number)?;
            (kind, (*label).to_owned())
        }
        _ => (kind, number.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    const SCENE: &str = "title = \"A < B & \\\"C\\\"\"\nstop = 1\ncommunicationStep = 1e-3\noutputs = []\n[parameters]\n\
                         beam.length = 0.012345678901234567\nresistance.open = 1e15\neffects.excitation = \"Sine\"\n\
                         effects.chatter = false\nexcitation.seed = 7\ntip.mass = 2.26e-5\n[inputs]\ncontact.current = 0.1\n";

    /// Types and values by name.
    type Values = BTreeMap<String, (String, String)>;

    /// Description and values of a parameter set.
    fn read(file: &SceneFile, plain: bool) -> Result<(String, Values)> {
        let xml = String::from_utf8(parameter_set("named", file, plain)?)?;
        let document = roxmltree::Document::parse(&xml)?;
        let description = document.root_element().attribute("description").unwrap_or_default();
        let parameters = document
            .descendants()
            .filter(|node| node.has_tag_name((NAMESPACE, "Parameter")));
        let parameters = parameters.map(|node| {
            let value = node.first_element_child()?;
            let typed = (value.tag_name().name().to_owned(), value.attribute("value")?.to_owned());
            Some((node.attribute("name")?.to_owned(), typed))
        });
        let parameters = parameters
            .collect::<Option<_>>()
            .context("a parameter lacks something")?;
        Ok((description.to_owned(), parameters))
    }

    #[test]
    fn what_differs_from_start_values_is_written_by_type_and_read_back_to_the_last_bit() -> Result<()> {
        let file: SceneFile = SCENE.parse()?;
        for (plain, choice, chatter, seed) in [
            (false, ("Enumeration", "Sine"), ("Boolean", "false"), ("Integer", "7")),
            (true, ("Real", "2"), ("Real", "0"), ("Real", "7")),
        ] {
            let (description, mut parameters) = read(&file, plain)?;
            assert_eq!(description, "A < B & \"C\"");
            let (kind, length) = parameters.remove("beam.length").context("no length")?;
            assert_eq!(
                (kind.as_str(), length.parse::<f64>()?),
                ("Real", 0.012_345_678_901_234_567)
            );
            let expected = [
                ("contact.current", ("Real", "0.1")),
                ("effects.chatter", chatter),
                ("effects.excitation", choice),
                ("excitation.seed", seed),
                ("resistance.open", ("Real", "1000000000000000")),
            ];
            let parameters = parameters
                .iter()
                .map(|(name, (kind, value))| (name.as_str(), (kind.as_str(), value.as_str())));
            assert_eq!(parameters.collect::<Vec<_>>(), expected);
        }
        Ok(())
    }

    #[test]
    fn a_spring_file_is_one_in_the_resources_of_the_component_and_an_empty_name_is_left_out() -> Result<()> {
        let (_, parameters) = read(&scene::read("tapered-spring")?, false)?;
        let file = ("String".to_owned(), "tapered-cube.toml".to_owned());
        assert_eq!(parameters.get("beam.file"), Some(&file));
        assert_eq!(read(&scene::read("at-rest")?, true)?.1.get("beam.file"), None);
        Ok(())
    }
}
