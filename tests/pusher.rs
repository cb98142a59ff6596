//! A pusher between clamp and contact: statics and frequency, against the second contact that it is at the tip, and energy.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{BooleanOutput, ContactLawKind, FrictionKind, PusherKind, RealOutput};
use testing::scenes::{bending_stiffness, shaken};
use testing::{close, near};

use crate::spring::reference::{Stretch, frequencies};

/// A contact open by 0.1 mm without a pusher, and the specimen without its rivet.
fn pushed(mut scene: Scene) -> Scene {
    scene.effects.pusher = PusherKind::Prescribed;
    scene.contact.overtravel = -1e-4;
    scene.tip.mass = 0.0;
    scene.tip.rotary_inertia = 0.0;
    scene
}

fn at(pusher_displacement: f64) -> Inputs {
    Inputs { pusher_displacement, ..Inputs::default() }
}

/// Cantilever under forces at the tip and at the pusher (Timoshenko): deflections L^3 / (3 EI), x^2 (3 L - x) / (6 EI) and
/// x^3 / (3 EI) per force, L^2 / (2 EI) and x^2 / (2 EI) per moment of friction at the tip.
#[test]
fn pusher_and_contact_share_the_bending_of_the_spring() {
    let mut scene = pushed(Scene::default());
    scene.environment.gravity = 30.0;
    share_the_bending(&scene);
    scene.effects.friction = FrictionKind::Coulomb;
    scene.friction.coefficient = 0.5;
    scene.friction.initial = 0.8;
    scene.tip.contact_height = 2e-3;
    share_the_bending(&scene);
}

fn share_the_bending(scene: &Scene) {
    let (length, x) = (scene.beam.length, scene.pusher.position);
    let bending = bending_stiffness(scene);
    let load = scene.beam.density * scene.beam.width * scene.beam.thickness * 30.0;
    let lever = if scene.effects.friction == FrictionKind::Coulomb { 0.5 * 0.8 * 2e-3 } else { 0.0 };
    let by_contact = length.powi(3) / (3.0 * bending) + lever * length.powi(2) / (2.0 * bending);
    let across = x * x * (3.0 * length - x) / (6.0 * bending);
    let by_contact_there = across + lever * x * x / (2.0 * bending);
    let by_pusher = x.powi(3) / (3.0 * bending);
    let sag = |x: f64| load * x * x * (6.0 * length * length - 4.0 * length * x + x * x) / (24.0 * bending);
    for place in [3e-4, 6e-4] {
        let simulation = Simulation::new(scene, &at(place), 0.0).unwrap();
        let preload = simulation.model().preload;
        let (force, push) = (preload.force, preload.pusher_force);
        assert!(force > 0.01 && push > force);
        let same = |found, expected| close(place, found, expected, 1e-9);
        let tip = by_contact * force - across * push - sag(length);
        same(preload.deflection, tip);
        same(preload.indentation, scene.contact.overtravel - tip);
        let there = by_contact_there * force - by_pusher * push - sag(x);
        same(push / scene.pusher.stiffness, place + there);
        same(simulation.real(RealOutput::PusherForce), push);
        assert!(simulation.boolean(BooleanOutput::PusherClosed));
    }
    // Too far away, it leaves the spring as it is.
    let simulation = Simulation::new(scene, &at(-1e-4), 0.0).unwrap();
    let preload = simulation.model().preload;
    assert_eq!((preload.force, preload.pusher_force), (0.0, 0.0));
    assert!((preload.pusher_overlap + 1e-4 + sag(x)).abs() < 1e-15);
    assert!(!simulation.boolean(BooleanOutput::PusherClosed));
}

/// At the tip a pusher is a second contact: of linear springs both, as a rough contact of exponent 0.
#[test]
fn a_pusher_at_the_tip_is_a_second_contact() {
    let tolerance = 1e-8;
    let mut scene = pushed(shaken(300.0, 400.0));
    scene.solver.tolerance = tolerance;
    scene.contact.overtravel = -1e-3;
    scene.effects.contact_law = ContactLawKind::Rough;
    scene.contact.stiffness_exponent = 0.0;
    scene.pusher.position = scene.beam.length;
    scene.pusher.stiffness = 1e5;
    scene.pusher.damping = 0.5;
    let gap = 2e-5;
    let mut second = scene.clone();
    second.effects.pusher = PusherKind::None;
    second.effects.second_contact = true;
    second.second.gap = gap;
    second.second.stiffness = 1e5;
    second.second.damping = 0.5 / 1e5;
    let mut a = Simulation::new(&scene, &at(-gap), 0.0).unwrap();
    let mut b = Simulation::new(&second, &Inputs::default(), 0.0).unwrap();
    let mut greatest = 0.0_f64;
    let mut touches = 0;
    let mut before = 0.0;
    for n in 0..1000 {
        let time = f64::from(n) * 1e-5;
        a.step(&at(-gap), time, 1e-5).unwrap();
        b.step(&Inputs::default(), time, 1e-5).unwrap();
        let (push, force) = (a.real(RealOutput::PusherForce), b.real(RealOutput::SecondForce));
        greatest = greatest.max(force);
        touches += u32::from(before == 0.0 && force > 0.0);
        before = force;
        let scale = greatest.max(a.model().force_scale);
        near(time, push, force, 3.0 * tolerance * scale);
        let (least, other) = (a.real(RealOutput::StepMinimumPusherForce), b.real(RealOutput::SecondMinimumForce));
        near(time, least, other, 3.0 * tolerance * scale);
    }
    assert!(touches >= 4 && greatest > 0.1, "{touches} {greatest}");
}

/// What goes in stays, as energy of spring and touches, or is dissipated.
#[test]
fn energy_is_kept_where_the_spring_leaves_the_pusher() {
    let mut scene = pushed(shaken(1500.0, 700.0));
    scene.effects.energy = true;
    scene.solver.tolerance = 1e-8;
    let place = 7e-5;
    let mut simulation = Simulation::new(&scene, &at(place), 0.0).unwrap();
    let (mut left, mut least) = (false, f64::INFINITY);
    for n in 0..1000 {
        // A pusher that moves does work too.
        let inputs = Inputs {
            pusher_displacement: place + 1e-3 * f64::from(n) * 1e-5,
            pusher_displacement_rate: 1e-3,
            ..Inputs::default()
        };
        simulation.step(&inputs, f64::from(n) * 1e-5, 1e-5).unwrap();
        least = least.min(simulation.real(RealOutput::PusherForce));
        left |= !simulation.boolean(BooleanOutput::PusherClosed);
        let size = simulation.model().energy(simulation.state()).abs().max(1e-6);
        let balance = simulation.real(RealOutput::EnergyBalance);
        assert!(balance.abs() < 1e-5 * size.max(1e-5), "{n}: {balance} of {size}");
    }
    assert!(left, "the spring leaves the pusher: {least}");
}

/// That of a beam on an elastic support within its length and another at its end.
#[test]
fn the_frequency_is_that_of_a_beam_with_contact_and_pusher_as_springs() {
    let scene = pushed(Scene::default());
    let model = Simulation::new(&scene, &at(5e-4), 0.0).unwrap().model().clone();
    let (section, x) = (model.section, scene.pusher.position);
    let stretch = |length, support| Stretch {
        support,
        ..Stretch::uniform(length, section.bending_stiffness, section.mass_per_length)
    };
    let stretches = [stretch(x, scene.pusher.stiffness), stretch(section.length - x, model.preload.contact_stiffness)];
    close("Hz", TAU * model.frequency, frequencies(&stretches, f64::INFINITY, 20.0, 1)[0], 1e-6);
}
