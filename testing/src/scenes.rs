//! Scenes for tests, with reference values computed without the library.

use std::f64::consts::PI;
use std::fs;
use std::path::PathBuf;

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind, RealOutput};

use crate::worst;

/// Every contact law.
pub const LAWS: [ContactLawKind; 4] =
    [ContactLawKind::Hertz, ContactLawKind::Rough, ContactLawKind::Linearised, ContactLawKind::Bonded];

/// The files of `scenes/`, for tests run in the top folder.
pub fn files() -> Vec<PathBuf> {
    let entries = fs::read_dir("scenes").expect("the folder scenes");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths
}

/// The specimen under a sine of this amplitude (m/s2) and frequency (Hz).
pub fn shaken(amplitude: f64, frequency: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = amplitude;
    scene.excitation.frequency = frequency;
    scene
}

/// The start values without damping of beam and contact.
pub fn undamped() -> Scene {
    let mut scene = Scene::default();
    scene.beam.stiffness_damping = 0.0;
    scene.contact.damping = 0.0;
    scene
}

/// An output of the scene at rest in its preload.
pub fn at_rest(scene: &Scene, output: RealOutput) -> f64 {
    let simulation = Simulation::new(scene, &Inputs::default(), 0.0).expect("a scene that can be simulated");
    simulation.real(output)
}

/// Bending stiffness of the uniform spring, `E I`, N m2.
pub fn bending_stiffness(scene: &Scene) -> f64 {
    let beam = &scene.beam;
    beam.youngs_modulus * beam.width * beam.thickness.powi(3) / 12.0
}

/// Stiffness of the tip against a force there, `3 E I / L^3`, N/m.
pub fn tip_stiffness(scene: &Scene) -> f64 {
    3.0 * bending_stiffness(scene) / scene.beam.length.powi(3)
}

/// Presses the spring with a share of its buckling load as a column that is clamped at one end, `pi^2 E I / (4 L^2)`.
pub fn press(scene: &mut Scene, share: f64) {
    scene.effects.axial_force = AxialForceKind::Prescribed;
    scene.beam.axial_force = share * (PI / (2.0 * scene.beam.length)).powi(2) * bending_stiffness(scene);
}

/// What `solver.tolerance` is relative to, N: the preload force, or, if larger, that of the spring bent by the
/// overtravel (at least 0.1 mm).
pub fn force_scale(scene: &Scene) -> f64 {
    let bent = tip_stiffness(scene) * scene.contact.overtravel.abs().max(1e-4);
    at_rest(scene, RealOutput::PreloadForce).max(bent)
}

/// Effective mass of the contact force under slow base acceleration, kg: that of a propped cantilever with the rivet
/// at the nearly rigid prop.
pub fn propped_mass(scene: &Scene) -> f64 {
    let beam = &scene.beam;
    0.375 * beam.density * beam.width * beam.thickness * beam.length + scene.tip.mass
}

/// Inputs of a base acceleration (m/s2) and its rate (m/s3) alone.
pub fn accelerated(base_acceleration: f64, base_acceleration_rate: f64) -> Inputs {
    Inputs { base_acceleration, base_acceleration_rate, ..Inputs::default() }
}

/// Inputs of a displacement of the fixed contact (m) and its rate (m/s) alone.
pub fn supported(support_displacement: f64, support_displacement_rate: f64) -> Inputs {
    Inputs { support_displacement, support_displacement_rate, ..Inputs::default() }
}

/// Outputs after each of `count` communication steps of `size` seconds without inputs, and the simulation.
pub fn course<const N: usize>(
    scene: &Scene,
    size: f64,
    count: u32,
    outputs: [RealOutput; N],
) -> (Vec<[f64; N]>, Simulation) {
    course_from(scene, 0.0, size, count, outputs)
}

/// The same after a single step to `start`, s.
pub fn course_from<const N: usize>(
    scene: &Scene,
    start: f64,
    size: f64,
    count: u32,
    outputs: [RealOutput; N],
) -> (Vec<[f64; N]>, Simulation) {
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(scene, &inputs, 0.0).expect("a scene that can be simulated");
    if start > 0.0 {
        simulation.step(&inputs, 0.0, start).expect("a step");
    }
    let rows = (0..count).map(|k| {
        simulation.step(&inputs, start + f64::from(k) * size, size).expect("a step");
        outputs.map(|output| simulation.real(output))
    });
    (rows.collect(), simulation)
}

/// The contact force after each of them.
pub fn forces(scene: &Scene, size: f64, count: u32) -> Vec<f64> {
    let (rows, _) = course(scene, size, count, [RealOutput::ContactForce]);
    rows.into_iter().flatten().collect()
}

/// Largest difference of two time histories at the same times; not a number where one is.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "values");
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_or_missing_is_no_small_difference() {
        assert_eq!(largest_difference(&[1.0, 2.0, 5.0], &[1.0, 4.0, 4.5]), 2.0);
        assert!(largest_difference(&[1.0, f64::NAN, 1.0], &[1.0; 3]).is_nan());
        assert!(std::panic::catch_unwind(|| largest_difference(&[], &[1.0])).is_err());
    }
}
