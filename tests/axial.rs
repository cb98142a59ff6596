//! The axial force that follows the deflection at all times: its rest. Its preload and the force under vibration are
//! compared with another solution in `tests/python/test_effects_mechanics.py` and `random_relays.py`.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ExcitationKind, RealOutput};
use testing::scenes::{accelerated, at_rest, force_scale};

/// A spring bent by half its length against a soft contact: the axial force is 0.4 of the buckling load and moves with
/// the tip.
fn bent() -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::FromDeflection;
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.modes = 4;
    scene.contact.overtravel = 8e-3;
    scene.contact.curvature_radius = 1e-4;
    scene.contact.moving.youngs_modulus = 1e8;
    scene.contact.fixed.youngs_modulus = 1e8;
    scene.contact.damping = 8e-5;
    scene.excitation.frequency = 700.0;
    scene.excitation.amplitude = 2e3;
    scene
}

#[test]
fn rest_is_found_and_kept() {
    let mut scene = bent();
    scene.effects.excitation = ExcitationKind::None;
    scene.solver.modes = 0;
    // Untouched.
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    simulation.step(&Inputs::default(), 0.0, 3600.0).unwrap();
    let preload = at_rest(&scene, RealOutput::PreloadForce);
    assert_eq!(simulation.real(RealOutput::ContactForce), preload);
    // Under an acceleration that is put on and stays: the equilibrium of the axial force that belongs to it.
    for (overtravel, acceleration) in [(2e-3, 100.0), (8e-3, 100.0)] {
        scene.contact.overtravel = overtravel;
        let inputs = accelerated(acceleration, 0.0);
        let mut simulation = Simulation::new(&scene, &inputs, 0.0).unwrap();
        simulation.step(&inputs, 0.0, 10.0).unwrap();
        let force = simulation.real(RealOutput::ContactForce);
        let mut heavy = scene.clone();
        heavy.environment.gravity = acceleration;
        let equilibrium = at_rest(&heavy, RealOutput::PreloadForce);
        assert!((force - equilibrium).abs() < 1e-6 * force_scale(&heavy), "{force}");
    }
}

#[test]
fn violence_ends_in_a_motion_or_in_an_error_with_its_time() {
    for (length, thickness, amplitude) in
        [(12.5e-3, 1.19e-4, 1e3), (12.5e-3, 1.19e-4, 1e5), (12.5e-3, 1e-5, 1e6), (15.5e-3, 1e-4, 1e6)]
    {
        for damping in [0.0, 8e-5] {
            let mut scene = bent();
            scene.solver.modes = 0;
            scene.solver.tolerance = 1e-4;
            scene.beam.length = length;
            scene.beam.thickness = thickness;
            scene.beam.stiffness_damping = damping;
            scene.contact.damping = damping;
            scene.contact.overtravel = 10e-3;
            scene.excitation.amplitude = amplitude;
            let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
            let result = simulation.step(&Inputs::default(), 0.0, 3e-3);
            let force = simulation.real(RealOutput::ContactForce);
            let case = format!("{length} m, {thickness} m, {amplitude} m/s2, {damping} s");
            assert!(force.is_finite() && force >= 0.0, "{case}: {force:e} N");
            if let Err(error) = result {
                assert!((0.0..3e-3).contains(&error.time), "{case}: {error}");
            }
        }
    }
}
