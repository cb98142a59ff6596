//! Openings and closings: found wherever the communication points are, none missed, none made up.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use relay_contact::contact::law::Law;
use relay_contact::contact::linear::Linear;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::ExcitationKind;

use super::common::{Rig, compose, oscillator};
use super::{Case, Check};

pub const CASES: &[Case] = &[communication_steps, point_at_an_opening, grazing, stiff_contact];

/// Instants are promised to this, s.
const PROMISED: f64 = 1e-9;

/// Length of the runs, s.
const STOP: f64 = 0.01;

/// Openings and closings, s, of the specimen at 400 m/s2 and 1 kHz, with communication points at the instants.
fn events(points: impl IntoIterator<Item = f64>) -> Result<Vec<f64>> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = 400.0;
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
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

/// Largest difference, s; infinite where there are more or fewer of them.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() || expected.is_empty() {
        return f64::INFINITY;
    }
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

fn communication_steps(_: bool) -> Result<Vec<Check>> {
    let expected = events(equal(1))?;
    let mut worst = 0.0_f64;
    for count in [10, 100, 1000, 10_000] {
        worst = worst.max(difference(&events(equal(count))?, &expected));
    }
    Ok(vec![Check {
        case: "Chatter at 41 g in communication steps of 1 µs to 10 ms",
        hard: "a step of 10 ms holds all openings and closings at once, one of 1 µs a part of a blow".to_owned(),
        property: "the same openings and closings at the same instants",
        measured: worst,
        allowed: PROMISED,
        unit: "s",
    }])
}

fn point_at_an_opening(_: bool) -> Result<Vec<Check>> {
    let expected = events(equal(1))?;
    // Each event at a communication point; then a point just before and just after each.
    let mut worst = difference(&events(expected.iter().copied().chain([STOP]))?, &expected);
    for aside in [1e-15, 1e-12] {
        let around = expected.iter().flat_map(|event| [event - aside, event + aside]);
        worst = worst.max(difference(&events(around.chain([STOP]))?, &expected));
    }
    Ok(vec![Check {
        case: "Communication points exactly at openings and closings, and 10⁻¹⁵ and 10⁻¹² s beside",
        hard: "an event at the end of a step is easily lost, or met twice".to_owned(),
        property: "the same openings and closings at the same instants",
        measured: worst,
        allowed: PROMISED,
        unit: "s",
    }])
}

/// A mass on a spring, thrown at a contact that it just reaches or just misses: it gets `speed / omega` far.
fn grazing(_: bool) -> Result<Vec<Check>> {
    let (gap, omega) = (1e-5, 1e4);
    let mut wrong = 0;
    for (excess, touches) in [
        (1e-2, true),
        (1e-6, true),
        (1e-9, true),
        (-1e-9, false),
        (-1e-6, false),
        (-1e-2, false),
    ] {
        let law = pushing(1e6);
        let mut rig = Rig::new(compose(&[oscillator(1.0, omega * omega)], law, gap, 1e-6, 1.0));
        rig.launch(&[-gap * omega * (1.0 + excess)]);
        // Three quarters of a period: once there.
        rig.run_to(&Inputs::default(), 1.5 * PI / omega)?;
        wrong += u32::from((rig.state.last_closing > 0.0) != touches);
    }
    Ok(vec![Check {
        case: "Grazing: a throw that overlaps or misses by 10⁻², 10⁻⁶, 10⁻⁹ of the gap",
        hard: "the force does not change sign where a touch is sought by its sign".to_owned(),
        property: "a touch is met, a miss is not (wrong answers of 6)",
        measured: f64::from(wrong),
        allowed: 0.0,
        unit: "",
    }])
}

/// A linear contact that only pushes, of a stiffness (N/m).
fn pushing(stiffness: f64) -> Law {
    Law::Linear(Linear {
        stiffness,
        damping: 0.0,
        offset: 0.0,
        bonded: false,
    })
}

/// 1 g on a contact of 1e10 N/m: half a period of it, all within one communication step a thousand times longer.
fn stiff_contact(_: bool) -> Result<Vec<Check>> {
    let (mass, stiffness, speed) = (1e-3_f64, 1e10, 1.0);
    let greatest = speed * (mass * stiffness).sqrt();
    let tolerance = 1e-9;
    let model = compose(&[oscillator(mass, 0.0)], pushing(stiffness), 1e-6, tolerance, greatest);
    let mut rig = Rig::new(model);
    rig.launch(&[-speed * mass.sqrt()]);
    rig.run_to(&Inputs::default(), 1e-3)?;
    let lasted = rig.state.last_opening - rig.state.last_closing;
    let exact = PI * (mass / stiffness).sqrt();
    let hard = || "a contact of 1 µs in a communication step of 1 ms".to_owned();
    let back = rig.state.modes.first().context("no mode")?.v / mass.sqrt();
    Ok(vec![
        Check {
            case: "Very stiff contact, 10¹⁰ N/m",
            hard: hard(),
            property: "it lasts π √(m/k) (part of it)",
            measured: (lasted / exact - 1.0).abs(),
            // The error of the force and the rounding of an instant of 1 ms.
            allowed: 10.0 * tolerance + 1e-3 * f64::EPSILON / exact,
            unit: "",
        },
        Check {
            case: "Very stiff contact, 10¹⁰ N/m",
            hard: hard(),
            property: "the speed comes back whole (part of it)",
            measured: (back / speed - 1.0).abs(),
            // Impulse of a force wrong by the tolerance while it lasts, over the momentum.
            allowed: tolerance * PI,
            unit: "",
        },
    ])
}
