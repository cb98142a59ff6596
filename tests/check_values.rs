//! Published check values of the specimen: two independent implementations agree on every digit given.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::reference::{self, Model, Section, Space};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ExcitationKind, RealOutput};
use testing::near;
use testing::scenes::{at_rest, course_from};

/// The specimen without axial force, at a tolerance of 1e-8.
fn specimen() -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    scene.solver.tolerance = 1e-8;
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

#[test]
fn linear_force_amplitude() {
    let model = Model::new(&specimen(), 0.0).unwrap();
    for (frequency, published) in [(500.0, 3.6295e-2), (1000.0, 4.8122e-2)] {
        digits(98.0 * reference::response(&model, TAU * frequency).force.norm(), published, 1e-6);
    }
}

#[test]
fn nonlinear_periodic_state_at_1_khz() {
    let mut scene = specimen();
    scene.effects.excitation = ExcitationKind::Sine;
    let (rows, _) = course_from(&scene, 39e-3, 1e-6, 1000, [RealOutput::ContactForce]);
    let forces = rows.into_iter().flatten();
    digits(forces.clone().fold(f64::INFINITY, f64::min), 0.103_905, 1e-6);
    digits(forces.fold(0.0, f64::max), 0.200_149, 1e-6);
}

#[test]
fn opening_and_closing_at_41_g() {
    let mut scene = specimen();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = 400.0;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    simulation.step(&Inputs::default(), 0.0, 1.2e-3).unwrap();
    digits(simulation.real(RealOutput::ContactLastOpening), 708.827_593e-6, 1e-12);
    digits(simulation.real(RealOutput::ContactLastClosing), 1_089.427_605e-6, 1e-12);
}
