//! What they do to the contact.

use relay_contact::inputs::Inputs;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, ExcitationKind, IntegerOutput, RealOutput};
use testing::near;
use testing::scenes::{LAWS, accelerated, force_scale};

use super::{G, Generator, equal_steps, every_waveform, forces, half_sine, random, sweep, undriven, with};

/// The same course from outside, in straight pieces, is wrong by the square of their length.
#[test]
fn waveforms_from_outside_converge_to_the_generators() {
    for (name, mut scene) in every_waveform() {
        scene.solver.tolerance = 1e-9;
        let mut quiet = scene.clone();
        quiet.effects.excitation = ExcitationKind::None;
        let every = equal_steps(1e-4, 30);
        let (exact, _) = forces(&scene, &every, undriven);
        // Where it jumps, what follows counts from there on.
        let generator = Generator::new(&scene);
        let errors = [2_u32, 1].map(|size| {
            let course = |time: f64, end: f64| {
                let start = generator.acceleration(time + 1e-12);
                accelerated(start, (generator.acceleration_before(end) - start) / (end - time))
            };
            let (all, _) = forces(&quiet, &equal_steps(1e-6 * f64::from(size), 3000 / size), course);
            let some = all.iter().skip(100 / size as usize - 1).step_by(100 / size as usize);
            some.zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        let order = (errors[0] / errors[1]).log2();
        println!("{name}: {errors:?} N, order {order:.2}");
        assert!((order - 2.0).abs() < 0.15, "{name}: {errors:?}");
    }
}

#[test]
fn the_communication_step_does_not_matter() {
    for (name, base) in every_waveform() {
        for strength in [1.0, 4.0] {
            for law in LAWS {
                let mut scene = base.clone();
                scene.effects.contact_law = law;
                scene.excitation.amplitude *= strength;
                scene.excitation.displacement_limit *= strength;
                scene.excitation.spectral_density *= strength * strength;
                scene.solver.tolerance = 1e-6;
                let reference = {
                    let mut scene = scene.clone();
                    scene.solver.tolerance = 1e-10;
                    forces(&scene, &equal_steps(1e-3, 4), undriven).0
                };
                let allowed = scene.solver.tolerance * force_scale(&scene);
                let mut irregular = Vec::new();
                for ms in 0..4 {
                    // Golden section of what is left.
                    irregular.extend((1..12).map(|k| 1e-3 * (f64::from(ms) + 1.0 - 0.618_f64.powi(k))));
                    irregular.push(1e-3 * f64::from(ms + 1));
                }
                let courses = [
                    (equal_steps(1e-6, 4000), 1000),
                    (equal_steps(1e-5, 400), 100),
                    (equal_steps(1e-3, 4), 1),
                    (irregular, 12),
                ];
                for (times, every) in courses {
                    let (found, _) = forces(&scene, &times, undriven);
                    for (found, expected) in found.iter().skip(every - 1).step_by(every).zip(&reference) {
                        let of = format!("{name} x {strength}, {law:?}, {} steps", times.len());
                        near(of, *found, *expected, allowed);
                    }
                }
            }
        }
    }
}

/// A linear scene is as exact under a half sine as under a sine: one step before it, one in it, one after.
#[test]
fn a_linear_scene_goes_through_a_shock_in_exact_steps() {
    let mut scene = half_sine(2e-4, 98.0, 5e-4);
    scene.effects.contact_law = ContactLawKind::Bonded;
    // Without them a linear scene takes exact steps.
    scene.effects.extremes = false;
    scene.effects.chatter = false;
    scene.solver.tolerance = 1e-10;
    let (whole, steps) = forces(&scene, &[1e-3], undriven);
    // At rest before the shock.
    assert_eq!(steps, 2);
    let (parts, _) = forces(&scene, &equal_steps(7e-6, 142), undriven);
    let (last, _) = forces(&scene, &[142.0 * 7e-6], undriven);
    assert!((parts[141] - last[0]).abs() < 1e-12 * force_scale(&scene), "{} {}", parts[141], last[0]);
    let mut stepped = scene.clone();
    stepped.solver.maximum_step = 1e-5;
    let (integrated, many) = forces(&stepped, &[1e-3], undriven);
    assert!(many > 50, "{many}");
    assert!((integrated[0] - whole[0]).abs() < 1e-10 * force_scale(&scene), "{integrated:?} {whole:?}");
}

/// Also where the generator has a longest step of its own.
#[test]
fn no_step_is_longer_than_the_one_allowed() {
    for law in LAWS {
        for (name, mut scene) in every_waveform() {
            scene.effects.contact_law = law;
            let steps = |maximum_step: f64| {
                let mut scene = scene.clone();
                scene.solver.maximum_step = maximum_step;
                forces(&scene, &[1e-3], undriven).1
            };
            let (free, limited) = (steps(0.0), steps(1e-6));
            assert!(free < 700 && limited >= 1000, "{name} {law:?}: {free} {limited}");
        }
    }
}

#[test]
fn after_a_shock_or_a_sweep_the_contact_rests() {
    let shock = half_sine(0.5, 50.0 * G, 0.011);
    let sweep = sweep(0.5, 10.0, 2000.0, 0.1);
    for scene in [shock, sweep] {
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let preload = simulation.real(RealOutput::ContactForce);
        let steps = |simulation: &Simulation| simulation.integer(IntegerOutput::SolverSteps);
        simulation.step(&Inputs::default(), 0.0, 0.5).unwrap();
        assert_eq!(steps(&simulation), 0);
        simulation.step(&Inputs::default(), 0.5, 0.5).unwrap();
        let counted = steps(&simulation);
        assert!((50..20_000).contains(&counted), "{counted}");
        for k in 1..1000 {
            simulation.step(&Inputs::default(), f64::from(k), 1.0).unwrap();
        }
        simulation.step(&Inputs::default(), 1000.0, 1e6).unwrap();
        assert_eq!(steps(&simulation), counted);
        let force = simulation.real(RealOutput::ContactForce);
        assert!((force / preload - 1.0).abs() < 1e-6, "{force} {preload}");
    }
}

#[test]
fn a_slow_sweep_is_not_stepped_at_its_highest_frequency() {
    let mut scene = sweep(0.0, 10.0, 2000.0, 900.0);
    scene.solver.tolerance = 1e-6;
    let (_, steps) = forces(&scene, &[0.1], undriven);
    // A period of 10 Hz takes some tens of steps; stepped at a quarter of 2000 Hz it would be 800.
    assert!((5..200).contains(&steps), "{steps}");
    let (_, short) = forces(&scene, &equal_steps(1e-5, 10_000), undriven);
    assert!((5..200).contains(&short), "{short}");
}

/// Ranges of the parameters at their ends, and a window that time cannot resolve.
#[test]
fn extreme_waveforms_are_integrated() {
    let mut scenes = vec![
        half_sine(0.0, 1e6, 1e-9),
        half_sine(1e9, 98.0, 1e-9),
        half_sine(0.0, 98.0, 1e9),
        sweep(0.0, 1e-3, 1e6, 1e-9),
        sweep(0.0, 1e6, 1e-3, 1e-9),
        sweep(0.0, 1e-3, 1e6, 1e9),
        sweep(0.0, 1e6, 1e-3, 1e-4),
        sweep(0.0, 1e-3, 1e6, 1e-4),
        with(sweep(0.0, 1e-3, 1e6, 1e-4), |sweep| sweep.displacement_limit = 1.0),
        random(0.0, 1e-3, 1e6, 1.0),
        random(0.0, 1e-3, 2e-3, 1e9),
        random(0.0, 1000.0, 1000.0 + 1e-12, 1e9),
        random(0.0, 20.0, 2000.0, 0.0),
    ];
    scenes.push(half_sine(0.0, 0.0, 0.011));
    for scene in scenes {
        let start = (scene.excitation.start_time - 1.0).max(0.0);
        let mut simulation = Simulation::new(&scene, &Inputs::default(), start).unwrap();
        for _ in 0..10 {
            simulation.step(&Inputs::default(), simulation.time(), 1e-5).unwrap();
            let force = simulation.real(RealOutput::ContactForce);
            assert!(force.is_finite() && force >= 0.0, "{:?}: {force}", scene.excitation);
        }
    }
}
