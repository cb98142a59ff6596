//! The spring of a file: set, refused, kept by states.

use std::ffi::CString;
use std::ptr;

use relay_contact::fmi2::*;
use relay_contact::variables::{GUID, PLAIN_GUID, guid_carrying};
use testing::instance::{Arguments, Instance, vr};
use testing::log::{Log, callbacks};

use super::fmu_state::trace;

const FILE: &str = "springs/tapered-cube.toml";

/// The location of a folder of the project.
fn location(folder: &str) -> CString {
    let folder = std::env::current_dir().unwrap().join(folder);
    CString::new(format!("file://{}", folder.display())).unwrap()
}

/// An instance whose resources are the project's scenes.
fn in_scenes() -> Instance {
    Instance::with(&Arguments { resources: Some(&location("scenes")), ..Arguments::default() })
}

fn sprung() -> Instance {
    let fmu = in_scenes();
    assert_eq!(fmu.set_string("beam.file", FILE), fmi2OK);
    fmu.shake(400.0);
    fmu.initialize();
    fmu
}

#[test]
fn a_spring_of_the_resources_is_read_and_can_be_left_again() {
    let (plain, fmu) = (Instance::initialized(), sprung());
    assert_eq!(plain.string("beam.file"), "");
    assert_eq!(fmu.string("beam.file"), FILE);
    let (uniform, tapered) = (plain.real("preload.force"), fmu.real("preload.force"));
    assert!(tapered > 0.0 && (tapered - uniform).abs() > 0.1 * uniform, "{uniform} {tapered}");
    assert_eq!(fmu.reset(), fmi2OK);
    assert_eq!(fmu.string("beam.file"), "");
    fmu.initialize();
    assert_eq!(fmu.real("preload.force").to_bits(), uniform.to_bits());
    // Outputs in Initialization Mode follow it too.
    let fmu = in_scenes();
    assert_eq!(fmu.enter_initialization_mode(), fmi2OK);
    assert_eq!(fmu.real("preload.force").to_bits(), uniform.to_bits());
    assert_eq!(fmu.set_string("beam.file", FILE), fmi2OK);
    assert_eq!(fmu.real("preload.force").to_bits(), tapered.to_bits());
    assert_eq!(fmu.set_string("beam.file", ""), fmi2OK);
    assert_eq!(fmu.real("preload.force").to_bits(), uniform.to_bits());
}

#[test]
fn a_state_keeps_its_spring_where_there_is_no_file_or_another_spring() {
    let (carrier, _) = carrying(GUID, "tapered-cube.toml");
    carrier.shake(400.0);
    carrier.initialize();
    for (fmu, own) in [(sprung(), FILE), (carrier, "tapered-cube.toml")] {
        trace(&fmu, 0, 30, 2e-5);
        let saved = fmu.save();
        let bytes = fmu.to_bytes(saved);
        let expected = trace(&fmu, 30, 60, 2e-5);
        let (other, _) = carrying(GUID, "hole-and-rivet-modes.toml");
        // Without resources; and in the step where another spring is used.
        for (other, kept) in
            [(Instance::new(), ""), (Instance::initialized(), ""), (other, "hole-and-rivet-modes.toml")]
        {
            let (status, made) = other.from_bytes(&bytes);
            assert_eq!((status, other.to_bytes(made)), (fmi2OK, bytes.clone()));
            for state in [made, saved] {
                assert_eq!(other.restore(state), fmi2OK);
                assert_eq!(other.string("beam.file"), own);
                assert_eq!(trace(&other, 30, 60, 2e-5), expected);
            }
            assert_eq!(other.reset(), fmi2OK);
            assert_eq!(other.string("beam.file"), kept);
        }
    }
}

#[test]
fn a_file_that_is_no_spring_is_discarded_and_changes_nothing() {
    let fmu = in_scenes();
    assert_eq!(fmu.set_string("beam.file", FILE), fmi2OK);
    let long = "a".repeat(5000);
    for (file, parts) in [
        ("none.toml", &["fmi2SetString", "scenes/none.toml: cannot be read"][..]),
        ("/", &["/: cannot be read: not a file"]),
        ("springs", &["scenes/springs: cannot be read: not a file"]),
        ("/dev/zero", &["/dev/zero: cannot be read: not a file"]),
        ("at-rest.toml", &["scenes/at-rest.toml:2: stop: no such key, allowed are"]),
        (&long, &["beam.file = \"aaaa", "allowed is a path in UTF-8 of at most 4096 bytes"]),
    ] {
        fmu.answers(fmu.set_string("beam.file", file), fmi2Discard, parts);
        assert_eq!(fmu.string("beam.file"), FILE);
    }
    let set =
        |text: fmi2String| unsafe { fmi2SetString(fmu.component, [vr("beam.file")].as_ptr(), 1, &raw const text) };
    fmu.answers(set(c"\xff".as_ptr()), fmi2Discard, &["beam.file", "UTF-8"]);
    fmu.answers(set(ptr::null()), fmi2Error, &["argument value is null"]);
    // Without resources there is nothing a relative path could be relative to.
    let fmu = Instance::new();
    fmu.answers(
        fmu.set_string("beam.file", FILE),
        fmi2Discard,
        &["springs/tapered-cube.toml: cannot be read: a relative path", "fmuResourceLocation"],
    );
    let fmu = Instance::initialized();
    fmu.answers(fmu.set_string("beam.file", ""), fmi2Error, &["beam.file: cannot be set in the state step complete"]);
}

#[test]
fn a_dimension_beside_a_spring_is_a_warning_and_the_simulation_goes_on() {
    let fmu = in_scenes();
    assert_eq!(fmu.set_string("beam.file", FILE), fmi2OK);
    assert_eq!(fmu.set_real("beam.length", 0.02), fmi2OK);
    fmu.initialize();
    let parts =
        ["fmi2ExitInitializationMode: beam.length = 0.02 m: not used, the spring is that of beam.file = springs/"];
    fmu.expect_message(fmi2Warning, &parts);
    assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
}

fn carrying(guid: &str, name: &str) -> (Instance, String) {
    let text = std::fs::read_to_string(format!("scenes/springs/{name}")).unwrap();
    let guid = guid_carrying(guid, name, &text);
    let fmu = Instance::with(&Arguments {
        guid: Some(&guid),
        resources: Some(&location("scenes/springs")),
        ..Arguments::default()
    });
    (fmu, guid)
}

#[test]
fn the_guid_says_which_spring_a_component_carries() {
    let names = ["tapered-cube.toml", "hole-and-rivet-modes.toml"];
    let mut frequencies = vec![Instance::initialized().real("preload.frequency")];
    let mut guids = vec![GUID.to_owned(), PLAIN_GUID.to_owned()];
    for variant in [GUID, PLAIN_GUID] {
        for name in names {
            let (fmu, guid) = carrying(variant, name);
            guids.push(guid);
            assert_eq!(fmu.string("beam.file"), name);
            fmu.initialize();
            frequencies.push(fmu.real("preload.frequency"));
            assert_eq!(fmu.reset(), fmi2OK);
            assert_eq!(fmu.string("beam.file"), name, "after a reset");
        }
    }
    let [uniform, tapered, holed, ref plain @ ..] = frequencies[..] else { panic!("{frequencies:?}") };
    assert_eq!(plain, [tapered, holed]);
    assert!((tapered - uniform).abs() > 10.0 && (holed - tapered).abs() > 10.0, "{frequencies:?}");
    guids.sort();
    guids.dedup();
    assert_eq!(guids.len(), 6);
}

#[test]
fn a_description_without_the_spring_that_belongs_to_it_is_refused() {
    let name = "tapered-cube.toml";
    let text = std::fs::read_to_string(format!("scenes/springs/{name}")).unwrap();
    let none = CString::new("/nowhere").unwrap();
    let springs = location("scenes/springs");
    for (guid, resources) in [
        // Another file of this name, the file by another name, that of another library, and no file at all.
        (guid_carrying(GUID, name, &(text.clone() + "\n")), Some(&springs)),
        (guid_carrying(GUID, "spring.toml", &text), Some(&springs)),
        (guid_carrying("{0123}", name, &text), Some(&springs)),
        (guid_carrying(GUID, name, &text), Some(&none)),
        (guid_carrying(GUID, name, &text), None),
    ] {
        let log = Log::default();
        let resources = resources.map(CString::as_c_str);
        let wrong = Arguments { guid: Some(&guid), resources, ..Arguments::default() };
        assert!(wrong.instantiate(fmi2Instantiate, Some(&callbacks(&log))).is_null());
        let messages = log.into_inner().unwrap();
        let told = |part: &str| messages.iter().any(|message| message.text.contains(part));
        assert!(told("spring file do not belong together") && told(&guid), "{messages:?}");
    }
}
