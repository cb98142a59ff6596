//! Waveforms of the generated base acceleration: their closed forms, and what they do to the contact.

#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};

use relay_contact::error::SceneError;
use relay_contact::excitation::{Generator, Turns};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::transient::collocation::{Collocation, LONG, SHORT};
use relay_contact::transient::machine::Machine;
use relay_contact::variables::{ContactLawKind, ExcitationKind, IntegerOutput, RealOutput};

/// Standard acceleration of gravity, m/s2.
const G: f64 = 9.806_65;

/// A scene with the generator, 98 m/s2 from `start` on.
fn excited(kind: ExcitationKind, start: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.excitation = kind;
    scene.excitation.start_time = start;
    scene
}

fn sweep(start: f64, frequency: f64, end_frequency: f64, duration: f64) -> Scene {
    let mut scene = excited(ExcitationKind::LogSweep, start);
    scene.excitation.frequency = frequency;
    scene.excitation.end_frequency = end_frequency;
    scene.excitation.duration = duration;
    scene
}

fn half_sine(start: f64, amplitude: f64, duration: f64) -> Scene {
    let mut scene = excited(ExcitationKind::HalfSine, start);
    scene.excitation.amplitude = amplitude;
    scene.excitation.duration = duration;
    scene
}

fn random(start: f64, frequency: f64, end_frequency: f64, density: f64) -> Scene {
    let mut scene = excited(ExcitationKind::Random, start);
    scene.excitation.frequency = frequency;
    scene.excitation.end_frequency = end_frequency;
    scene.excitation.spectral_density = density;
    scene
}

fn limited(mut scene: Scene, limit: f64) -> Scene {
    scene.excitation.displacement_limit = limit;
    scene
}

fn phased(mut scene: Scene, phase: f64) -> Scene {
    scene.excitation.phase = phase;
    scene
}

fn generator(scene: &Scene) -> Generator {
    Generator::new(scene).unwrap()
}

/// Force, and the counted steps, after communication steps to these instants from 0 on.
fn forces(scene: &Scene, times: &[f64], inputs: impl Fn(f64, f64) -> Inputs) -> (Vec<f64>, i32) {
    let mut simulation = Simulation::new(scene, &inputs(0.0, 1.0), 0.0).unwrap();
    let mut forces = Vec::new();
    let mut last = 0.0;
    for &time in times {
        simulation.step(&inputs(last, time), last, time - last).unwrap();
        forces.push(simulation.real(RealOutput::ContactForce));
        last = time;
    }
    (forces, simulation.integer(IntegerOutput::SolverSteps))
}

fn undriven(_: f64, _: f64) -> Inputs {
    Inputs::default()
}

fn equal_steps(size: f64, count: u32) -> Vec<f64> {
    (1..=count).map(|k| f64::from(k) * size).collect()
}

fn scale(scene: &Scene) -> f64 {
    Simulation::new(scene, &Inputs::default(), 0.0)
        .unwrap()
        .model()
        .force_scale
}

/// The acceleration from its definition, as far as it goes without a sum of sines.
fn closed_form(scene: &Scene, time: f64) -> f64 {
    let e = &scene.excitation;
    let tau = time - e.start_time;
    let within = |frequency: f64| {
        if e.displacement_limit > 0.0 {
            e.amplitude.min((TAU * frequency).powi(2) * e.displacement_limit)
        } else {
            e.amplitude
        }
    };
    if tau < 0.0 {
        return 0.0;
    }
    match scene.effects.excitation {
        ExcitationKind::Sine => within(e.frequency) * (TAU * e.frequency * tau + e.phase).sin(),
        ExcitationKind::HalfSine if tau <= e.duration => e.amplitude * (PI * tau / e.duration).sin(),
        ExcitationKind::LogSweep if tau < e.duration => {
            let r = e.end_frequency / e.frequency;
            let grown = r.powf(tau / e.duration);
            let angle = TAU * e.frequency * e.duration / r.ln() * (grown - 1.0);
            within(e.frequency * grown) * (angle + e.phase).sin()
        }
        ExcitationKind::Random => generator(scene).acceleration(time),
        _ => 0.0,
    }
}

/// Scenes of every waveform that start at 0.3 ms and are over, where they end, at 2.3 ms.
fn every_waveform() -> Vec<(&'static str, Scene)> {
    let start = 3e-4;
    vec![
        ("sine", phased(excited(ExcitationKind::Sine, start), 0.7)),
        ("limited sine", limited(excited(ExcitationKind::Sine, start), 1e-6)),
        ("half sine", half_sine(start, 300.0, 2e-3)),
        ("sweep up", phased(sweep(start, 300.0, 3000.0, 2e-3), -0.4)),
        ("sweep down", phased(sweep(start, 3000.0, 300.0, 2e-3), 0.4)),
        (
            "sweep over the crossover",
            limited(sweep(start, 300.0, 3000.0, 2e-3), 3e-6),
        ),
        ("random", random(start, 100.0, 2500.0, 4.0)),
    ]
}

#[test]
fn waveforms_are_those_of_their_closed_forms() {
    for (name, scene) in every_waveform() {
        let generator = generator(&scene);
        let mut largest = 0.0_f64;
        for k in 0..3000 {
            let time = 1e-6 * (f64::from(k) + 0.5);
            let (found, expected) = (generator.acceleration(time), closed_form(&scene, time));
            largest = largest.max(found.abs());
            assert!(
                (found - expected).abs() < 1e-11 * 300.0,
                "{name} at {time}: {found} {expected}"
            );
            assert_eq!(generator.is_active(time), found != 0.0, "{name} at {time}");
        }
        assert!(largest > 30.0, "{name}: {largest}");
    }
}

/// A step's accelerations, at its start and at its nodes, are those of the instants.
#[test]
fn nodes_agree_with_direct_evaluation() {
    fn check<const S: usize>(name: &str, scene: &Scene, time: f64, length: f64) {
        let generator = generator(scene);
        let nodes = Collocation::<S>::new().nodes;
        let mut turns = Turns::<S>::room(&generator);
        let e = &scene.excitation;
        let highest = match scene.effects.excitation {
            ExcitationKind::HalfSine => 0.5 / e.duration,
            ExcitationKind::Sine => e.frequency,
            _ => e.frequency.max(e.end_frequency),
        };
        let largest = match scene.effects.excitation {
            // Half its sines in step.
            ExcitationKind::Random => 0.5 * (512.0 * e.spectral_density * (e.end_frequency - e.frequency)).sqrt(),
            _ => e.amplitude,
        };
        // The rounding of time to each side, in radians, and some of the sums.
        let allowed = largest * (2.0 * TAU * highest * f64::EPSILON * (time + length) + 1e-13);
        for machine in [Machine::Portable, Machine::detect()] {
            turns.fill(&generator, machine, length, &nodes);
            let found = generator.over_step(machine, time, &turns);
            let start = generator.acceleration(time);
            assert!(
                (found.start - start).abs() <= allowed,
                "{name} at {time}: {} {start}",
                found.start
            );
            for (x, found) in nodes.iter().zip(&found.nodes) {
                let expected = generator.acceleration_before(time + x * length);
                assert!(
                    (found - expected).abs() <= allowed,
                    "{name} at {time} + {x} {length}: {found} {expected}, allowed {allowed:e}"
                );
            }
        }
    }
    for (name, scene) in every_waveform() {
        for (time, length) in [
            (0.0, 3e-4),
            (3e-4, 1e-4),
            (7.1e-4, 3e-5),
            (1.3e-3, 1e-9),
            (2.2e-3, 1e-4),
        ] {
            check::<SHORT>(name, &scene, time, length);
            check::<LONG>(name, &scene, time, length);
        }
    }
    let late = [
        ("sweep", sweep(0.0, 10.0, 2000.0, 900.0)),
        ("slow sweep", sweep(0.0, 1000.0, 1e6, 1e9)),
        ("slow sweep down", sweep(0.0, 1e6, 1000.0, 1e9)),
        ("slight sweep", sweep(0.0, 1000.0, 1001.0, 1e9)),
        ("sweep that is a sine", sweep(0.0, 1000.0, 1000.0, 1e9)),
        ("sine", excited(ExcitationKind::Sine, 0.0)),
        ("random", random(0.0, 10.0, 2000.0, 1.0)),
    ];
    for (name, scene) in late {
        for time in [0.1, 17.3, 449.9, 451.2, 899.9] {
            check::<SHORT>(name, &scene, time, 3e-5);
            check::<LONG>(name, &scene, time, 3e-5);
        }
    }
    check::<LONG>("slow sweep", &late[1].1, 7e8, 1e-7);
}

#[test]
fn a_sweep_between_like_frequencies_is_the_sine() {
    let sine = generator(&phased(excited(ExcitationKind::Sine, 0.0), 0.3));
    // Turns that the sweep is ahead: f tau (r - 1) tau / 2 D.
    for (end_frequency, part) in [
        (1000.0, 0.0),
        (1000.0 + 2e-12, 2e-15),
        (1000.0 + 1e-9, 1e-12),
        (1000.0 - 1e-9, -1e-12),
    ] {
        let near = generator(&phased(sweep(0.0, 1000.0, end_frequency, 1e9), 0.3));
        for tau in [0.0, 1e-4, 0.77, 1234.567, 1e6, 3.3e8 + 0.125] {
            let ahead = TAU * 1000.0 * tau * part * tau / 2e9;
            let difference = (near.acceleration(tau) - sine.acceleration(tau)).abs();
            // The end frequency is rounded to its spacing, 1e-13 Hz, and what is ahead is within a few parts of it.
            let allowed = 98.0 * (1.1 * ahead.abs() + TAU * tau * 1e-13 * tau / 1e9 + 1e-12);
            assert!(difference <= allowed, "{end_frequency} {tau}: {difference} {allowed}");
        }
    }
}

#[test]
fn the_displacement_limit_crosses_over_where_the_standard_does() {
    // MIL-STD-202 method 204 condition A: the lesser of 0.06 in double amplitude and 10 g crosses over at 57.10 Hz.
    let limit = 0.5 * 0.06 * 0.0254;
    let mut scene = limited(sweep(0.0, 10.0, 500.0, 450.0), limit);
    scene.excitation.amplitude = 10.0 * G;
    let crossover = generator(&scene).next_break(0.0).unwrap();
    let frequency = 10.0 * 50_f64.powf(crossover / 450.0);
    assert!((frequency - 57.10).abs() < 0.005, "{frequency}");
    // Up to there the displacement amplitude is the limit, from there on the acceleration is the amplitude.
    let generator = generator(&scene);
    for (time, expected) in [(20.0, None), (crossover - 2.0, None), (crossover + 2.0, Some(10.0 * G))] {
        let frequency = 10.0 * 50_f64.powf(time / 450.0);
        let course = (0..2000).map(|k| generator.acceleration(time + f64::from(k) * 1e-3 / frequency));
        let found = course.fold(0.0_f64, |largest, a| largest.max(a.abs()));
        let expected = expected.unwrap_or((TAU * frequency).powi(2) * limit);
        // Over two periods the frequency grows by 2 ln(50) / (450 f), the amplitude with its square at the most; the
        // largest is at most half a thousandth of a period from an instant looked at.
        let allowed = 4.0 * 50_f64.ln() / (450.0 * frequency) + 0.5 * (TAU * 5e-4).powi(2);
        assert!((found / expected - 1.0).abs() < allowed, "{time} s: {found} {expected}");
    }
}

#[test]
fn a_shock_changes_the_velocity_as_the_standard_says() {
    // MIL-STD-202 method 213 condition A: 50 g, 11 ms, half sine.
    let generator = generator(&half_sine(0.02, 50.0 * G, 0.011));
    let size = 1e-6;
    let change: f64 = (0..50_000)
        .map(|k| size * generator.acceleration(size * (f64::from(k) + 0.5)))
        .sum();
    assert!((change - 3.434).abs() < 5e-4, "{change}");
    assert_eq!(
        (generator.next_break(0.0), generator.next_break(0.02)),
        (Some(0.02), Some(0.031))
    );
    assert_eq!(generator.next_break(0.031), None);
}

/// Slow against the spring, the force follows the inertia of a propped cantilever with a mass at the prop, the prop all but
/// rigid. Bonded, so that it may also pull.
#[test]
fn a_slow_acceleration_acts_through_its_mass() {
    let slow = [
        phased(excited(ExcitationKind::Sine, 0.01), 0.5),
        limited(excited(ExcitationKind::Sine, 0.01), 0.02),
        half_sine(0.01, 98.0, 0.2),
        sweep(0.01, 2.0, 20.0, 0.3),
        limited(sweep(0.01, 20.0, 2.0, 0.3), 0.02),
        random(0.01, 1.0, 20.0, 100.0),
    ];
    for law in [
        ContactLawKind::Bonded,
        ContactLawKind::Linearised,
        ContactLawKind::Hertz,
    ] {
        for mut scene in slow {
            scene.effects.contact_law = law;
            if scene.effects.excitation == ExcitationKind::Sine {
                scene.excitation.frequency = 10.0;
            }
            let simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
            let section = &simulation.model().section;
            let mass = 0.375 * section.mass_per_length * section.length + section.tip_mass;
            let preload = simulation.model().preload.force;
            let times = equal_steps(5.1e-3, 70);
            let (forces, _) = forces(&scene, &times, undriven);
            let expected: Vec<f64> = times.iter().map(|t| mass * closed_form(&scene, *t)).collect();
            let largest = expected.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()));
            assert!(largest > 0.1 * preload, "{:?}: {largest}", scene.excitation);
            let generator = generator(&scene);
            for ((time, force), expected) in times.iter().zip(&forces).zip(&expected) {
                // What a jump or a kink has set ringing dies out at 0.34 times 8500 1/s.
                if generator.next_break(time - 5e-3).is_some_and(|corner| corner <= *time) {
                    continue;
                }
                // The prop gives way by 1e-3 of the spring's stiffness, inertia by (20 / 1354)^2.
                assert!(
                    (force - preload - expected).abs() < 2e-3 * largest,
                    "{law:?} {:?} at {time}: {} {expected}",
                    scene.effects.excitation,
                    force - preload
                );
            }
        }
    }
}

/// The same course from outside, in straight pieces, is wrong by the square of their length.
#[test]
fn waveforms_from_outside_converge_to_the_generators() {
    for (name, mut scene) in every_waveform() {
        scene.solver.tolerance = 1e-9;
        let mut quiet = scene;
        quiet.effects.excitation = ExcitationKind::None;
        let every = equal_steps(1e-4, 30);
        let (exact, _) = forces(&scene, &every, undriven);
        // Where it jumps, what follows counts from there on.
        let before = |time: f64| generator(&scene).acceleration_before(time);
        let errors = [2_u32, 1].map(|size| {
            let course = |time: f64, end: f64| Inputs {
                base_acceleration: closed_form(&scene, time + 1e-12),
                base_acceleration_rate: (before(end) - closed_form(&scene, time + 1e-12)) / (end - time),
                ..Inputs::default()
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
            for law in [
                ContactLawKind::Hertz,
                ContactLawKind::Linearised,
                ContactLawKind::Bonded,
            ] {
                let mut scene = base;
                scene.effects.contact_law = law;
                scene.excitation.amplitude *= strength;
                scene.excitation.displacement_limit *= strength;
                scene.excitation.spectral_density *= strength * strength;
                scene.solver.tolerance = 1e-6;
                let reference = {
                    let mut scene = scene;
                    scene.solver.tolerance = 1e-10;
                    forces(&scene, &equal_steps(1e-3, 4), undriven).0
                };
                let allowed = scene.solver.tolerance * scale(&scene);
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
                        assert!(
                            (found - expected).abs() <= allowed,
                            "{name} x {strength}, {law:?}, {} steps: {found} {expected}, {:.1e} of what is allowed",
                            times.len(),
                            (found - expected).abs() / allowed
                        );
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
    // Nobody watches what happens inside steps.
    scene.effects.extremes = false;
    scene.effects.chatter = false;
    scene.solver.tolerance = 1e-10;
    let (whole, steps) = forces(&scene, &[1e-3], undriven);
    // At rest before the shock.
    assert_eq!(steps, 2);
    let (parts, _) = forces(&scene, &equal_steps(7e-6, 142), undriven);
    let (last, _) = forces(&scene, &[142.0 * 7e-6], undriven);
    assert!(
        (parts[141] - last[0]).abs() < 1e-12 * scale(&scene),
        "{} {}",
        parts[141],
        last[0]
    );
    let mut stepped = scene;
    stepped.solver.maximum_step = 1e-5;
    let (integrated, many) = forces(&stepped, &[1e-3], undriven);
    assert!(many > 50, "{many}");
    assert!(
        (integrated[0] - whole[0]).abs() < 1e-10 * scale(&scene),
        "{integrated:?} {whole:?}"
    );
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

#[test]
fn random_acceleration_has_the_power_asked_for() {
    let (low, high, density) = (20.0, 2000.0, 3.0);
    let generator = generator(&random(0.0, low, high, density));
    let (rate, count) = (10_007.0, 100_000_u32);
    let time = f64::from(count) / rate;
    let power = (0..count)
        .map(|k| generator.acceleration(f64::from(k) / rate).powi(2))
        .sum::<f64>()
        / f64::from(count);
    let expected = density * (high - low);
    // Noise of this bandwidth scatters by 1 / sqrt(B T); four times that.
    let allowed = 4.0 / ((high - low) * time).sqrt();
    assert!((power / expected - 1.0).abs() < allowed, "{power} {expected}");
}

#[test]
fn random_acceleration_has_a_flat_spectrum_and_nothing_outside_its_band() {
    let (low, high, density) = (500.0, 2000.0, 3.0);
    let (rate, count) = (8000.0, 400_u32);
    let seeds = 200;
    let frequencies = [
        100.0, 250.0, 600.0, 800.0, 1000.0, 1250.0, 1500.0, 1900.0, 2300.0, 3000.0,
    ];
    let window = |k: u32| (PI * (f64::from(k) + 0.5) / f64::from(count)).sin().powi(2);
    let squares: f64 = (0..count).map(|k| window(k).powi(2)).sum();
    let mut spectrum = [0.0; 10];
    for seed in 0..seeds {
        let mut scene = random(0.0, low, high, density);
        scene.excitation.seed = seed;
        let generator = generator(&scene);
        let course: Vec<f64> = (0..count)
            .map(|k| window(k) * generator.acceleration(1.7 + f64::from(k) / rate))
            .collect();
        for (power, frequency) in spectrum.iter_mut().zip(frequencies) {
            let (mut re, mut im) = (0.0, 0.0);
            for (k, a) in course.iter().enumerate() {
                let (sin, cos) = (TAU * frequency * k as f64 / rate).sin_cos();
                re += a * cos;
                im += a * sin;
            }
            *power += 2.0 * (re * re + im * im) / (rate * squares) / f64::from(seeds);
        }
    }
    let mut inside = Vec::new();
    for (power, frequency) in spectrum.into_iter().zip(frequencies) {
        if (low..high).contains(&frequency) {
            // A periodogram scatters as much as it is; four times that over the root of how many there are.
            assert!(
                (power / density - 1.0).abs() < 4.0 / f64::from(seeds).sqrt(),
                "{frequency} Hz: {power}"
            );
            inside.push(power / density);
        } else {
            // Twelve and more lines of the window away, where it falls with the third power.
            assert!(power < 1e-5 * density, "{frequency} Hz: {power}");
        }
    }
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    assert!(
        (mean - 1.0).abs() < 4.0 / (f64::from(seeds) * inside.len() as f64).sqrt(),
        "{mean}"
    );
}

#[test]
fn a_seed_chooses_the_course() {
    let course = |seed: i32| {
        let mut scene = random(1e-4, 20.0, 2000.0, 2.0);
        scene.excitation.seed = seed;
        forces(&scene, &equal_steps(2e-4, 20), undriven).0
    };
    let (first, again, other) = (course(7), course(7), course(8));
    assert_eq!(
        first.iter().map(|f| f.to_bits()).collect::<Vec<_>>(),
        again.iter().map(|f| f.to_bits()).collect::<Vec<_>>()
    );
    let difference = first.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference > 1e-2, "{difference}");
}

#[test]
fn a_random_acceleration_needs_a_band() {
    for end_frequency in [1000.0, 999.0] {
        let scene = random(0.0, 1000.0, end_frequency, 1.0);
        let error = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap_err();
        assert!(matches!(error, SceneError::NoBand { .. }), "{error:?}");
        let text = error.to_string();
        for part in [
            "excitation.frequency = 1000 Hz",
            &format!("excitation.endFrequency = {end_frequency} Hz"),
            "above",
        ] {
            assert!(text.contains(part), "{text}");
        }
    }
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
        limited(sweep(0.0, 1e-3, 1e6, 1e-4), 1.0),
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
