//! The kernel of a step in its two compilations: the same results but for rounding.

use relay_contact::inputs::Inputs;
use relay_contact::integrator::motion::Course;
use relay_contact::integrator::workspace::Workspace;
use relay_contact::math::simd::Machine;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::ExcitationKind;

/// Contact force after each communication step, N.
fn forces(scene: &Scene, machine: Machine, size: f64, count: u32) -> Vec<f64> {
    let mut model = Model::new(scene, 0.0).unwrap();
    model.machine = machine;
    let mut course = Course::new(model.initial_state(0.0));
    let mut workspace = Workspace::new(&model);
    (0..count)
        .map(|k| {
            let time = f64::from(k) * size;
            model
                .step(&mut course, &mut workspace, &Inputs::default(), time, size)
                .unwrap();
            course.tip(&model).force
        })
        .collect()
}

#[test]
fn both_compilations_agree_within_the_tolerance() {
    for (amplitude, tolerance) in [(98.0, 1e-4), (98.0, 1e-9), (400.0, 1e-4), (400.0, 1e-6)] {
        let mut scene = Scene::default();
        scene.effects.excitation = ExcitationKind::Sine;
        scene.excitation.amplitude = amplitude;
        scene.solver.tolerance = tolerance;
        let scale = Model::new(&scene, 0.0).unwrap().force_scale;
        for (size, count) in [(1e-6, 2000), (7e-5, 40), (1e-3, 3)] {
            let portable = forces(&scene, Machine::Portable, size, count);
            let found = forces(&scene, Machine::detect(), size, count);
            for (k, (a, b)) in portable.iter().zip(&found).enumerate() {
                // Each of the two is within the tolerance of the exact force.
                assert!(
                    (a - b).abs() < 2.0 * tolerance * scale,
                    "{amplitude} m/s2, tolerance {tolerance}, step {size}, number {k}: {a} {b}"
                );
            }
        }
    }
}
