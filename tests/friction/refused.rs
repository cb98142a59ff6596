//! What friction cannot be combined with, and what is said of it.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::{GivenMode, Modes, Shape};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind};
use testing::springs::{mode, spring_file};

use super::rubbing;

fn said(change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = rubbing(Scene::default());
    change(&mut scene);
    match Simulation::new(&scene, &Inputs::default(), 0.0) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn friction_with_linear_laws_a_second_contact_or_without_height_is_refused() {
    assert_eq!(said(|_| ()), "");
    for (law, name) in [
        (ContactLawKind::Linearised, "effects.contactLaw = Linearised"),
        (ContactLawKind::Bonded, "effects.contactLaw = Bonded"),
    ] {
        let text = said(|scene| scene.effects.contact_law = law);
        assert!(
            text.contains(name) && text.contains("effects.friction = Coulomb"),
            "{text}"
        );
    }
    let text = said(|scene| scene.effects.second_contact = true);
    assert!(text.contains("effects.secondContact = true"), "{text}");
    let text = said(|scene| scene.effects.axial_force = AxialForceKind::FromDeflection);
    assert!(text.contains("effects.axialForce = FromDeflection"), "{text}");
}

#[test]
fn modes_need_their_rotation() {
    let modes = |rotation| Modes {
        compliance: 1e-3,
        parallel_compliance: None,
        modes: vec![GivenMode {
            rotation,
            ..mode(1000.0, 150.0, 0.005)
        }],
    };
    let with = |rotation| said(|scene| scene.spring = spring_file("own.toml", Shape::Modes(modes(rotation))));
    assert_eq!(with(Some(1e4)), "");
    let text = with(None);
    assert!(text.contains("own.toml") && text.contains("rotation"), "{text}");
}

/// Two thirds of the length: there the moment of the friction force bends the spring back as far as the contact force bends
/// it.
#[test]
fn a_contact_that_jams_is_refused() {
    let text = said(|scene| (scene.friction.coefficient, scene.tip.contact_height) = (2.0, 0.01));
    assert!(
        text.contains("friction.coefficient = 2 ") && text.contains("0.01033"),
        "{text}"
    );
    let started = said(|scene| {
        (scene.friction.coefficient, scene.tip.contact_height) = (2.0, 0.01);
        scene.friction.initial = 0.0;
    });
    assert_eq!(started, "");
}
