//! Scene files: what they hold arrives in the scene, and what is wrong in them is said with its name, value and place.

use std::error::Error;

use relay_contact::error::SceneError;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::{ExcitationKind, RealInput, RealParameter};
use testing::scenes;

const HEAD: &str = "stop = 1\ncommunicationStep = 1e-3\noutputs = []\n";

/// The message for a file of [`HEAD`] (three lines) and `rest`.
fn message(rest: &str) -> String {
    match format!("{HEAD}{rest}").parse::<SceneFile>() {
        Ok(_) => "accepted".to_owned(),
        Err(error) => error.to_string(),
    }
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
    expected.set_real(RealParameter::BeamLength, 0.02)?;
    expected.set_real(RealParameter::ContactMovingYoungsModulus, 9e10)?;
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
fn an_unknown_name_is_reported_with_its_line_and_the_nearest_names() {
    let misspelt = message("[parameters]\nbeam.lenght = 0.02\n");
    assert!(
        misspelt.starts_with("line 5: beam.lenght: no such parameter; similar: beam.length,"),
        "{misspelt}"
    );
    let omitted = message("[parameters]\n\novertravel = 1e-4\n");
    assert!(
        omitted.starts_with("line 6: overtravel: no such parameter; similar: contact.overtravel,"),
        "{omitted}"
    );
    assert_eq!(
        message("communicationStepp = 1\n"),
        "line 4: communicationStepp: no such key, allowed are title, stop, communicationStep, outputs, parameters, inputs; did \
         you mean communicationStep?"
    );
    // An output is not a parameter, and a parameter not an input.
    assert!(message("[parameters]\ncontact.force = 1\n").contains("contact.force: no such parameter"));
    assert!(message("[inputs]\nbeam.length = 1\n").contains("beam.length: no such input"));
    let output = "stop = 1\ncommunicationStep = 1\noutputs = [\"contact.forse\"]".parse::<SceneFile>();
    assert!(output.is_err_and(|error| {
        error
            .to_string()
            .starts_with("line 3: contact.forse: no such output; similar: contact.force,")
    }));
}

#[test]
fn a_value_out_of_range_is_reported_with_its_unit_and_the_range() {
    #[rustfmt::skip]
    let cases = [
        ("beam.length = -0.0155", "line 5: beam.length = -0.0155 m: not allowed, allowed is 0.001 to 0.2"),
        ("contact.fixed.poissonRatio = 0.6", "line 5: contact.fixed.poissonRatio = 0.6: not allowed, allowed is more than -1 and less than 0.5"),
        ("resistance.open = 0", "line 5: resistance.open = 0 Ohm: not allowed, allowed is 1 to 1000000000000000"),
        ("beam.length = nan", "line 5: beam.length = NaN m: not allowed, allowed is 0.001 to 0.2"),
        ("solver.modes = 129", "line 5: solver.modes = 129: not allowed, allowed is 0 to 128"),
        ("effects.excitation = \"Sinus\"", "line 5: effects.excitation = Sinus: no such choice, allowed are None, Sine, LogSweep, HalfSine, Random"),
    ];
    for (rest, expected) in cases {
        assert_eq!(message(&format!("[parameters]\n{rest}\n")), expected);
    }
    assert_eq!(
        message("[inputs]\nbase.acceleration = inf\n"),
        "line 5: base.acceleration = inf m/s2: not allowed, allowed is -1000000000 to 1000000000"
    );
}

#[test]
fn a_value_of_the_wrong_type_is_reported_with_the_type_expected() {
    #[rustfmt::skip]
    let cases = [
        ("beam.length = \"long\"", "line 5: beam.length = \"long\": wrong type, allowed is a number"),
        ("solver.modes = 3.5", "line 5: solver.modes = 3.5: wrong type, allowed is a whole number"),
        ("effects.excitation = 2", "line 5: effects.excitation = 2: wrong type, allowed is the name of a choice, as a string"),
        ("effects.chatter = 1", "line 5: effects.chatter = 1: wrong type, allowed is true or false"),
        ("effects.chatter = \"false\"", "line 5: effects.chatter = \"false\": wrong type, allowed is true or false"),
        ("beam.length = true", "line 5: beam.length = true: wrong type, allowed is a number"),
        ("effects.excitation = false", "line 5: effects.excitation = false: wrong type, allowed is the name of a choice, as a string"),
    ];
    for (rest, expected) in cases {
        assert_eq!(message(&format!("[parameters]\n{rest}\n")), expected);
    }
    for (rest, line, expected) in [
        ("inputs = 3", 4, "inputs = 3: wrong type, allowed is a table"),
        ("title = 3", 4, "title = 3: wrong type, allowed is a string"),
        (
            "[parameters]\nbeam.length = [1]",
            5,
            "beam.length = array: wrong type, allowed is a number",
        ),
        (
            "[parameters]\nbeam.length = 1979-05-27",
            5,
            "beam.length = 1979-05-27: wrong type, allowed is a number",
        ),
    ] {
        assert_eq!(message(rest), format!("line {line}: {expected}"));
    }
}

#[test]
fn a_whole_number_of_any_size_is_a_number() -> Result<(), SceneError> {
    let file: SceneFile = format!("{HEAD}[parameters]\nbeam.youngsModulus = 130_000_000_000\n").parse()?;
    assert_eq!(file.scene.beam.youngs_modulus, 1.3e11);
    Ok(())
}

#[test]
fn the_run_must_have_a_length_and_a_step() {
    let parse = |text: &str| {
        text.parse::<SceneFile>()
            .map_or_else(|error| error.to_string(), |_| "accepted".to_owned())
    };
    assert_eq!(
        parse("communicationStep = 1\noutputs = []"),
        "stop: missing; expected a positive number of seconds"
    );
    assert_eq!(
        parse("stop = 1\ncommunicationStep = 1"),
        "outputs: missing; expected a list of output names"
    );
    assert_eq!(
        parse("stop = 1\ncommunicationStep = 0\noutputs = []"),
        "line 2: communicationStep = 0 s: not allowed, allowed is any positive finite number"
    );
    assert!(parse("stop = = 1").starts_with("line 1: not TOML: "));
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
    // 0.3 / 0.1 is less than 3 by rounding, 0.7 / 0.1 more than 7 by hair.
    assert_eq!(steps("0.3", "0.1")?.len(), 3);
    assert_eq!(steps("0.7", "0.1")?.len(), 7);
    Ok(())
}
