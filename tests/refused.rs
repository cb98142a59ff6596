//! Parameters and inputs that do not go together: each combination is refused before anything is simulated, with the names, the
//! values and what is allowed.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::GivenMode;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{
    AxialForceKind, ContactLawKind, ExcitationKind, FrictionKind, PusherKind, ResistanceKind,
};
use testing::scenes::press;
use testing::springs::{mode, of_modes, spring_file, uniform_spring};

/// Changes of a scene, and parts of what is said of it; nothing is said where it can be simulated.
type Case = (fn(&mut Scene, &mut Inputs), &'static [&'static str]);

/// What cases are about, the change of a scene that they all begin with, and the cases.
type Group = (&'static str, fn(&mut Scene), &'static [Case]);

fn linearised(scene: &mut Scene) {
    scene.effects.contact_law = ContactLawKind::Linearised;
}

fn bonded(scene: &mut Scene) {
    scene.effects.contact_law = ContactLawKind::Bonded;
}

fn rubbing(scene: &mut Scene) {
    scene.effects.friction = FrictionKind::Coulomb;
}

fn following(scene: &mut Scene) {
    scene.effects.axial_force = AxialForceKind::FromDeflection;
}

/// So much friction, at a height of 10 mm.
fn gripping(scene: &mut Scene, coefficient: f64, initial: f64) {
    (scene.friction.coefficient, scene.friction.initial) = (coefficient, initial);
    scene.tip.contact_height = 0.01;
}

/// A fixed contact on the moving spring at half its thickness.
fn on_soft_spring(scene: &mut Scene) {
    scene.fixed_spring = uniform_spring(scene, 1.0, 0.5);
}

/// A spring given by a mode.
fn with_mode(scene: &mut Scene, rotation: Option<f64>) {
    let given = GivenMode { rotation, ..mode(1000.0, 150.0, 0.005) };
    scene.effects.axial_force = AxialForceKind::None;
    scene.spring = spring_file("own.toml", of_modes(1e-3, [given]));
}

/// A fixed contact on such a spring.
fn fixed_mode(scene: &mut Scene, rotation: Option<f64>) {
    with_mode(scene, rotation);
    scene.fixed_spring = scene.spring.take();
}

#[rustfmt::skip]
const GROUPS: [Group; 10] = [
    ("friction", rubbing, &[
        (|_, _| (), &[]),
        (|scene, _| linearised(scene), &["effects.contactLaw = Linearised", "effects.friction = Coulomb"]),
        (|scene, _| bonded(scene), &["effects.contactLaw = Bonded", "effects.friction = Coulomb"]),
        (|scene, _| scene.effects.second_contact = true, &["effects.secondContact = true"]),
        (|scene, _| following(scene), &["effects.axialForce = FromDeflection"]),
        (|scene, _| with_mode(scene, Some(1e4)), &[]),
        (|scene, _| with_mode(scene, None), &["own.toml", "rotation"]),
        (|scene, _| fixed_mode(scene, Some(1e4)), &[]),
        (|scene, _| fixed_mode(scene, None), &["fixed.file = own.toml", "rotation"]),
        // At two thirds of the length the moment of the friction force bends the spring back as far as the contact force bends it.
        (|scene, _| gripping(scene, 2.0, -1.0), &["friction.coefficient = 2 ", "0.01033"]),
        (|scene, _| gripping(scene, 2.0, 0.0), &[]),
        // Friction the other way draws a fixed contact after it whose spring is 8 times softer: jammed from (c + 8 c) / (8 m - m) on,
        // c / m two thirds of the length, 13.3 mm.
        (|scene, _| { gripping(scene, 1.3, 1.0); on_soft_spring(scene); }, &[]),
        (|scene, _| { gripping(scene, 1.4, 1.0); on_soft_spring(scene); }, &["friction.coefficient = 1.4 ", "0.01328", "initial = 1"]),
        (|scene, _| { gripping(scene, 1.1, -1.0); on_soft_spring(scene); }, &["friction.coefficient = 1.1 ", "0.01033", "initial = -1"]),
    ]),
    ("second contact", |scene| scene.effects.second_contact = true, &[
        (|_, _| (), &[]),
        (|scene, _| linearised(scene), &["effects.contactLaw", "Hertz"]),
        (|scene, _| bonded(scene), &["effects.contactLaw", "Hertz"]),
        // 64 nm is the indentation of the first at the preload.
        (|scene, _| scene.second.gap = 5e-8, &["second.gap = 5e-8 m", "more than 6.4"]),
        (|scene, inputs| inputs.second_displacement = scene.second.gap, &["second.displacement = 0.0003 m"]),
        // Into the spring, though not to the first.
        (|scene, inputs| { scene.contact.overtravel = -1e-4; inputs.second_displacement = 3.5e-4 }, &["second.displacement = 0.00035 m"]),
        // A backstop: the first contact is out of reach.
        (|scene, _| scene.contact.overtravel = -0.01, &[]),
    ]),
    ("parallel contact", |scene| scene.effects.parallel_contact = true, &[
        (|_, _| (), &[]),
        (|scene, _| linearised(scene), &["effects.parallelContact"]),
        (|scene, _| bonded(scene), &["effects.parallelContact"]),
        (|scene, _| rubbing(scene), &["effects.parallelContact"]),
        (|scene, _| following(scene), &["effects.parallelContact"]),
        (|scene, _| with_mode(scene, None), &["own.toml", "parallel"]),
    ]),
    ("pusher", |scene| scene.effects.pusher = PusherKind::Prescribed, &[
        (|_, _| (), &[]),
        (|scene, _| following(scene), &["effects.pusher = Prescribed"]),
        (|scene, _| scene.pusher.position = 0.02, &["pusher.position = 0.02 m", "0.0155 m"]),
    ]),
    ("armature", |scene| scene.effects.pusher = PusherKind::Armature, &[
        (|_, _| (), &[]),
        (|scene, _| scene.armature.core_position = scene.armature.rest_position, &["armature.corePosition = -0.0003 m"]),
    ]),
    ("fixed spring", |scene| scene.fixed_spring = uniform_spring(scene, 1.0, 1.0), &[
        (|_, _| (), &[]),
        (|scene, _| following(scene), &["effects.axialForce = FromDeflection: not allowed with fixed.file"]),
    ]),
    ("axial force", |scene| scene.effects.axial_force = AxialForceKind::Prescribed, &[
        (|scene, _| press(scene, 0.999_999), &[]),
        (|scene, _| press(scene, 1.000_001), &["beam.axialForce = ", "buckles", "less than 9.69344"]),
        (|scene, _| press(scene, 100.0), &["beam.axialForce = ", "buckles", "less than 9.69344"]),
        (|scene, _| scene.beam.axial_force = 1e6, &["beam.axialForce = 1000000 N", "buckles", "less than 9.69344"]),
        // A buckled spring gives way at any friction: that is no jam.
        (|scene, _| { rubbing(scene); press(scene, 100.0); }, &["beam.axialForce = ", "buckles", "less than 9.69344"]),
    ]),
    ("spring of modes", |scene| with_mode(scene, None), &[
        (|_, _| (), &[]),
        (|scene, _| scene.effects.axial_force = AxialForceKind::FromPreload, &["effects.axialForce = FromPreload", "own.toml"]),
        (|scene, _| following(scene), &["effects.axialForce = FromDeflection", "own.toml"]),
        (|scene, _| scene.effects.axial_force = AxialForceKind::Prescribed, &["effects.axialForce = Prescribed", "own.toml"]),
    ]),
    ("random acceleration", |scene| scene.effects.excitation = ExcitationKind::Random, &[
        (|scene, _| scene.excitation.end_frequency = 1001.0, &[]),
        (|scene, _| scene.excitation.end_frequency = 1000.0, &["frequency = 1000 Hz", "endFrequency = 1000 Hz", "above"]),
        (|scene, _| scene.excitation.end_frequency = 999.0, &["frequency = 1000 Hz", "endFrequency = 999 Hz", "above"]),
    ]),
    ("no resistance", |scene| scene.effects.resistance = ResistanceKind::None, &[
        (|scene, _| scene.effects.chatter = false, &[]),
        (|_, _| (), &["effects.chatter = true", "effects.resistance = None"]),
    ]),
];

#[test]
fn what_does_not_go_together_is_refused_with_names_and_values() {
    for (name, base, cases) in GROUPS {
        for (number, (change, parts)) in cases.iter().enumerate() {
            let (mut scene, mut inputs) = (Scene::default(), Inputs::default());
            base(&mut scene);
            change(&mut scene, &mut inputs);
            let said = Simulation::new(&scene, &inputs, 0.0).map_or_else(|error| error.to_string(), |_| String::new());
            assert_eq!(said.is_empty(), parts.is_empty(), "{name}, case {number}: {said}");
            for part in *parts {
                assert!(said.contains(part), "{name}, case {number}: {part:?} missing: {said}");
            }
        }
    }
}
