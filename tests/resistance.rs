//! Resistance and temperature of a contact against published values and closed forms.

use relay_contact::reference::{ElectricalContact, Law, reduced_modulus};
use relay_contact::scene::Scene;
use relay_contact::variables::{ContactLawKind, ResistanceKind};
use testing::close;

fn scene(kind: ResistanceKind) -> Scene {
    let mut scene = Scene::default();
    scene.effects.resistance = kind;
    scene
}

fn of(scene: &Scene) -> Option<ElectricalContact> {
    let law = match scene.effects.contact_law {
        ContactLawKind::Rough => Law::rough(&scene.contact),
        _ => Law::hertz(&scene.contact),
    };
    ElectricalContact::new(scene, &law)
}

#[test]
fn published_values() {
    let electrical = of(&scene(ResistanceKind::PowerLaw)).unwrap();
    // The power law at the ends of the published waveform, 34.25 and 63.9 mOhm.
    assert!((1.0 / electrical.conductance(0.200_149) - 34.252e-3).abs() < 1e-6);
    assert!((1.0 / electrical.conductance(0.103_905) - 63.90e-3).abs() < 1e-4);
    let holm = of(&scene(ResistanceKind::Holm)).unwrap();
    // (2.2e-8 / 2) sqrt(pi 0.785e9 / 0.152) by hand.
    assert!((1.0 / holm.conductance(0.152) - 1.401e-3).abs() < 1e-6);
    assert!(of(&scene(ResistanceKind::None)).is_none());
}

#[test]
fn stiffness_gives_resistance() {
    let mut scene = scene(ResistanceKind::Barber);
    scene.effects.contact_law = ContactLawKind::Rough;
    let rough = of(&scene).unwrap();
    // Rho E* / k_r at F_r, and as k there. Spheres: `tests/python/test_effects_outputs.py`.
    let at_given = scene.resistance.resistivity * reduced_modulus(&scene.contact) / 4.37e4;
    for (force, factor) in [(0.152, 1.0), (0.304, 2_f64.powf(0.54)), (0.01, (0.01_f64 / 0.152).powf(0.54))] {
        let found = 1.0 / rough.conductance(force);
        assert!((found * factor / at_given - 1.0).abs() < 1e-9, "{found} at {force} N");
    }
    // Linear: one resistance while closed, so that any force is enough, or none.
    scene.contact.stiffness_exponent = 0.0;
    let linear = of(&scene).unwrap();
    assert_eq!(linear.conductance(1e-9), linear.conductance(1.0));
    assert_eq!(linear.force_at(60.0), f64::MIN_POSITIVE);
    assert_eq!(linear.force_at(1e-3), f64::INFINITY);
}

#[test]
fn the_force_at_a_threshold_is_where_the_resistance_passes_it() {
    for kind in [ResistanceKind::PowerLaw, ResistanceKind::Holm, ResistanceKind::Barber] {
        for film in [0.0, 0.5] {
            let mut scene = scene(kind);
            scene.resistance.film = film;
            let electrical = of(&scene).unwrap();
            for threshold in [1.0, 60.0, 1e6, 9e8] {
                let force = electrical.force_at(threshold);
                let found = 1.0 / electrical.conductance(force);
                close(format_args!("{kind:?} {film} {threshold}"), found, threshold, 1e-9);
            }
            assert_eq!(electrical.force_at(1e9), 0.0);
            assert_eq!(electrical.force_at(2e9), 0.0);
        }
    }
    // 1e-380 N.
    let mut level = scene(ResistanceKind::PowerLaw);
    level.resistance.exponent = 0.01;
    assert_eq!(of(&level).unwrap().force_at(60.0), f64::MIN_POSITIVE);
    let mut filmed = scene(ResistanceKind::PowerLaw);
    filmed.resistance.film = 100.0;
    assert_eq!(of(&filmed).unwrap().force_at(60.0), f64::INFINITY);
}

/// The temperature itself: `tests/python/test_effects_outputs.py`.
#[test]
fn derivatives_of_the_temperature_are_its_slopes_and_zero_where_the_voltage_is_limited() {
    let scene = scene(ResistanceKind::PowerLaw);
    let electrical = of(&scene).unwrap();
    let mut weak = scene.clone();
    weak.contact.open_voltage = 0.1;
    assert_eq!(electrical.temperature_slopes(&weak, 0.15, 1e3), (0.0, 0.0));
    assert_eq!(electrical.temperature_slopes(&scene, 0.15, 1e3), (0.0, 0.0));
    let (force, current, step) = (0.15, -3.0, 1e-6);
    let at = |force, current| electrical.temperature(&scene, force, current);
    let slopes = electrical.temperature_slopes(&scene, force, current);
    let by_force = at(force + step, current) - at(force - step, current);
    close("K/N", by_force / (2.0 * step), slopes.0, 1e-6);
    // It grows with the magnitude of the current.
    let by_current = at(force, current - step) - at(force, current + step);
    close("K/A", by_current / (2.0 * step), slopes.1, 1e-6);
}
