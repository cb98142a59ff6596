//! Spring files: what they hold arrives, and what is wrong in them is said with file, line, entry, value and range.

use std::fs;
use std::path::Path;

use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::scene::spring::{PointMass, Segments, Shape, SpringFile};
use tempfile::NamedTempFile;
use testing::springs::{mode, of_modes, segment, spring_file};

/// What is read of a file of this text, and its path.
fn read(text: &[u8]) -> (Result<SpringFile, String>, String) {
    let file = NamedTempFile::new().unwrap();
    fs::write(&file, text).unwrap();
    let path = file.path().to_str().unwrap();
    let read = SpringFile::read(Path::new(""), path).map_err(|error| error.to_string());
    (read, path.to_owned())
}

/// The message for a text, after the file.
fn message(text: &str) -> String {
    let (read, path) = read(text.as_bytes());
    let message = read.map_or_else(|message| message, |_| "accepted".to_owned());
    let after = message.strip_prefix(&format!("{path}:")).unwrap_or(&message);
    after.trim_start().to_owned()
}

const SEGMENT: &str = "[[segment]]\nlength = 0.01\nwidth = 4e-3\nthickness = 2e-4\n";

#[test]
fn errors_in_a_spring_file_have_line_entry_and_range() {
    let with = |more: &str| format!("{SEGMENT}{more}");
    #[rustfmt::skip]
    let cases = [
        (String::new(), "segment = 0 entries: not allowed, allowed are 1 to 500"),
        (with("width_start = 1e-3\n"), "3: segment 1: width: given twice, allowed is either one value, or one at the start and one at the end"),
        (with(&SEGMENT.replace("2e-4", "0")), "8: segment 2: thickness = 0 m: not allowed, allowed is 1e-6 to 0.005"),
        (with("thicknes = 1e-4\n"), "5: segment 1: thicknes: no such key, allowed are length, width, width_start, width_end, thickness, thickness_start, thickness_end, youngs_modulus, density; did you mean thickness?"),
        ("[[segmnt]]\nlength = 0.01\n".to_owned(), "1: segmnt: no such key, allowed are title, segment, mass, contact_position, fork_position, clamp_stiffness; did you mean segment?"),
        (with("[[segment]]\nlength = 1e-3\nwidth_start = 1e-3\nthickness = 1e-4\n"), "5: segment 2: width_end: missing; expected a number"),
        (with("density = \"light\"\n"), "5: segment 1: density = \"light\": wrong type, allowed is a number"),
        (format!("title = 3\n{SEGMENT}"), "1: title = 3: wrong type, allowed is a string"),
        (with("density = nan\n"), "5: segment 1: density = NaN kg/m3: not allowed, allowed is 1 to 100000"),
        (format!("contact_position = 0.011\n{SEGMENT}"), "1: contact_position = 0.011 m: not allowed, allowed is 0.001 to 0.01"),
        (with("[[mass]]\nposition = 0.02\nmass = 1e-6\n"), "6: mass 1: position = 0.02 m: not allowed, allowed is 1e-6 to 0.01"),
        (with("[mass]\nposition = 0.02\nmass = 1e-6\n"), "5: mass = table: wrong type, allowed is tables, each under its name in double brackets"),
        (SEGMENT.replace("0.01", "1e-5"), "length of all segments = 1e-5 m: not allowed, allowed is 0.001 to 0.2"),
        (format!("{SEGMENT}length = 3\n"), "5: not TOML: duplicate key"),
        (with("density = [[[1]]]\n"), "5: brackets inside each other: not allowed, allowed are 2"),
        ("compliance = 1e-3\n[[mode]]\nfrequency = 100\ncontact = 50\nparticipation = 0.01\n".to_owned(), "1: compliance = 0.001 m/N: not allowed, allowed is 0.006332573977646111 m/N or more, which the modes hold alone (sum of contact^2/omega^2); modes and compliance contradict each other"),
        ("compliance = 1\nparallel_compliance = 1e-3\n[[mode]]\nfrequency = 100\ncontact = 1\nparticipation = 0.01\nparallel = 50\n".to_owned(), "2: parallel_compliance = 0.001 m/N: not allowed, allowed is 0.006332573977646111 m/N or more, which the modes hold alone (sum of parallel^2/omega^2); modes and compliance contradict each other"),
        ("compliance = nan\n[[mode]]\nfrequency = 100\ncontact = 1\nparticipation = 0.01\n".to_owned(), "1: compliance = NaN m/N: not allowed, allowed is 1e-9 to 1000000"),
        ("compliance = 1\n[[mode]]\nfrequency = 100\nparticipation = 0.01\n".to_owned(), "2: mode 1: contact: missing; expected a number"),
        ("compliance = 1\n[[segment]]\nlength = 3\n".to_owned(), "2: segment: no such key, allowed are title, compliance, parallel_compliance, mode"),
    ];
    for (text, expected) in cases {
        assert_eq!(message(&text), expected, "{text}");
    }
}

#[test]
fn a_spring_file_that_cannot_be_read_is_refused() {
    // Others: `fmi_api/springs.rs`.
    let (long, _) = read(&vec![b' '; (1 << 20) + 1]);
    assert!(long.unwrap_err().ends_with("cannot be read: longer than 1048576 bytes"));
    let (latin, _) = read(b"title = \"\xe4\"\n");
    assert!(latin.unwrap_err().contains("UTF-8"));
}

#[test]
fn a_scene_names_its_spring_relative_to_itself() {
    let file = SceneFile::read(Path::new("scenes/tapered-spring.toml")).unwrap();
    let spring = file.scene.spring.as_ref().unwrap();
    assert_eq!(spring.name, "springs/tapered-cube.toml");
    let Shape::Segments(Segments { segments, masses, contact_position, clamp_stiffness, fork_position: None }) =
        &spring.shape
    else {
        panic!("{spring:?}");
    };
    assert_eq!((segments.len(), masses.len()), (2, 1));
    assert_eq!(segments[1].width, [4e-3, 2.4e-3]);
    assert_eq!(segments[1].thickness, [2e-4; 2]);
    assert_eq!((*contact_position, *clamp_stiffness), (Some(0.018), Some(1.2)));
    assert_eq!(Model::new(&file.scene, 0.0).unwrap().remarks(), []);
}

type Spoil = fn(&mut Segments);

/// A spring that a program makes is checked as one of a file is, with the name that it was given.
#[test]
fn a_spring_that_was_not_read_is_checked_too() {
    let good = Segments {
        segments: vec![segment(0.01, [4e-3; 2], [2e-4; 2]); 2],
        masses: vec![PointMass { position: 0.02, mass: 1e-6, rotary_inertia: 0.0 }],
        ..Segments::default()
    };
    let refusal = |shape: Shape| {
        let scene = Scene { fixed_spring: spring_file("own.toml", shape), ..Scene::default() };
        Model::new(&scene, 0.0).map_or_else(|error| error.to_string(), |_| String::new())
    };
    assert_eq!(refusal(Shape::Segments(good.clone())), "");
    #[rustfmt::skip]
    let cases: [(Spoil, &str); 8] = [
        (|spring| spring.segments[1].length = -0.01, "length = -0.01 m"),
        (|spring| spring.segments[1].length = f64::NAN, "length = NaN m"),
        (|spring| spring.segments[0].width[1] = 0.0, "width_end = 0 m"),
        (|spring| spring.segments[0].thickness[0] = f64::INFINITY, "thickness_start = inf m"),
        (|spring| spring.masses[0].position = 0.0201, "position = 0.0201 m: not allowed, allowed is 1e-6 to 0.02"),
        (|spring| spring.masses[0].rotary_inertia = -1e-12, "rotary_inertia = -1e-12 kg.m2"),
        (|spring| spring.contact_position = Some(0.021), "contact_position = 0.021 m: not allowed, allowed is 0.001 to 0.02"),
        (|spring| spring.clamp_stiffness = Some(f64::NAN), "clamp_stiffness = NaN N.m/rad"),
    ];
    let spoiled = cases.map(|(spoil, expected)| {
        let mut spring = good.clone();
        spoil(&mut spring);
        (Shape::Segments(spring), expected)
    });
    let with = |given| of_modes(1e-3, [given]);
    for (shape, expected) in spoiled.into_iter().chain([
        (with(mode(-1.0, 1.0, 0.0)), "frequency = -1 Hz"),
        (with(mode(100.0, f64::NAN, 0.0)), "contact = NaN 1/sqrt(kg)"),
        (with(mode(100.0, 1.0, 2.0)), "participation = 2 sqrt(kg)"),
        (with(mode(100.0, 50.0, 0.0)), "compliance = 0.001 m/N: not allowed, allowed is 0.00633"),
    ]) {
        let said = refusal(shape);
        assert!(said.starts_with("own.toml: ") && said.contains(expected), "{expected:?} missing: {said}");
    }
}
