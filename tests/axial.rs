//! The axial force that follows the deflection at all times, under vibrations that bend the spring far. Where it rests: `equilibrium.rs`.
//! Its preload and the force under vibration are compared with another solution in `tests/python/test_effects_mechanics.py` and
//! `random_relays.py`.

use relay_contact::inputs::Inputs;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::scenes::shaken;

use crate::equilibrium::bent;

#[test]
fn modes_far_apart_have_a_lowest_frequency() {
    // The search for it never ended.
    let mut scene = shaken(0.0, 700.0);
    bent(&mut scene);
    scene.beam.width = 1e-4;
    scene.tip.rotary_inertia = 6.120_750_139_409_706e-5;
    scene.solver.modes = 92;
    let simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    assert!(simulation.real(RealOutput::PreloadFrequency) > 0.0);
}

#[test]
fn violence_ends_in_a_motion_or_in_an_error_with_its_time() {
    for (length, thickness, amplitude) in
        [(12.5e-3, 1.19e-4, 1e3), (12.5e-3, 1.19e-4, 1e5), (12.5e-3, 1e-5, 1e6), (15.5e-3, 1e-4, 1e6)]
    {
        for damping in [0.0, 8e-5] {
            let mut scene = shaken(amplitude, 700.0);
            bent(&mut scene);
            scene.solver.tolerance = 1e-4;
            scene.beam.length = length;
            scene.beam.thickness = thickness;
            scene.beam.stiffness_damping = damping;
            scene.contact.damping = damping;
            scene.contact.overtravel = 10e-3;
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
