//! The axial force that follows the deflection at all times, against an integration of the same equations that shares no
//! code with it ([`reference`]).

#![allow(clippy::unwrap_used)]

mod reference;

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind, RealOutput};

use testing::scenes::{at_rest, force_scale};

use crate::reference::Reference;

/// Functions of the deflection, and modes of the scene: both span the polynomials of this many degrees from 2 on.
const FUNCTIONS: usize = 4;

/// A spring bent by half its length against a soft contact: the axial force is 0.4 of the buckling load and moves with
/// the tip.
fn bent() -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::FromDeflection;
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.modes = i32::try_from(FUNCTIONS).unwrap();
    scene.contact.overtravel = 8e-3;
    scene.contact.curvature_radius = 1e-4;
    scene.contact.moving.youngs_modulus = 1e8;
    scene.contact.fixed.youngs_modulus = 1e8;
    scene.contact.damping = 8e-5;
    scene.excitation.frequency = 700.0;
    scene.excitation.amplitude = 2e3;
    scene
}

/// Largest difference of the force from the reference at the instants of its trace, over the force that the tolerance
/// is relative to.
fn error(scene: &Scene, trace: &[(f64, f64)]) -> f64 {
    let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
    let scale = force_scale(scene);
    let mut time = 0.0;
    trace.iter().fold(0.0, |worst: f64, (at, force)| {
        simulation.step(&Inputs::default(), time, at - time).unwrap();
        time = *at;
        worst.max((simulation.real(RealOutput::ContactForce) - force).abs() / scale)
    })
}

fn trace(scene: &Scene, count: u32, size: f64, steps: u32) -> Vec<(f64, f64)> {
    let mut reference = Reference::new(scene);
    (1..=count)
        .map(|k| {
            reference.run_to(size * f64::from(k), steps);
            (reference.time, reference.force())
        })
        .collect()
}

fn agrees(mut scene: Scene, opens: bool, count: u32, steps: u32) {
    let size = 5e-5;
    let (exact, coarse) = (trace(&scene, count, size, 2 * steps), trace(&scene, count, size, steps));
    let scale = force_scale(&scene);
    let of_reference = exact
        .iter()
        .zip(&coarse)
        .fold(0.0_f64, |worst, (a, b)| worst.max((a.1 - b.1).abs() / scale));
    let lowest = exact.iter().fold(f64::INFINITY, |low, (_, force)| low.min(*force));
    assert_eq!(lowest == 0.0, opens, "lowest force {lowest} N");
    // Without it the force is another one altogether.
    let mut constant = scene.clone();
    constant.effects.axial_force = AxialForceKind::FromPreload;
    let effect = error(&constant, &exact);
    println!("opens: {opens}; of the reference {of_reference:.1e}; effect {effect:.1e}");
    assert!(effect > 1e-3, "{effect}");
    assert!(of_reference < 1e-8, "{of_reference}");
    for exponent in 3..=8 {
        let tolerance = 10f64.powi(-exponent);
        scene.solver.tolerance = tolerance;
        let error = error(&scene, &exact);
        println!("tolerance {tolerance:.0e}: error {error:.1e}");
        assert!(error <= tolerance + of_reference, "{error:e} at {tolerance:e}");
    }
}

#[test]
fn force_of_a_bent_spring_that_stays_closed() {
    agrees(bent(), false, 200, 200);
}

#[test]
fn force_of_a_bent_spring_that_chatters() {
    let mut scene = bent();
    scene.excitation.amplitude = 8e3;
    agrees(scene, true, 80, 4000);
}

#[test]
fn force_of_a_bent_spring_under_gravity() {
    let mut scene = bent();
    // As much as a tenth of the contact force.
    scene.environment.gravity = 1e3;
    agrees(scene, false, 100, 200);
}

#[test]
fn preload_is_that_of_the_constant_force() {
    let preload = |kind| {
        let mut scene = Scene::default();
        scene.effects.axial_force = kind;
        [
            RealOutput::PreloadForce,
            RealOutput::PreloadIndentation,
            RealOutput::PreloadContactStiffness,
            RealOutput::PreloadAxialForce,
            RealOutput::TipDisplacement,
        ]
        .map(|output| at_rest(&scene, output))
    };
    let (constant, following) = (
        preload(AxialForceKind::FromPreload),
        preload(AxialForceKind::FromDeflection),
    );
    assert_eq!(constant, following);
    // Of the published specimen, all digits given.
    assert!((following[0] - 0.151_980_6).abs() <= 0.5001e-7, "{}", following[0]);
}

/// Angular frequencies of two undamped vibrations that make up the samples, `size` seconds apart: the samples obey
/// `x[n+2] + x[n-2] + b (x[n+1] + x[n-1]) + c x[n] = 0`.
fn two_frequencies(samples: &[f64], size: f64) -> [f64; 2] {
    let (mut a, mut right) = (DMatrix::zeros(2, 2), DVector::zeros(2));
    for x in samples.windows(5) {
        let row = DVector::from_vec(vec![x[1] + x[3], x[2]]);
        a += &row * row.transpose();
        right -= row * (x[0] + x[4]);
    }
    let solution = a.lu().solve(&right).unwrap();
    // With z = 2 cos(omega size): z^2 + b z + c - 2 = 0.
    let (half, root) = (
        -solution[0] / 2.0,
        (solution[0].powi(2) / 4.0 - solution[1] + 2.0).sqrt(),
    );
    [half + root, half - root].map(|z| (z / 2.0).acos() / size)
}

#[test]
fn small_vibration_has_the_frequencies_of_the_tangent() {
    let mut scene = bent();
    scene.effects.excitation = ExcitationKind::None;
    scene.effects.contact_law = ContactLawKind::Linearised;
    scene.beam.stiffness_damping = 0.0;
    scene.contact.damping = 0.0;
    scene.solver.modes = 2;
    scene.solver.tolerance = 1e-10;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    // A push, short against the periods and weak.
    let (start, size) = (1e-4, 4e-5);
    let push = Inputs {
        base_acceleration: 20.0,
        ..Inputs::default()
    };
    simulation.step(&push, 0.0, start).unwrap();
    let rest = simulation.real(RealOutput::PreloadIndentation);
    let samples: Vec<f64> = (0..2000)
        .map(|k| {
            simulation
                .step(&Inputs::default(), start + size * f64::from(k), size)
                .unwrap();
            simulation.real(RealOutput::ContactIndentation) - rest
        })
        .collect();
    let measured = two_frequencies(&samples, size);

    // The tangent in the polynomials of the reference.
    let reference = Reference::with::<2>(&scene);
    let preload = reference.preload;
    let step = 1e-4 * preload.deflection;
    let slope = (reference.axial_force(preload.deflection + step) - reference.axial_force(preload.deflection - step))
        / (2.0 * step);
    let ones = DVector::from_element(2, 1.0);
    let symmetric = &reference.bending - &reference.geometric * preload.axial_force
        + &ones * ones.transpose() * preload.contact_stiffness;
    let follows = &reference.geometric * &reference.r * ones.transpose() * slope;
    let frequencies = |stiffness: DMatrix<f64>| {
        let mut squares: Vec<f64> = (&reference.inverse_mass * stiffness)
            .complex_eigenvalues()
            .iter()
            .map(|lambda| lambda.re)
            .collect();
        squares.sort_by(f64::total_cmp);
        squares.into_iter().map(f64::sqrt)
    };
    let without: Vec<f64> = frequencies(symmetric.clone()).collect();
    for ((measured, tangent), without) in measured.iter().zip(frequencies(symmetric - follows)).zip(without) {
        println!(
            "measured {:.4} Hz, tangent {:.4} Hz, without dN/dy {:.4} Hz",
            measured / TAU,
            tangent / TAU,
            without / TAU
        );
        // The amplitude over the deflection at preload, 1e-4 or so, is what is left of the axial force's curvature.
        assert!((measured / tangent - 1.0).abs() < 1e-5, "{measured} {tangent}");
        assert!((without / tangent - 1.0).abs() > 1e-3, "{without} {tangent}");
    }
    let lowest = simulation.real(RealOutput::PreloadFrequency) * TAU;
    assert!((lowest / measured[0] - 1.0).abs() < 1e-5, "{lowest}");
}

#[test]
fn result_does_not_depend_on_the_communication_step() {
    let mut scene = bent();
    scene.excitation.amplitude = 8e3;
    scene.solver.modes = 0;
    for tolerance in [1e-4, 1e-6, 1e-8] {
        scene.solver.tolerance = tolerance;
        let force = |size: f64, count: u32| -> Vec<f64> {
            let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
            let steps = (0..count).map(|k| {
                simulation.step(&Inputs::default(), size * f64::from(k), size).unwrap();
                simulation.real(RealOutput::ContactForce)
            });
            steps.collect()
        };
        let scale = force_scale(&scene);
        let long = force(4e-4, 10);
        for finer in [20, 400] {
            let short = force(4e-4 / f64::from(finer), 10 * finer);
            let ends = short.iter().skip(finer as usize - 1).step_by(finer as usize);
            for (a, b) in long.iter().zip(ends) {
                // Each is within the tolerance of the truth.
                assert!((a - b).abs() <= 2.0 * tolerance * scale, "{a} {b} at {tolerance:e}");
            }
        }
    }
}

#[test]
fn at_the_specimen_the_difference_is_tiny() {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.tolerance = 1e-10;
    let mut of = |kind| {
        scene.effects.axial_force = kind;
        Simulation::new(&scene, &Inputs::default(), 0.0).unwrap()
    };
    let (mut constant, mut following) = (of(AxialForceKind::FromPreload), of(AxialForceKind::FromDeflection));
    let mut largest = 0.0_f64;
    for k in 0..2000 {
        let time = 1e-5 * f64::from(k);
        let forces = [&mut constant, &mut following].map(|simulation| {
            simulation.step(&Inputs::default(), time, 1e-5).unwrap();
            simulation.real(RealOutput::ContactForce)
        });
        largest = largest.max((forces[0] - forces[1]).abs());
    }
    println!("98 m/s2, 1000 Hz: the forces differ by at most {largest:.3e} N of 0.2 N");
    // The tip moves 50 nm: N by 1.5e-6 N, its transverse part N w' by 2e-2 of that; resonance and the spring's way to
    // the contact leave the order.
    assert!(largest > 1e-10 && largest < 1e-6, "{largest:e}");
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
        let inputs = Inputs {
            base_acceleration: acceleration,
            ..Inputs::default()
        };
        let mut simulation = Simulation::new(&scene, &inputs, 0.0).unwrap();
        simulation.step(&inputs, 0.0, 10.0).unwrap();
        let force = simulation.real(RealOutput::ContactForce);
        let mut heavy = scene.clone();
        heavy.environment.gravity = acceleration;
        let equilibrium = at_rest(&heavy, RealOutput::PreloadForce);
        println!("{overtravel} m: {force} N, {equilibrium} N");
        assert!((force - equilibrium).abs() < 1e-6 * force_scale(&heavy), "{force}");
    }
}

#[test]
fn violence_ends_in_a_motion_or_in_an_error_with_its_time() {
    for (length, thickness, amplitude) in [
        (12.5e-3, 1.19e-4, 1e3),
        (12.5e-3, 1.19e-4, 1e5),
        (12.5e-3, 1e-5, 1e6),
        (15.5e-3, 1e-4, 1e6),
    ] {
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
            let start = std::time::Instant::now();
            let result = simulation.step(&Inputs::default(), 0.0, 3e-3);
            let force = simulation.real(RealOutput::ContactForce);
            println!(
                "{length} m, {thickness} m, {amplitude} m/s2, {damping} s: {result:?}, {force:e} N, tip {} m, {:?}",
                simulation.real(RealOutput::TipDisplacement),
                start.elapsed()
            );
            assert!(force.is_finite() && force >= 0.0);
            if let Err(error) = result {
                assert!((0.0..3e-3).contains(&error.time));
            }
        }
    }
}
