//! The armature between magnet, return spring and stops: its two positions, what takes it from the core, and the energy on its
//! way between the stops, by closed forms. Its bounces in a shock are compared with another solution in
//! `tests/python/test_relay_parts.py`.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{BooleanOutput, ExcitationKind, PusherKind, RealOutput};
use testing::scenes::{course, largest_difference, shaken};

/// An armature that feels all of its weight, and whose pusher meets the spring on the way to its core.
fn relay() -> Scene {
    let mut scene = Scene::default();
    scene.effects.pusher = PusherKind::Armature;
    scene.contact.overtravel = -5e-5;
    scene.armature.unbalance = 1.0;
    scene
}

/// The same out of reach of the spring, however far that swings.
fn alone() -> Scene {
    let mut scene = relay();
    scene.contact.overtravel = -1e-3;
    scene.armature.rest_position = -1.04e-2;
    scene.armature.core_position = -1e-2;
    scene.solver.tolerance = 1e-7;
    scene
}

fn coil(current: f64) -> Inputs {
    Inputs { coil_relative_current: current, ..Inputs::default() }
}

fn close(a: f64, b: f64, share: f64) {
    assert!((a - b).abs() <= share * b.abs(), "{a} {b}");
}

/// A stop that presses lets steps grow beyond what shows a flight.
#[test]
fn what_is_read_of_a_flying_spring_does_not_depend_on_an_armature_at_rest() {
    let mut scene = alone();
    scene.armature.unbalance = 0.0;
    scene.beam.stiffness_damping = 1e-6;
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.amplitude = -500.0;
    scene.excitation.duration = 1e-3;
    let motion = |pusher: PusherKind| {
        let mut scene = scene.clone();
        scene.effects.pusher = pusher;
        let mut simulation = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
        let read = |k: u32| {
            simulation.step(&coil(0.0), 1e-5 * f64::from(k), 1e-5).unwrap();
            simulation.real(RealOutput::TipDisplacement)
        };
        (0..1000).map(read).collect::<Vec<_>>()
    };
    // A force wrong by the tolerance bends the spring by this.
    let allowed = scene.solver.tolerance * scene.contact.overtravel.abs();
    let found = largest_difference(&motion(PusherKind::Armature), &motion(PusherKind::None));
    assert!(found < 2.0 * allowed, "{found} {allowed}");
}

/// Balance of forces in both.
#[test]
fn the_coil_says_which_of_two_positions_it_has() {
    let scene = relay();
    let given = scene.armature;
    let on = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let preload = on.model().preload;
    assert!(preload.force > 0.1 && preload.pusher_force > 0.1 && on.boolean(BooleanOutput::PusherClosed));
    let place = on.real(RealOutput::ArmatureDisplacement);
    close(place, given.core_position + preload.armature.core_force / given.stop_stiffness, 1e-12);
    let spring = given.return_force + given.stiffness * (place - given.rest_position);
    close(preload.armature.core_force, given.hold_force - spring - preload.pusher_force, 1e-9);
    close(on.real(RealOutput::StepMinimumStopForce), preload.armature.core_force, 1e-12);
    close(on.real(RealOutput::ArmatureGap), given.core_position - place, 1e-9);

    let off = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
    let preload = off.model().preload;
    assert_eq!((preload.force, preload.pusher_force, preload.armature.magnet_force), (0.0, 0.0, 0.0));
    close(preload.armature.rest_force, given.return_force, 1e-3);
    // Too weak a current holds nothing.
    let weak = Simulation::new(&scene, &coil(0.2), 0.0).unwrap();
    assert!(weak.model().preload.armature.core_force == 0.0);
}

/// Without current it falls to its rest, and comes back under more than holds it. Over a communication step the mean current counts.
#[test]
fn the_coil_lets_go_and_draws_again() {
    let scene = relay();
    let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let held = simulation.real(RealOutput::ContactForce);
    let pushed = simulation.real(RealOutput::StepMinimumPusherForce);
    assert_eq!(pushed, simulation.model().preload.pusher_force);
    let ramp = Inputs { coil_relative_current_rate: 2e3, ..coil(0.5) };
    let gaps = [coil(0.6), ramp].map(|inputs| {
        let mut other = simulation.clone();
        other.step(&inputs, 0.0, 1e-4).unwrap();
        other.real(RealOutput::ArmatureGap)
    });
    close(gaps[0], gaps[1], 1e-9);
    simulation.step(&coil(0.0), 0.0, 5e-4).unwrap();
    let velocity = simulation.real(RealOutput::ArmatureVelocity);
    assert!(velocity < 0.0 && simulation.rate(RealOutput::ArmatureGap) == Some(-velocity), "{velocity}");
    simulation.step(&coil(0.0), 5e-4, 0.1).unwrap();
    let off = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
    let place = RealOutput::ArmatureDisplacement;
    close(simulation.real(place), off.real(place), 1e-6);
    for (time, current) in [(0.1005, 2.0), (0.2005, 1.0)] {
        simulation.step(&coil(current), time, 0.1).unwrap();
    }
    close(simulation.real(RealOutput::ContactForce), held, 1e-6);
}

/// A slow acceleration takes the armature from its core where its weight is what holds it: hold force less return spring.
#[test]
fn a_slow_acceleration_releases_it_at_its_holding_force_over_its_mass() {
    let scene = alone();
    let given = scene.armature;
    let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let held = simulation.model().preload.armature.core_force;
    let threshold = held / given.mass;
    let (rate, step) = (-threshold / 0.05, 1e-4);
    for n in 0..600 {
        let time = f64::from(n) * step;
        let inputs = Inputs { base_acceleration: rate * time, base_acceleration_rate: rate, ..coil(1.0) };
        simulation.step(&inputs, time, step).unwrap();
    }
    let release = simulation.real(RealOutput::ArmatureLastRelease);
    // The stop swings at sqrt(k / m) = 22 kHz: the force lags by microseconds.
    assert!((release - 0.05).abs() < 5e-5, "{release}");
}

/// Steps of the Runge-Kutta method, s.
const DT: f64 = 1e-9;

/// Over 100 us from rest: the velocity of an armature alone that the base pulls from its core with so many times the force that holds it, by
/// the classical Runge-Kutta method; and the inputs. The stop damps with this share of critical damping.
fn pulled(scene: &Scene, ratio: f64, times: f64) -> (f64, Inputs) {
    let given = scene.armature;
    let damping = 2.0 * ratio * (given.stop_stiffness * given.mass).sqrt();
    let start = Simulation::new(scene, &coil(1.0), 0.0).unwrap();
    let pull = times * start.model().preload.armature.core_force;
    let rate = |[place, velocity]: [f64; 2]| {
        let gap = given.core_position - place;
        let drawn = given.hold_force / (1.0 + gap.max(0.0) / given.gap_constant).powi(2);
        let returned = given.return_force + given.stiffness * (place - given.rest_position);
        let stop = if gap < 0.0 { (damping * velocity - given.stop_stiffness * gap).max(0.0) } else { 0.0 };
        [velocity, (drawn - returned - stop - pull) / given.mass]
    };
    let moved = |at: [f64; 2], rate: [f64; 2], h: f64| [at[0] + h * rate[0], at[1] + h * rate[1]];
    let mut at = [start.real(RealOutput::ArmatureDisplacement), 0.0];
    for _ in 0..100_000 {
        let a = rate(at);
        let b = rate(moved(at, a, 0.5 * DT));
        let c = rate(moved(at, b, 0.5 * DT));
        let d = rate(moved(at, c, DT));
        at = [0, 1].map(|i| at[i] + DT / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    (at[1], Inputs { base_acceleration: -pull / given.mass, ..coil(1.0) })
}

/// Velocity and gap after that, at a tolerance.
fn pulled_off(scene: &Scene, inputs: &Inputs, tolerance: f64) -> (f64, f64) {
    let mut scene = scene.clone();
    scene.solver.tolerance = tolerance;
    let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    simulation.step(inputs, 0.0, 1e-4).unwrap();
    (simulation.real(RealOutput::ArmatureVelocity), simulation.real(RealOutput::ArmatureGap))
}

/// A stop that damps lets go while it is still indented; where the indentation ends, in flight, so does the constant force of the magnet.
#[test]
fn the_force_of_the_magnet_bends_where_a_gap_opens() {
    let mut scene = alone();
    (scene.armature.gap_constant, scene.armature.damping) = (2e-5, 0.0);
    // That of critical damping.
    scene.armature.stop_restitution = (-2.0_f64).exp();
    let (expected, inputs) = pulled(&scene, 1.0, 1.5);
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (velocity, gap) = pulled_off(&scene, &inputs, tolerance);
        // A bend of the force inside a step of that method costs it some 1e-12; a bend inside one of the component's cost 1e-6.
        close(velocity, expected, 1e-11);
        assert!(gap > 2e-6);
    }
}

/// A flight of microseconds, begun and ended within a step: where the stop lets go, the armature hardly moves.
#[test]
fn a_gap_that_closes_within_the_step_that_opens_it_is_one() {
    let mut scene = Scene::default();
    scene.effects.pusher = PusherKind::Armature;
    scene.contact.overtravel = -4e-5;
    (scene.pusher.position, scene.pusher.stiffness, scene.pusher.damping) = (1.16e-2, 2e4, 0.05);
    let armature = &mut scene.armature;
    (armature.mass, armature.stiffness, armature.return_force, armature.damping) = (1.5e-3, 17.5, 0.73, 0.01);
    (armature.rest_position, armature.core_position, armature.unbalance) = (5e-5, 1.2e-4, 1.0);
    (armature.hold_force, armature.gap_constant) = (2.2, 2e-4);
    (armature.stop_stiffness, armature.stop_restitution) = (1.2e6, 0.5);
    scene.effects.excitation = ExcitationKind::HalfSine;
    (scene.excitation.amplitude, scene.excitation.duration) = (-1271.6, 3e-4);
    scene.solver.tolerance = 1e-8;
    let velocities = |maximum_step: f64| {
        let mut scene = scene.clone();
        scene.solver.maximum_step = maximum_step;
        course(&scene, 2e-4, 30, [RealOutput::ArmatureVelocity]).0
    };
    // Steps shorter than the flight see the gap at their end.
    for ([found], [expected]) in velocities(0.0).iter().zip(velocities(3e-6)) {
        assert!((found - expected).abs() <= 1e-9, "{found} {expected}");
    }
}

/// The same of any armature, magnet and stop; some are still indented at the end.
#[test]
fn an_armature_leaves_any_core_at_any_tolerance() {
    let rng = &mut fastrand::Rng::with_seed(1);
    let mut left = 0;
    for _ in 0..24 {
        let mut scene = alone();
        let given = &mut scene.armature;
        given.mass *= 10.0_f64.powf(rng.f64() - 0.5);
        given.stop_stiffness *= 10.0_f64.powf(rng.f64() - 0.5);
        given.gap_constant = 10.0_f64.powf(-5.0 + 1.5 * rng.f64());
        given.damping = 0.0;
        let ratio = 0.1 + 0.8 * rng.f64();
        let root = (1.0 - ratio * ratio).sqrt();
        // T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465.
        given.stop_restitution = (-ratio / root * f64::atan2(2.0 * ratio * root, 2.0 * ratio * ratio - 1.0)).exp();
        let (stiffness, mass) = (given.stop_stiffness, given.mass);
        let (expected, inputs) = pulled(&scene, ratio, 1.2 + rng.f64());
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (velocity, gap) = pulled_off(&scene, &inputs, tolerance);
            left += u32::from(gap > 0.0);
            // What a bend of the stop's stiffness makes of a step of that method, and what a step of the component may add.
            close(velocity, expected, stiffness / mass * DT * DT + 4e-3 * tolerance);
        }
    }
    assert!(left > 60, "{left}");
}

/// The whole: contact, pusher and core under a shock; held, and released.
#[test]
fn a_released_armature_opens_the_contact() {
    let mut scene = relay();
    // A magnet that draws it back from any place.
    scene.armature.gap_constant = 5e-4;
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.duration = 2e-3;
    let run = |amplitude: f64, tolerance: f64, modes: i32| {
        let mut scene = scene.clone();
        scene.excitation.amplitude = amplitude;
        (scene.solver.tolerance, scene.solver.modes) = (tolerance, modes);
        let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
        let forces: Vec<_> = (0..2000)
            .map(|n| {
                simulation.step(&coil(1.0), f64::from(n) * 1e-5, 1e-5).unwrap();
                simulation.real(RealOutput::ContactForce)
            })
            .collect();
        (simulation, forces)
    };
    for (amplitude, opens) in [(-100.0, false), (-3000.0, true)] {
        let (simulation, forces) = run(amplitude, 1e-6, 0);
        let happened = [RealOutput::ArmatureLastRelease, RealOutput::ContactLastOpening];
        assert_eq!(happened.map(|event| simulation.real(event) > 0.0), [opens; 2]);
        close(simulation.real(RealOutput::ContactForce), simulation.model().preload.force, 1e-3);
        let (_, converged) = run(amplitude, 1e-9, 64);
        let greatest = converged.iter().fold(0.0_f64, |greatest, force| greatest.max(*force));
        let error = largest_difference(&forces, &converged) / greatest;
        assert!(error < 1e-6 && error < simulation.force_error(), "{error}");
    }
}

/// Between elastic stops an armature alone keeps the sum of kinetic energy, that of its return spring and stops, and what the
/// magnet stores over the gap, `F_h i^2 g / (1 + g / g_0)`: by the formulas, and by the balance of the component. Its coil is
/// switched on, which draws it to its core, and off, which lets it fall to its rest stop.
#[test]
fn energy_is_kept_between_magnet_return_spring_and_stops() {
    let mut scene = alone();
    scene.effects.energy = true;
    scene.armature.stop_restitution = 1.0;
    scene.armature.damping = 0.0;
    // With this current, enough to draw it from its rest.
    scene.armature.hold_force *= 2.0;
    let current = 1.5_f64;
    let given = scene.armature;
    let mut simulation = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
    let energy = |simulation: &Simulation, current: f64| {
        let [place, velocity] =
            [RealOutput::ArmatureDisplacement, RealOutput::ArmatureVelocity].map(|output| simulation.real(output));
        let gap = given.core_position - place;
        let way = place - given.rest_position;
        let pulled = if gap > 0.0 { gap / (1.0 + gap / given.gap_constant) } else { gap };
        let stops = [gap, way].map(|gap| 0.5 * given.stop_stiffness * gap.min(0.0).powi(2));
        0.5 * given.mass * velocity * velocity
            + given.return_force * way
            + 0.5 * given.stiffness * way * way
            + given.hold_force * current.powi(2) * pulled
            + stops[0]
            + stops[1]
    };
    let (mut seated, mut rested, mut fastest) = (0, 0, 0.0_f64);
    for (start, current) in [(0, current), (2000, 0.0)] {
        let before = energy(&simulation, current);
        for n in start..start + 2000 {
            simulation.step(&coil(current), f64::from(n) * 1e-5, 1e-5).unwrap();
            seated += i32::from(simulation.real(RealOutput::ArmatureGap) < 0.0);
            rested += i32::from(simulation.real(RealOutput::ArmatureDisplacement) < given.rest_position);
            fastest = fastest.max(simulation.real(RealOutput::ArmatureVelocity));
            let kinetic = 0.5 * given.mass * fastest * fastest;
            let lost = energy(&simulation, current) - before;
            assert!(lost.abs() < 1e-4 * kinetic.max(1e-7), "{n}: {lost} of {kinetic}");
            let balance = simulation.real(RealOutput::EnergyBalance);
            assert!(balance.abs() < 1e-4 * kinetic.max(1e-7), "{n}: {balance} of {kinetic}");
        }
    }
    assert!(seated > 10 && rested > 10 && fastest > 0.1, "{seated} {rested} {fastest}");
}

/// One out of reach drops from its core, then vibration opens the contact. Its blows at the stops neither hide how errors grow at the
/// contact nor are what its force is measured by. Without an armature it is known to 4e-7.
#[test]
fn an_armature_that_touches_nothing_does_not_change_what_is_announced() {
    let run = |pusher, tolerance| {
        let mut scene = shaken(450.0, 1000.0);
        (scene.effects.pusher, scene.solver.tolerance) = (pusher, tolerance);
        (scene.excitation.start_time, scene.beam.stiffness_damping, scene.contact.damping) = (0.01, 3e-7, 1e-6);
        (scene.armature.rest_position, scene.armature.core_position) = (-1.5e-3, -1.1e-3);
        scene.armature.unbalance = 0.0;
        let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
        let forces = (0..1200_u32).map(|k| {
            simulation.step(&coil(0.0), f64::from(k) * 2e-5, 2e-5).unwrap();
            simulation.real(RealOutput::ContactForce)
        });
        let forces: Vec<_> = forces.collect();
        (forces, simulation.real(RealOutput::SolverForceError))
    };
    let (expected, _) = run(PusherKind::None, 1e-10);
    let greatest = expected.iter().copied().fold(0.0, f64::max);
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let (found, told) = run(PusherKind::Armature, tolerance);
        let error = largest_difference(&found, &expected) / greatest;
        // 1: the force is not known at all.
        assert!(told == 1.0 || error < told.max(tolerance), "{tolerance:e}: {error:e}, told {told:e}");
    }
}

/// Drawn by its magnet to where the return spring holds it, out of reach of all else, it is a mass on that spring and on the negative
/// stiffness of the magnet, `k - 2 F / (g_0 + g)`.
#[test]
fn the_magnet_softens_an_armature_that_floats() {
    let mut scene = alone();
    let given = &mut scene.armature;
    (given.rest_position, given.core_position, given.mass) = (-1.03e-2, -1e-2, 2e-2);
    (given.stiffness, given.return_force, given.hold_force) = (1.4e4, 0.0, 4.0);
    let given = scene.armature;
    for current in [1.0_f64, 0.8] {
        let model = Simulation::new(&scene, &coil(current), 0.0).unwrap().model().clone();
        let (place, drawn) = (model.preload.armature.place, model.preload.armature.magnet_force);
        close(given.stiffness * (place - given.rest_position), drawn, 1e-9);
        let gap = given.core_position - place;
        close(drawn, given.hold_force * (current / (1.0 + gap / given.gap_constant)).powi(2), 1e-9);
        let slope = 2.0 * drawn / (given.gap_constant + gap);
        assert!(slope > 0.05 * given.stiffness && slope < given.stiffness, "{slope}");
        let expected = ((given.stiffness - slope) / given.mass).sqrt() / TAU;
        close(model.frequency, expected, 1e-9);
    }
}
