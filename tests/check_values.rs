//! Published check values of the specimen at rest: two independent implementations agree on every digit given.

use std::f64::consts::TAU;

use relay_contact::reference::{self, Section, Space};
use relay_contact::scene::Scene;
use relay_contact::variables::{AxialForceKind, RealOutput};
use testing::near;
use testing::scenes::at_rest;

/// The specimen without axial force.
fn specimen() -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    scene
}

/// All digits given, the last one rounded.
fn digits(value: f64, published: f64, last_digit: f64) {
    near("published", value, published, 0.5001 * last_digit);
}

#[test]
fn static_force_indentation_and_stiffness() {
    let preload = |output| at_rest(&specimen(), output);
    digits(preload(RealOutput::PreloadForce), 0.152_026_1, 1e-7);
    digits(preload(RealOutput::PreloadIndentation), 64.418e-9, 1e-12);
    digits(preload(RealOutput::PreloadContactStiffness), 3.539_968e6, 1.0);
}

#[test]
fn natural_frequencies_of_the_continuum_and_of_galerkin() {
    let scene = specimen();
    let stiffness = at_rest(&scene, RealOutput::PreloadContactStiffness);
    let section = Section::new(&scene);
    let exact = reference::frequencies(&section, 0.0, stiffness, 3);
    let galerkin = Space::new(20).modes(&section, 0.0, stiffness).unwrap();
    for ((exact, galerkin), published) in exact.iter().zip(&galerkin).zip([1354.5397, 4378.2322, 9096.4319]) {
        digits(exact / TAU, published, 1e-4);
        digits(galerkin.omega_squared.sqrt() / TAU, published, 1e-4);
    }
}

#[test]
fn axial_force_of_the_preload_deflection() {
    let mut scene = specimen();
    scene.effects.axial_force = AxialForceKind::FromPreload;
    digits(at_rest(&scene, RealOutput::PreloadForce), 0.151_980_6, 1e-7);
    digits(at_rest(&scene, RealOutput::PreloadFrequency), 1354.5151, 1e-4);
}
