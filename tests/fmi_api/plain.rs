//! The plain variant, in which all numbers are Reals.

use relay_contact::fmi2::*;
use relay_contact::variables::{Group, PLAIN_GUID, VARIABLES};
use relay_contact::{MODEL_DESCRIPTION, PLAIN_MODEL_DESCRIPTION};
use roxmltree::{Document, Node};
use testing::instance::{Arguments, Instance};

fn plain() -> Instance {
    Instance::with(&Arguments { guid: Some(PLAIN_GUID), ..Arguments::default() })
}

/// Variables of a description, each with its value.
fn variables<'a>(document: &'a Document) -> Vec<(Node<'a, 'a>, Node<'a, 'a>)> {
    let nodes = document.descendants();
    nodes
        .filter(|node| node.has_tag_name("ScalarVariable"))
        .map(|node| (node, node.first_element_child().unwrap()))
        .collect()
}

#[test]
fn its_description_has_reals_and_strings_alone_and_says_what_numbers_stand_for() {
    let [given, plain] = [MODEL_DESCRIPTION, PLAIN_MODEL_DESCRIPTION].map(|text| Document::parse(text).unwrap());
    assert_eq!(plain.root_element().attribute("guid"), Some(PLAIN_GUID));
    assert_ne!(given.root_element().attribute("guid"), Some(PLAIN_GUID));
    assert!(!PLAIN_MODEL_DESCRIPTION.contains("Kind"), "a type is left");
    let (given, plain) = (variables(&given), variables(&plain));
    assert_eq!(given.len(), plain.len());
    for ((before, typed), (after, value)) in given.into_iter().zip(plain) {
        for name in ["name", "valueReference", "causality", "variability", "initial"] {
            assert_eq!(before.attribute(name), after.attribute(name));
        }
        let kind = if typed.has_tag_name("String") { "String" } else { "Real" };
        assert_eq!(value.tag_name().name(), kind, "{after:?}");
        let number = |text: &str| text.parse().unwrap_or(f64::from(u8::from(text == "true")));
        assert_eq!(typed.attribute("start").map(number), value.attribute("start").map(number));
        assert_eq!(typed.has_attribute("start"), value.has_attribute("start"));
    }
    for part in [
        "added to base.acceleration: 1 None, 2 Sine, 3 LogSweep",
        r#"<Real start="1" min="1" max="5"/>"#,
        ": 0 false, 1 true\">",
        r#"<Real start="1" min="0" max="1"/>"#,
        "modelName=\"RelayContact-plain\"",
    ] {
        assert!(PLAIN_MODEL_DESCRIPTION.contains(part), "{part}");
    }
}

#[test]
fn every_number_is_set_and_read_as_real() {
    let (typed, plain) = (Instance::new(), plain());
    assert_eq!(typed.set_integer("effects.excitation", 2), fmi2OK);
    assert_eq!(typed.set_integer("solver.modes", 5), fmi2OK);
    assert_eq!(typed.set_boolean("effects.energy", true), fmi2OK);
    assert_eq!(typed.set_real("excitation.amplitude", 500.0), fmi2OK);
    let names = ["effects.excitation", "solver.modes", "effects.energy", "excitation.amplitude"];
    assert_eq!(plain.set_reals(names, [2.0, 5.0, 1.0, 500.0]), fmi2OK);
    let mut closed = Vec::new();
    for fmu in [&typed, &plain] {
        fmu.initialize();
    }
    for n in 0..100 {
        for fmu in [&typed, &plain] {
            assert_eq!(fmu.step(f64::from(n) * 1e-5, 1e-5), fmi2OK);
        }
        closed.push(plain.real("contact.closed"));
        assert_eq!(plain.real("contact.closed") == 1.0, typed.real("contact.force") > 0.0);
    }
    assert!(closed.contains(&0.0) && closed.contains(&1.0), "it opens and closes");
    for variable in &VARIABLES {
        let name = variable.name;
        match variable.group {
            Group::StringParameter(_) => assert_eq!(plain.try_real(name).0, fmi2Error),
            Group::RealInput(_) | Group::RealParameter(_) | Group::RealOutput(_) => {
                assert_eq!(plain.real(name).to_bits(), typed.real(name).to_bits(), "{name}");
            }
            Group::BooleanOutput(_) | Group::BooleanParameter(_) => {
                assert_eq!(plain.real(name) == 1.0, typed.boolean(name), "{name}");
            }
            _ => assert_eq!(plain.real(name), f64::from(typed.integer(name)), "{name}"),
        }
    }
    for name in ["contact.closed", "solver.steps"] {
        assert_eq!(plain.try_rate(name), (fmi2OK, 0.0), "discrete, so its derivative is 0");
    }
    assert!(plain.real("solver.steps") > 10.0 && plain.real("solver.modesUsed") == 5.0);
}

#[test]
fn a_number_that_stands_for_nothing_is_discarded() {
    for (name, value, parts) in [
        ("effects.excitation", 2.5, ["effects.excitation = 2.5", "allowed is a whole number"]),
        ("effects.excitation", 9.0, ["effects.excitation = 9", "Sine"]),
        ("effects.energy", 2.0, ["effects.energy = 2", "allowed is 0 or 1"]),
        ("effects.energy", 0.5, ["effects.energy = 0.5", "allowed is 0 or 1"]),
        ("solver.modes", -1.0, ["solver.modes = -1", "0 to"]),
        ("solver.modes", 1e300, ["solver.modes = 1e300", "a whole number"]),
        ("solver.modes", f64::NAN, ["solver.modes = NaN", "a whole number"]),
    ] {
        let fmu = plain();
        fmu.answers(fmu.set_reals(["beam.length", name], [0.02, value]), fmi2Discard, &parts);
        assert_ne!(fmu.real("beam.length"), 0.02, "all or none");
    }
    let fmu = plain();
    fmu.answers(fmu.set_real("contact.closed", 1.0), fmi2Error, &["contact.closed", "computed"]);
    let fmu = plain();
    fmu.initialize();
    fmu.answers(fmu.set_real("effects.energy", 1.0), fmi2Error, &["effects.energy", "fixed parameter"]);
}
