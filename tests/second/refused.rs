//! Second contacts that cannot be, with what is said of them.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, RealOutput};

fn said(change: impl FnOnce(&mut Scene, &mut Inputs)) -> String {
    let (mut scene, mut inputs) = (Scene::default(), Inputs::default());
    scene.effects.second_contact = true;
    change(&mut scene, &mut inputs);
    match Simulation::new(&scene, &inputs, 0.0) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_second_contact_with_linear_laws_or_that_touches_at_rest_is_refused() {
    assert_eq!(said(|_, _| ()), "");
    for law in [ContactLawKind::Linearised, ContactLawKind::Bonded] {
        let text = said(|scene, _| scene.effects.contact_law = law);
        assert!(text.contains("effects.contactLaw") && text.contains("Hertz"), "{text}");
    }
    // 64 nm is the indentation of the first at the preload.
    let text = said(|scene, _| scene.second.gap = 5e-8);
    assert!(
        text.contains("second.gap = 5e-8 m") && text.contains("more than 6.4"),
        "{text}"
    );
    let text = said(|scene, inputs| inputs.second_displacement = scene.second.gap);
    assert!(text.contains("second.displacement = 0.0003 m"), "{text}");
    // A backstop: the first contact is out of reach.
    assert_eq!(said(|scene, _| scene.contact.overtravel = -0.01), "");
}

/// The fixed contacts may approach each other, but not meet.
#[test]
fn fixed_contacts_do_not_meet() {
    let mut scene = Scene::default();
    scene.effects.second_contact = true;
    scene.contact.overtravel = -1e-4;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let inputs = |second_displacement| Inputs {
        second_displacement,
        ..Inputs::default()
    };
    // Into the spring, to within 10 um of the first, and held there.
    for (time, displacement) in [(0.0, 3.9e-4), (1e-2, 3.9e-4)] {
        simulation.step(&inputs(displacement), time, 1e-2).unwrap();
    }
    assert!(simulation.real(RealOutput::SecondForce) > 0.0);
    let error = simulation.step(&inputs(4.1e-4), 2e-2, 1e-3).unwrap_err().to_string();
    assert!(
        error.contains("second.displacement = 0.00041 m") && error.contains("less than 0.00039999"),
        "{error}"
    );
    // The step that failed has changed nothing.
    simulation.step(&inputs(3.9e-4), 2e-2, 1e-3).unwrap();
}
