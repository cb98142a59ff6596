//! Scene files and their tables of inputs: what they hold arrives in the scene, or is handed over at the communication points with its
//! rate, and what is wrong in them is said with its name, value and place.

use std::error::Error;
use std::fs;
use std::path::{MAIN_SEPARATOR, Path};

use relay_contact::error::SceneError;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::{ExcitationKind, RealInput};
use tempfile::TempDir;
use testing::scenes;

const HEAD: &str = "stop = 1\ncommunicationStep = 1e-3\noutputs = []\n";

/// The message for a file of [`HEAD`] (three lines) and `rest`.
fn message(rest: &str) -> String {
    let file = format!("{HEAD}{rest}").parse::<SceneFile>();
    file.unwrap_err().to_string()
}

#[test]
fn every_scene_of_the_project_is_valid() -> Result<(), Box<dyn Error>> {
    let paths = scenes::files();
    for path in &paths {
        let file = SceneFile::read(path)?;
        assert!(!file.title.is_empty() && !file.outputs.is_empty(), "{}", path.display());
        assert!(file.communication_step <= file.stop, "{}", path.display());
    }
    assert!(paths.len() >= 10);
    Ok(())
}

#[test]
fn dotted_and_nested_tables_name_the_same_variables() -> Result<(), SceneError> {
    let dotted =
        "[parameters]\nbeam.length = 0.02\ncontact.moving.youngsModulus = 9e10\neffects.excitation = \"Sine\"\n";
    let nested = "[parameters.beam]\nlength = 0.02\n[parameters.contact.moving]\nyoungsModulus = 9e10\n\
                  [parameters.effects]\nexcitation = \"Sine\"\n";
    let mut expected = Scene::default();
    expected.beam.length = 0.02;
    expected.contact.moving.youngs_modulus = 9e10;
    expected.effects.excitation = ExcitationKind::Sine;
    for text in [dotted, nested] {
        let file: SceneFile = format!("{HEAD}{text}").parse()?;
        assert_eq!(file.scene, expected);
        assert_eq!(file.inputs, Inputs::default());
    }
    Ok(())
}

#[test]
fn inputs_and_outputs_are_taken() -> Result<(), SceneError> {
    let file: SceneFile = "stop = 1\ncommunicationStep = 1e-3\noutputs = [\"contact.closed\", \"contact.force\"]\n\
                           [inputs]\ncontact.current = 0.1\n"
        .parse()?;
    let names: Vec<_> = file.outputs.iter().map(|variable| variable.name).collect();
    assert_eq!(names, ["contact.closed", "contact.force"]);
    assert_eq!(file.inputs.real(RealInput::ContactCurrent), 0.1);
    Ok(())
}

#[test]
fn errors_are_reported_with_their_line_and_what_is_allowed() {
    #[rustfmt::skip]
    let parameters = [
        // Out of its range, with the unit.
        ("beam.length = -0.0155", "beam.length = -0.0155 m: not allowed, allowed is 0.001 to 0.2"),
        ("contact.fixed.poissonRatio = 0.6", "contact.fixed.poissonRatio = 0.6: not allowed, allowed is more than -1 and less than 0.5"),
        ("resistance.open = 0", "resistance.open = 0 Ohm: not allowed, allowed is 1 to 1000000000000000"),
        ("beam.length = nan", "beam.length = NaN m: not allowed, allowed is 0.001 to 0.2"),
        ("solver.modes = 129", "solver.modes = 129: not allowed, allowed is 0 to 128"),
        ("effects.excitation = \"Sinus\"", "effects.excitation = Sinus: no such choice, allowed are None, Sine, LogSweep, HalfSine, Random"),
        // Of another type.
        ("beam.length = \"long\"", "beam.length = \"long\": wrong type, allowed is a number"),
        ("beam.length = true", "beam.length = true: wrong type, allowed is a number"),
        ("beam.length = [1]", "beam.length = array: wrong type, allowed is a number"),
        ("beam.length = 1979-05-27", "beam.length = 1979-05-27: wrong type, allowed is a number"),
        ("solver.modes = 3.5", "solver.modes = 3.5: wrong type, allowed is a whole number"),
        ("effects.excitation = 2", "effects.excitation = 2: wrong type, allowed is the name of a choice, as a string"),
        ("effects.excitation = false", "effects.excitation = false: wrong type, allowed is the name of a choice, as a string"),
        ("effects.chatter = 1", "effects.chatter = 1: wrong type, allowed is true or false"),
        ("effects.chatter = \"false\"", "effects.chatter = \"false\": wrong type, allowed is true or false"),
    ];
    for (text, expected) in parameters {
        assert_eq!(message(&format!("[parameters]\n{text}\n")), format!("line 5: {expected}"));
    }
    #[rustfmt::skip]
    let cases = [
        ("[inputs]\nbase.acceleration = inf\n", "line 5: base.acceleration = inf m/s2: not allowed, allowed is -1000000000 to 1000000000"),
        ("[parameters]\nbeam.length = 0.02\n\"beam.length\" = 0.01\n", "line 6: beam.length: given twice, allowed is one value"),
        ("inputs = 3", "line 4: inputs = 3: wrong type, allowed is a table"),
        ("title = 3", "line 4: title = 3: wrong type, allowed is a string"),
        ("communicationStepp = 1\n", "line 4: communicationStepp: no such key, allowed are title, stop, communicationStep, outputs, parameters, inputs; did you mean communicationStep?"),
        ("[inputs]\nfile = 3\n", "line 5: file = 3: wrong type, allowed is the path of an input table, as a string"),
    ];
    for (rest, expected) in cases {
        assert_eq!(message(rest), expected);
    }
    #[rustfmt::skip]
    let beginnings = [
        ("[parameters]\nbeam.lenght = 0.02\n", "line 5: beam.lenght: no such parameter; similar: beam.length,"),
        ("[parameters]\n\novertravel = 1e-4\n", "line 6: overtravel: no such parameter; similar: contact.overtravel,"),
        // An output is not a parameter, and a parameter not an input.
        ("[parameters]\ncontact.force = 1\n", "line 5: contact.force: no such parameter"),
        ("[inputs]\nbeam.length = 1\n", "line 5: beam.length: no such input"),
        ("[inputs]\nfile = \"no-such.csv\"\n", "line 5: no-such.csv: cannot be read: "),
    ];
    for (rest, expected) in beginnings {
        let found = message(rest);
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    #[rustfmt::skip]
    let heads = [
        ("communicationStep = 1\noutputs = []", "stop: missing; expected a positive number of seconds"),
        ("stop = 1\ncommunicationStep = 1", "outputs: missing; expected a list of output names"),
        ("stop = 1\ncommunicationStep = 0\noutputs = []", "line 2: communicationStep = 0 s: not allowed, allowed is any positive finite number"),
        ("stop = = 1", "line 1: not TOML: "),
        ("stop = 1\ncommunicationStep = 1\noutputs = [\"contact.forse\"]", "line 3: contact.forse: no such output; similar: contact.force,"),
    ];
    for (text, expected) in heads {
        let found = text.parse::<SceneFile>().unwrap_err().to_string();
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    let unreadable = SceneFile::read(Path::new("no-such.toml"));
    assert!(matches!(unreadable, Err(SceneError::Unreadable { .. })));
}

#[test]
fn a_whole_number_of_any_size_is_a_number() -> Result<(), SceneError> {
    let file: SceneFile = format!("{HEAD}[parameters]\nbeam.youngsModulus = 130_000_000_000\n").parse()?;
    assert_eq!(file.scene.beam.youngs_modulus, 1.3e11);
    Ok(())
}

#[test]
fn setting_by_name_takes_numbers_and_choices_and_keeps_the_rest_when_refused() -> Result<(), SceneError> {
    let mut file: SceneFile = HEAD.parse()?;
    file.set("beam.length", "0.02")?;
    file.set("effects.excitation", "Sine")?;
    file.set("base.acceleration", "-5")?;
    file.set("solver.modes", "4")?;
    file.set("effects.chatter", "false")?;
    file.set("outputs", "contact.force, contact.closed")?;
    file.set("stop", "0.5")?;
    let kept = file.clone();
    for (name, value) in [
        ("beam.length", "1"),
        ("beam.length", "long"),
        ("effects.excitation", "Noise"),
        ("effects.chatter", "0"),
        ("base.acceleration", "nan"),
        ("contact.force", "1"),
        ("outputs", "contact.force,contact.forse"),
        ("stop", "-1"),
    ] {
        assert!(file.set(name, value).is_err(), "{name} = {value}");
    }
    assert_eq!(file.scene, kept.scene);
    assert_eq!(file.inputs, kept.inputs);
    let names: Vec<_> = file.outputs.iter().map(|variable| variable.name).collect();
    assert_eq!(names, ["contact.force", "contact.closed"]);
    assert_eq!(file.stop, 0.5);
    assert_eq!(file.scene.beam.length, 0.02);
    assert_eq!(file.scene.solver.modes, 4);
    assert_eq!(file.scene.effects.excitation, ExcitationKind::Sine);
    assert!(!file.scene.effects.chatter);
    assert_eq!(file.inputs.base_acceleration, -5.0);
    Ok(())
}

#[test]
fn communication_steps_fill_the_run_and_the_last_ends_with_it() -> Result<(), SceneError> {
    let steps = |stop: &str, step: &str| -> Result<Vec<(f64, f64)>, SceneError> {
        let file: SceneFile = format!("stop = {stop}\ncommunicationStep = {step}\noutputs = []").parse()?;
        Ok(file.steps().collect())
    };
    assert_eq!(steps("1", "0.5")?, [(0.0, 0.5), (0.5, 0.5)]);
    assert_eq!(steps("1.25", "0.5")?, [(0.0, 0.5), (0.5, 0.5), (1.0, 0.25)]);
    assert_eq!(steps("0.5", "2")?, [(0.0, 0.5)]);
    // 0.3 / 0.1 is less than 3 by rounding, 0.07 / 0.01 more than 7 by a hair.
    assert_eq!(steps("0.3", "0.1")?.len(), 3);
    assert_eq!(steps("0.07", "0.01")?.len(), 7);
    Ok(())
}

/// A scene in a folder with this table, and `rest` among its inputs.
fn with_table(folder: &TempDir, table: &str, rest: &str) -> Result<SceneFile, Box<dyn Error>> {
    fs::write(folder.path().join("table.csv"), table)?;
    let path = folder.path().join("scene.toml");
    fs::write(&path, format!("{HEAD}[inputs]\nfile = \"table.csv\"\n{rest}"))?;
    Ok(SceneFile::read(&path)?)
}

#[test]
fn between_rows_inputs_are_linear_and_beyond_them_held() -> Result<(), Box<dyn Error>> {
    let table = "time, contact.current ,support.displacement\n 0.25,0.5,0\n0.75,1.5,-1e-4\n";
    let file = with_table(&tempfile::tempdir()?, table, "base.acceleration = 9\n")?;
    let held = |contact_current, support_displacement| Inputs {
        base_acceleration: 9.0,
        contact_current,
        support_displacement,
        ..Inputs::default()
    };
    assert_eq!(file.inputs_over(0.0, 0.125)?, held(0.5, 0.0));
    assert_eq!(file.inputs_over(0.75, 0.125)?, held(1.5, -1e-4));
    assert_eq!(file.inputs_over(2.0, 0.125)?, held(1.5, -1e-4));
    let half = file.inputs_over(0.5, 0.125)?;
    assert_eq!(half.contact_current, 1.0);
    assert_eq!(half.contact_current_rate, 2.0);
    assert_eq!(half.base_acceleration_rate, 0.0);
    assert!((half.support_displacement + 5e-5).abs() < 1e-19);
    assert!((half.support_displacement_rate + 2e-4).abs() < 1e-18);
    // A run shorter than a communication step passes no row after its end.
    let mut short = file.clone();
    (short.stop, short.communication_step) = (0.2, 10.0);
    assert_eq!(short.first_inputs()?, held(0.5, 0.0));
    // Over a row the rate leads to the value at the end of the step.
    let over = file.inputs_over(0.5, 0.5)?;
    assert_eq!((over.contact_current, over.contact_current_rate), (1.0, 1.0));
    // Over two the course between them would be lost.
    let passed = file.inputs_over(0.2, 0.6).unwrap_err().to_string();
    assert!(passed.contains("communicationStep = 0.6 s") && passed.contains("0.5 s"), "{passed}");
    // Times of a recorder are rounded.
    assert!(file.inputs_over(0.25, 0.5).is_ok() && file.inputs_over(0.249, 0.502).is_ok());
    Ok(())
}

#[test]
fn a_table_beside_the_run_is_refused() -> Result<(), Box<dyn Error>> {
    for (rows, is_refused) in [("3600,0\n3600.1,1\n", true), ("-2,0\n-1,1\n", true), ("-1,0\n0.1,1\n", false)] {
        let file = with_table(&tempfile::tempdir()?, &format!("time,contact.current\n{rows}"), "");
        let refused = file.err().map(|error| error.to_string()).unwrap_or_default();
        assert_eq!(refused.contains("the run lasts from 0 to"), is_refused, "{rows}: {refused}");
    }
    Ok(())
}

#[test]
fn a_value_set_by_name_holds_the_input() -> Result<(), Box<dyn Error>> {
    let mut file = with_table(&tempfile::tempdir()?, "time,contact.current\n0,0\n1,1\n", "")?;
    assert_eq!(file.inputs_over(0.5, 0.1)?.contact_current, 0.5);
    assert!(file.set("contact.current", "nan").is_err());
    assert_eq!(file.inputs_over(0.5, 0.1)?.contact_current, 0.5);
    file.set("contact.current", "3")?;
    let inputs = file.inputs_over(0.5, 0.1)?;
    assert_eq!((inputs.contact_current, inputs.contact_current_rate), (3.0, 0.0));
    Ok(())
}

#[test]
fn errors_in_a_table_are_reported_with_their_place() -> Result<(), Box<dyn Error>> {
    #[rustfmt::skip]
    let cases = [
        ("time,contact.curent\n0,1\n", ":1: contact.curent: no such input; similar: contact.current,"),
        ("time,contact.force\n0,1\n", ":1: contact.force: no such input; similar: contact.current,"),
        ("contact.current\n1\n", ":1: time: missing; expected a column of times in s"),
        ("time,contact.current,contact.current\n0,1,1\n", ":1: contact.current: given twice, allowed is one column"),
        ("time,contact.current\n0,1\n1,one\n", ":3: contact.current = \"one\": wrong type, allowed is a number"),
        ("time,contact.current\n0,1\n\n1,\n", ":4: contact.current = \"\": wrong type, allowed is a number"),
        ("time,support.displacement\n0,1\n", ":2: support.displacement = 1 m: not allowed, allowed is -0.1 to 0.1"),
        ("time,contact.current\n0,nan\n", ":2: contact.current = NaN A: not allowed, allowed is -1000000 to 1000000"),
        ("time,contact.current\n1,0\n1,1\n", ":3: time = 1 s: not allowed, allowed is any finite number above that of the previous row, 1 s"),
        ("time,contact.current\n0,1,2\n", ": not a table of inputs: CSV error: record 1 (line: 2, byte: 21): found record with 3 fields"),
        ("time,contact.current\n", ": not a table of inputs: no row below the header"),
    ];
    let folder = tempfile::tempdir()?;
    // The message, the paths of the files without their folder.
    let said = |table: &str, rest: &str| {
        let error = with_table(&folder, table, rest).unwrap_err().to_string();
        error.replace(&format!("{}{MAIN_SEPARATOR}", folder.path().display()), "")
    };
    for (table, expected) in cases {
        let (message, expected) = (said(table, ""), format!("scene.toml:5: table.csv{expected}"));
        assert!(message.starts_with(&expected), "{message}\n{expected}");
    }
    assert_eq!(
        said("time,contact.current\n0,1\n", "contact.current = 1\n"),
        "scene.toml:6: contact.current: given twice, allowed is either a value here or a column of the file"
    );
    Ok(())
}
