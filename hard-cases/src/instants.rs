//! Openings and closings: located independently of the communication points, none missed, no spurious ones.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;

use crate::case::{Check, cases};
use testing::rig::{Rig, compose, oscillator, stop};
use testing::scenes::{largest_difference, shaken};
use testing::worst;

cases! { CASES:
    "Chatter at 41 g in communication steps of 1 µs to 10 ms",
        "a step of 10 ms contains all openings and closings, a step of 1 µs only part of an impact"
        => communication_steps();
    "Communication points at openings and closings, and 10⁻¹⁵ and 10⁻¹² s before and after",
        "an event at the end of a step may be missed or counted twice"
        => points_at_events();
    "Grazing mass: overlaps and misses of 10⁻², 10⁻⁶, 10⁻⁹ of the gap",
        "in grazing contact the gap hardly changes sign, which event location depends on"
        => grazing_mass();
    "Grazing spring: overlaps of 10⁻², 10⁻⁴, 10⁻⁶ and misses of 10⁻², 10⁻⁶, 10⁻¹² of the gap",
        "four modes: the closest approach is anywhere within the single communication step"
        => grazing_spring();
    "Very stiff contact, 10¹⁰ N/m", "a contact of 1 µs in a communication step of 1 ms"
        => stiff_contact();
}

/// Length of the chatter runs, s.
const STOP: f64 = 0.01;

/// Times of the openings and closings, s, of the specimen at 400 m/s2 and 1 kHz, with the given communication points.
fn events(points: impl IntoIterator<Item = f64>) -> Result<Vec<f64>> {
    let mut contact = Simulation::new(&shaken(400.0, 1000.0), &Inputs::default(), 0.0)?;
    let mut events = Vec::new();
    for point in points {
        let time = contact.time();
        contact.step(&Inputs::default(), time, point - time)?;
        events.extend(contact.events().0.map(|event| event.time));
    }
    Ok(events)
}

fn equal(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(move |point| STOP * f64::from(point) / f64::from(count))
}

/// Largest difference, s; infinite if their numbers differ.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() || expected.is_empty() {
        return f64::INFINITY;
    }
    largest_difference(found, expected)
}

fn same_instants(differences: impl IntoIterator<Item = f64>) -> Vec<Check> {
    let difference = differences.into_iter().fold(0.0, worst);
    let property = "the same openings and closings at the same times";
    vec![Check::instants(property, difference)]
}

fn communication_steps() -> Result<Vec<Check>> {
    let expected = events(equal(1))?;
    let mut differences = Vec::new();
    for count in [10, 100, 1000, 10_000] {
        differences.push(difference(&events(equal(count))?, &expected));
    }
    Ok(same_instants(differences))
}

fn points_at_events() -> Result<Vec<Check>> {
    let expected = events(equal(1))?;
    // Each event at a communication point; then a point just before and just after each.
    let mut differences = vec![difference(&events(expected.iter().copied().chain([STOP]))?, &expected)];
    for aside in [1e-15, 1e-12] {
        let around = expected.iter().flat_map(|event| [event - aside, event + aside]);
        differences.push(difference(&events(around.chain([STOP]))?, &expected));
    }
    Ok(same_instants(differences))
}

/// Whether each launch, with its relative excess over the speed that just reaches the contact, touches as expected.
fn grazes(touches: impl Fn(f64) -> Result<bool>, excesses: [f64; 6]) -> Result<Vec<Check>> {
    let mut wrong = 0;
    for excess in excesses {
        wrong += u32::from(touches(excess)? != (excess > 0.0));
    }
    let property = "contacts are detected, misses are not (wrong results of 6)";
    Ok(vec![Check::exact(property, f64::from(wrong), "")])
}

/// A mass on a spring, launched at a contact that it just reaches or misses: its amplitude is `speed / omega`.
fn grazing_mass() -> Result<Vec<Check>> {
    let (gap, omega) = (1e-5, 1e4);
    let touches = |excess: f64| {
        let mode = oscillator(1.0, omega * omega);
        let mut rig = Rig::new(compose(&[mode], stop(1e6), gap, 1e-6, 1.0));
        rig.launch(&[-gap * omega * (1.0 + excess)]);
        // Three quarters of a period: once there.
        rig.run_to(&Inputs::default(), 1.5 * PI / omega)?;
        Ok(rig.state.contact().last_closing > Some(0.0))
    };
    grazes(touches, [1e-2, 1e-6, 1e-9, -1e-9, -1e-6, -1e-2])
}

/// A spring launched at a contact that it just reaches or misses, within one long communication step.
fn grazing_spring() -> Result<Vec<Check>> {
    let (gap, duration) = (1e-5, 1.7e-3);
    let mut scene = Scene::default();
    scene.beam.stiffness_damping = 0.0;
    scene.contact.overtravel = -gap;
    scene.solver.modes = 4;
    let thrown = |scene: &Scene, speed: f64| -> Result<Rig> {
        let mut rig = Rig::new(Model::new(scene, 0.0)?);
        rig.throw(-speed);
        Ok(rig)
    };
    let thrown_until = |scene: &Scene, speed: f64, time: f64| -> Result<_> {
        let mut rig = thrown(scene, speed)?;
        rig.run_to(&Inputs::default(), time)?;
        Ok(rig.state)
    };
    // Amplitude for 1 m/s; the free motion is proportional to the speed.
    let mut far = scene.clone();
    far.contact.overtravel = -5e-3;
    let mut rig = thrown(&far, 1.0)?;
    let (mut nearest, mut highest) = (0.0, 0.0);
    for time in (1..1700).map(|microsecond| 1e-6 * f64::from(microsecond)) {
        rig.run_to(&Inputs::default(), time)?;
        if rig.state.contact().approach > highest {
            (nearest, highest) = (time, rig.state.contact().approach);
        }
    }
    let (mut before, mut after) = (nearest - 2e-6, nearest + 2e-6);
    for _ in 0..40 {
        let middle = f64::midpoint(before, after);
        if thrown_until(&far, 1.0, middle)?.contact().rate > 0.0 {
            before = middle;
        } else {
            after = middle;
        }
    }
    let highest = thrown_until(&far, 1.0, before)?.contact().approach;
    let touches = |excess: f64| {
        let state = thrown_until(&scene, gap / highest * (1.0 + excess), duration)?;
        Ok(state.contact().last_closing > Some(0.0))
    };
    grazes(touches, [1e-2, 1e-4, 1e-6, -1e-12, -1e-6, -1e-2])
}

/// 1 g on a contact of 1e10 N/m: half a period of it, all within one communication step a thousand times longer.
fn stiff_contact() -> Result<Vec<Check>> {
    let (mass, stiffness, speed) = (1e-3_f64, 1e10, 1.0);
    let greatest = speed * (mass * stiffness).sqrt();
    let tolerance = 1e-9;
    let model = compose(&[oscillator(mass, 0.0)], stop(stiffness), 1e-6, tolerance, greatest);
    let mut rig = Rig::new(model);
    rig.launch(&[-speed * mass.sqrt()]);
    rig.run_to(&Inputs::default(), 1e-3)?;
    let (closing, opening) = rig.touch();
    let exact = PI * (mass / stiffness).sqrt();
    let allowed = 10.0 * tolerance + 1e-3 * f64::EPSILON / exact;
    let duration = (((opening - closing) / exact - 1.0).abs(), allowed);
    let rounding = "error of the force and rounding of a time of 1 ms";
    let back = rig.state.modes.first().context("no mode")?.v / mass.sqrt();
    let speed = ((back / speed - 1.0).abs(), tolerance * PI);
    let impulse = "impulse of the force error relative to the momentum";
    Ok(vec![
        Check::new("the contact duration is π √(m/k) (relative)", duration, "", rounding),
        Check::new("rebound speed equals impact speed (relative)", speed, "", impulse),
    ])
}
