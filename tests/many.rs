//! Many scenes at once: what each gives alone, in their order, whatever the others do.

use std::num::NonZero;
use std::path::Path;

use relay_contact::error::SceneError;
use relay_contact::many::{RunError, run_many};
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::{Kept, Simulation};

fn scene(name: &str, changes: &[(&str, &str)]) -> SceneFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    let mut scene = SceneFile::read(&path).unwrap();
    for (name, value) in changes {
        scene.set(name, value).unwrap();
    }
    scene
}

/// Scenes of very different length, one of which cannot be simulated: all it takes to leave the order.
fn scenes() -> Vec<SceneFile> {
    let buckled = [("effects.axialForce", "Prescribed"), ("beam.axialForce", "500")];
    vec![
        scene("chatter-41g.toml", &[]),
        scene("paper-1khz.toml", &[("stop", "1e-3")]),
        scene("at-rest.toml", &buckled),
        scene("closing-bounce.toml", &[]),
        scene("paper-1khz.toml", &[("stop", "1e-4"), ("excitation.frequency", "500")]),
        scene("at-rest.toml", &[]),
    ]
}

/// The outputs of a scene by itself.
fn alone(scene: &SceneFile) -> Result<Vec<f64>, SceneError> {
    let start = scene.first_inputs()?;
    let mut contact = Simulation::new(&scene.scene, &start, 0.0)?;
    for (time, size) in scene.steps() {
        contact.step(&scene.inputs_over(time, size)?, time, size).unwrap();
    }
    Ok(scene.outputs.iter().map(|variable| contact.output(variable).unwrap()).collect())
}

fn bits(row: &[f64]) -> Vec<u64> {
    row.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn each_has_the_bits_and_the_place_that_it_has_alone() {
    let scenes = scenes();
    let expected: Vec<_> = scenes.iter().map(alone).collect();
    assert!(matches!(expected[2], Err(SceneError::Buckled { .. })));
    // Rows that could be confused would prove no order.
    let first = |row: &Result<Vec<f64>, SceneError>| row.as_ref().ok().map(|row| row[0].to_bits());
    assert!((0..6).all(|i| (0..i).all(|j| first(&expected[i]) != first(&expected[j]))));
    for workers in [1, 2, 5, 50] {
        let mut told = Vec::new();
        let rows = run_many(&scenes, NonZero::new(workers).unwrap(), |done| told.push(done));
        assert_eq!(told, [1, 2, 3, 4, 5, 6]);
        for (row, expected) in rows.iter().zip(&expected) {
            match (row, expected) {
                (Ok(row), Ok(expected)) => assert_eq!(bits(row), bits(expected), "{workers} workers"),
                (Err(RunError::Scene(error)), Err(expected)) => assert_eq!(error, expected),
                other => panic!("{other:?}"),
            }
        }
    }
}

#[test]
fn what_others_have_left_changes_no_bit() {
    // Scenes that share modes but not the generator, the preload or the lengths of steps; and such that share no modes.
    let chatter = |changes: &[(&str, &str)]| scene("chatter-41g.toml", changes);
    let rubbing = |name, value| chatter(&[("effects.friction", "Coulomb"), ("solver.modes", "16"), (name, value)]);
    let scenes: [_; 16] = [
        chatter(&[]),
        chatter(&[("excitation.frequency", "700"), ("excitation.amplitude", "450")]),
        chatter(&[("effects.excitation", "LogSweep"), ("excitation.endFrequency", "3000")]),
        chatter(&[("effects.excitation", "HalfSine"), ("contact.overtravel", "5e-5")]),
        rubbing("tip.contactHeight", "1e-3"),
        rubbing("tip.contactHeight", "7e-4"),
        rubbing("contact.damping", "2e-5"),
        rubbing("beam.massDamping", "3"),
        chatter(&[("effects.axialForce", "FromPreload")]),
        chatter(&[("effects.axialForce", "FromDeflection")]),
        chatter(&[("effects.axialForce", "Prescribed"), ("beam.axialForce", "0.5")]),
        chatter(&[("beam.thickness", "1.1e-4")]),
        chatter(&[("communicationStep", "7e-5")]),
        scene("tapered-spring.toml", &[("stop", "2e-3")]),
        scene("tapered-spring.toml", &[("stop", "2e-3"), ("excitation.frequency", "300")]),
        scene("tapered-spring.toml", &[("stop", "2e-3"), ("tip.mass", "2e-6")]),
    ];
    let expected: Vec<_> = scenes.iter().map(|scene| bits(&alone(scene).unwrap())).collect();
    let _kept = Kept::default();
    // In this order each follows each, also itself.
    let order = (0..16).flat_map(|n| (n..16).flat_map(move |m| [n, m])).chain([0]);
    let mut before = 0;
    for n in order {
        assert_eq!(bits(&alone(&scenes[n]).unwrap()), expected[n], "{n} after {before}");
        before = n;
    }
}

#[test]
fn a_step_that_fails_is_an_error_of_its_scene() {
    // A step over which numbers are too far apart for the motion.
    let text = "stop = 1e30\ncommunicationStep = 1e30\noutputs = [\"contact.force\"]\n\
                parameters.effects.excitation = \"Sine\"";
    let failing: SceneFile = text.parse().unwrap();
    let rows = run_many(&[failing, scene("at-rest.toml", &[])], NonZero::<usize>::MIN, |_| ());
    assert!(matches!(rows[0], Err(RunError::Step(_))), "{:?}", rows[0]);
    assert!(rows[1].is_ok());
}

#[test]
fn none_are_no_rows() {
    assert!(run_many(&[], NonZero::<usize>::MIN, |_| panic!("nothing was done")).is_empty());
}
