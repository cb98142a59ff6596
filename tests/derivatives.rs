//! Derivatives of inputs and outputs over communication steps.

use std::f64::consts::TAU;

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput, ResistanceKind};
use roxmltree::Document;
use testing::near;
use testing::scenes::{LAWS, accelerated, force_scale, propped_mass, shaken};

use crate::equilibrium::{on_spring, parallel};
use crate::friction::rubbing;
use crate::second::changeover;

/// However a ramp is cut into communication steps, it is the same ramp.
#[test]
fn a_ramp_does_not_depend_on_where_it_is_cut() {
    for law in LAWS {
        for damping in [8.063e-5, 0.0] {
            let mut scene = Scene::default();
            scene.effects.contact_law = law;
            scene.beam.stiffness_damping = damping;
            scene.contact.damping = damping;
            scene.solver.tolerance = 1e-8;
            let rate = 2e5;
            let ramp = |time: f64| accelerated(rate * time, rate);
            let [whole, parts] = [1e-4_f64, 7e-6].map(|step| {
                let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                let mut time = 0.0;
                while time < 1e-3 - 1e-12 {
                    let size = step.min(1e-3 - time);
                    simulation.step(&ramp(time), time, size).unwrap();
                    time = simulation.time();
                }
                simulation
            });
            let scale = force_scale(&scene);
            let difference = whole.real(RealOutput::ContactForce) - parts.real(RealOutput::ContactForce);
            // Each is right to the tolerance.
            assert!(difference.abs() <= 2.0 * scene.solver.tolerance * scale, "{law:?} {damping}: {difference}");
            // Quasi-static growth of the force; the lowest mode swings about it with an amplitude of rate / omega.
            let mass = propped_mass(&scene);
            let omega = TAU * whole.real(RealOutput::PreloadFrequency);
            let grown = whole.real(RealOutput::ContactForce) - whole.real(RealOutput::PreloadForce);
            let swing = mass * rate / omega;
            near(format_args!("{law:?} {damping}"), grown, mass * rate * 1e-3, 2.0 * swing);
        }
    }
}

#[test]
fn the_voltage_follows_the_current() {
    let mut simulation = Simulation::new(&Scene::default(), &Inputs::default(), 0.0).unwrap();
    let mut inputs = Inputs { contact_current: 0.1, contact_current_rate: 50.0, ..Inputs::default() };
    simulation.step(&inputs, 0.0, 1e-3).unwrap();
    let resistance = simulation.real(RealOutput::ContactResistance);
    assert_eq!(simulation.real(RealOutput::ContactVoltage), (0.1 + 50.0 * 1e-3) / (1.0 / resistance));
    let rate = simulation.rate(RealOutput::ContactVoltage).unwrap();
    assert!((rate / (50.0 * resistance) - 1.0).abs() < 1e-12, "{rate}");
    assert_eq!(simulation.rate(RealOutput::ContactTemperature), Some(0.0), "it does not heat");
    // Without a derivative it is held.
    inputs.hold();
    simulation.step(&inputs, 1e-3, 1e-3).unwrap();
    assert_eq!(simulation.real(RealOutput::ContactVoltage), 0.1 / (1.0 / resistance));
    assert_eq!(simulation.rate(RealOutput::ContactVoltage), Some(0.0));
}

/// A current through an open contact is the source's affair: without a limit 10 A over 1 GOhm would be 1e10 V.
#[test]
fn an_open_contact_has_the_voltage_of_the_source_at_most() {
    let mut scene = Scene::default();
    scene.contact.overtravel = -2e-5;
    for (limit, current, expected) in [
        (scene.contact.open_voltage, 10.0, 1e3),
        (scene.contact.open_voltage, -10.0, -1e3),
        (6.0, 10.0, 6.0),
        (6.0, 1e-9, 1.0),
        (1e21, 1e6, 1e15),
    ] {
        scene.contact.open_voltage = limit;
        let inputs = Inputs { contact_current: current, contact_current_rate: current, ..Inputs::default() };
        let mut simulation = Simulation::new(&scene, &inputs, 0.0).unwrap();
        let voltage = simulation.real(RealOutput::ContactVoltage);
        assert!((voltage / expected - 1.0).abs() < 1e-15, "{current} A: {voltage} V");
        // Where it is limited it does not grow with the current.
        simulation.step(&inputs, 0.0, 1e-6).unwrap();
        let rate = simulation.rate(RealOutput::ContactVoltage).unwrap();
        let expected = if expected.abs() < limit { expected } else { 0.0 };
        near(format_args!("{current} A"), rate, expected, 1e-15 * expected.abs());
    }
}

/// Time between the points at which values and rates are compared, s.
const NEAR: f64 = 1e-7;

/// Values and rates of outputs at three points of time, each [`NEAR`] after the one before.
type Three = [Vec<(f64, f64)>; 3];

/// A derivative lies between the slopes just before and just after it, at ends of the integrator's steps and inside them. Values are
/// wrong by the tolerance, so slopes by that over the time between two. Looked at every `size` seconds over 2 ms, where the last of
/// the points so far `counts`, while the fixed contact moves at a speed (m/s) and the current falls by a quarter.
fn check_slopes(
    case: &str,
    mut scene: Scene,
    outputs: &[RealOutput],
    (size, speed): (f64, f64),
    counts: impl Fn(RealOutput, &[Three]) -> bool,
) {
    scene.solver.tolerance = 1e-9;
    let (current, fall) = (-1.0, 125.0);
    let mut inputs = Inputs {
        contact_current: current,
        contact_current_rate: fall,
        support_displacement_rate: speed,
        ..Inputs::default()
    };
    let mut simulation = Simulation::new(&scene, &inputs, 0.0).unwrap();
    let mut rows: Vec<Three> = Vec::new();
    while simulation.time() < 2e-3 {
        rows.push([size - 2.0 * NEAR, NEAR, NEAR].map(|step| {
            inputs.support_displacement = speed * simulation.time();
            inputs.contact_current = current + fall * simulation.time();
            simulation.step(&inputs, simulation.time(), step).unwrap();
            let read = |output: &RealOutput| (simulation.real(*output), simulation.rate(*output).unwrap());
            outputs.iter().map(read).collect()
        }));
    }
    for (n, output) in outputs.iter().enumerate() {
        let counting = (1..=rows.len()).filter(|end| counts(*output, &rows[..*end]));
        let counting: Vec<_> = counting.map(|end| rows[end - 1].each_ref().map(|at| at[n])).collect();
        assert!(counting.len() as f64 > 2e-4 / size, "{case}, {output:?}: {}", counting.len());
        let values = || counting.iter().map(|[_, now, _]| now.0);
        let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
        let noise = 2.0 * scene.solver.tolerance * range / NEAR;
        let steepest = counting.iter().map(|[_, now, _]| now.1.abs()).fold(0.0, f64::max);
        assert!(steepest > 100.0 * noise, "{case}, {output:?}: nothing to be seen above {noise:e}");
        for [before, now, after] in counting {
            let slopes = [now.0 - before.0, after.0 - now.0].map(|difference| difference / NEAR);
            let (low, high) = (slopes[0].min(slopes[1]), slopes[0].max(slopes[1]));
            assert!(
                (low - noise..=high + noise).contains(&now.1),
                "{case}, {size} s, {output:?}: {} not in {slopes:?}",
                now.1
            );
        }
    }
}

/// Also where the contact opens and closes.
#[test]
fn derivatives_of_outputs_are_the_slopes_of_their_courses() {
    let outputs = [
        RealOutput::ContactForce,
        RealOutput::ContactConductance,
        RealOutput::ContactIndentation,
        RealOutput::TipDisplacement,
        RealOutput::TipVelocity,
        // Where the contact opens these jump: to what `resistance.open` says, which the conductance tells too; or to zero, as the
        // force without damping is not zero yet.
        RealOutput::ContactResistance,
        RealOutput::ContactVoltage,
        RealOutput::ContactElasticForce,
    ];
    let [power, holm, barber] = [ResistanceKind::PowerLaw, ResistanceKind::Holm, ResistanceKind::Barber];
    for (law, resistance) in LAWS.into_iter().zip([power, barber, holm, power]) {
        for (amplitude, size) in [(98.0, 1e-6), (98.0, 1e-5), (400.0, 1e-6), (400.0, 1e-5)] {
            let mut scene = shaken(amplitude, 1000.0);
            (scene.effects.contact_law, scene.effects.resistance) = (law, resistance);
            // Steepest at no force, where the contact opens or closes between the three.
            let counts = |output, rows: &[Three]| {
                output != RealOutput::ContactConductance || rows.last().unwrap().iter().all(|at| at[0].0 > 0.0)
            };
            let outputs = if amplitude > 98.0 { &outputs[..5] } else { &outputs };
            check_slopes(&format!("{law:?}, {amplitude} m/s2"), scene, outputs, (size, 0.0), counts);
        }
    }
}

#[test]
fn derivatives_with_friction_are_slopes() {
    let outputs = [
        RealOutput::ContactSlip,
        RealOutput::ContactForce,
        RealOutput::ContactTangentialForce,
        RealOutput::ContactSlipDistance,
        RealOutput::FrictionEnergy,
    ];
    for (size, later, damping) in [(1e-6, 21, 8.063e-5), (1e-5, 3, 8.063e-5), (1e-5, 3, 0.0)] {
        let mut scene = rubbing(shaken(98.0, 1000.0));
        scene.contact.damping = damping;
        // The slope of the friction force jumps where it begins or ceases to slip, and the spring answers within microseconds: so many
        // points later.
        let counts = |_, rows: &[Three]| {
            let slips = |at: &Vec<(f64, f64)>| at[0].1 != 0.0;
            let recent = &rows[rows.len().saturating_sub(later)..];
            rows.len() > later && recent.iter().flatten().all(|at| slips(at) == slips(&recent[0][0]))
        };
        check_slopes(&format!("{damping} s"), scene, &outputs, (size, 0.0), counts);
    }
}

#[test]
fn derivatives_at_a_second_contact_are_slopes() {
    let outputs = [
        RealOutput::SecondForce,
        RealOutput::SecondConductance,
        RealOutput::ContactIndentation,
        RealOutput::TipDisplacement,
        RealOutput::TipVelocity,
    ];
    let mut scene = changeover(2e-5);
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = -250.0;
    scene.excitation.frequency = 300.0;
    scene.second.damping = 2e-5;
    // In the second contact all the while.
    let closed = |_, rows: &[Three]| rows.last().unwrap().iter().all(|at| at[0].0 > 0.0);
    for size in [1e-6, 1e-5] {
        check_slopes("second contact", scene.clone(), &outputs, (size, 0.0), closed);
    }
}

#[test]
fn derivatives_of_warm_contacts_on_springs_are_slopes() {
    let outputs = [
        RealOutput::TipDisplacement,
        RealOutput::TipVelocity,
        RealOutput::FixedDisplacement,
        RealOutput::FixedVelocity,
        RealOutput::ContactConductance,
        RealOutput::ContactTemperature,
    ];
    let mut scene = shaken(200.0, 1000.0);
    parallel(&mut scene);
    on_spring(&mut scene);
    scene.effects.heating = true;
    scene.resistance.film = 5e-4;
    scene.parallel.curvature_radius = 5e-3;
    for sizes in [(1e-6, 0.0), (1e-5, 0.0), (1e-5, 1e-2)] {
        // From rest the rates are at first as small as the tolerance makes them.
        let moves = |_, rows: &[Three]| rows.len() as f64 * sizes.0 > 2e-4;
        check_slopes("on springs", scene.clone(), &outputs, sizes, moves);
    }
}

#[test]
fn outputs_declared_as_continuous_have_a_derivative_and_no_others() {
    let simulation = Simulation::new(&Scene::default(), &Inputs::default(), 0.0).unwrap();
    let document = Document::parse(MODEL_DESCRIPTION).unwrap();
    for output in RealOutput::ALL {
        let name = output.variable().name;
        let mut all = document.descendants();
        let declared = all.find(|node| node.attribute("name") == Some(name)).unwrap();
        let continuous = declared.attribute("variability") == Some("continuous");
        let rate = simulation.rate(*output);
        assert_eq!(rate, continuous.then_some(0.0), "{name} at the start");
    }
}

/// Where an input changes at each point an integration step ends there, and rates follow from the laws. Seen in the slopes before: a
/// parabola through three values misses the slope at its end by less than what the last two slopes differ by.
#[test]
fn derivatives_with_friction_where_an_input_changes_are_slopes() {
    const OUTPUTS: [RealOutput; 4] = [
        RealOutput::ContactTangentialForce,
        RealOutput::ContactSlip,
        RealOutput::ContactSlipDistance,
        RealOutput::FrictionEnergy,
    ];
    for damping in [8.063e-5, 0.0] {
        let mut scene = rubbing(Scene::default());
        (scene.contact.damping, scene.solver.tolerance) = (damping, 1e-10);
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut rows = Vec::new();
        let size = 1e-5;
        while simulation.time() < 2e-3 {
            let start = simulation.time();
            let inputs = accelerated(98.0 * (TAU * 1e3 * start).sin(), 0.0);
            let mut before = simulation.clone();
            simulation.step(&inputs, start, size).unwrap();
            assert_eq!(simulation.state().time, simulation.time());
            let read = |of: &Simulation| OUTPUTS.map(|output| (of.real(output), of.rate(output).unwrap()));
            let three = [size - 2.0 * NEAR, NEAR, NEAR].map(|step| {
                before.step(&inputs, before.time(), step).unwrap();
                read(&before)
            });
            rows.push((three, read(&simulation)));
        }
        for (n, output) in OUTPUTS.into_iter().enumerate() {
            let greatest = |of: fn((f64, f64)) -> f64| rows.iter().map(|row| of(row.1[n]).abs()).fold(0.0, f64::max);
            // Values are wrong by a share of the force that presses, five times what rubs; the parabola takes four of them.
            let noise = 20.0 * scene.solver.tolerance * greatest(|at| at.0) / NEAR;
            assert!(greatest(|at| at.1) > 100.0 * noise, "{output:?}");
            let mut seen = [0, 0];
            for (k, (three, now)) in rows.iter().enumerate() {
                let slips = now[1].1 != 0.0;
                if three.iter().any(|at| (at[1].1 != 0.0) != slips) {
                    continue;
                }
                seen[usize::from(slips)] += 1;
                let [first, second, last] = three.map(|at| at[n].0);
                let slopes = [second - first, last - second].map(|difference| difference / NEAR);
                let bend = slopes[1] - slopes[0];
                let case = format_args!("{damping} s, {output:?} {k}, slips: {slips}");
                near(case, now[n].1, slopes[1] + 0.5 * bend, bend.abs() + noise);
            }
            assert!(seen[0] > 20 && seen[1] > 20, "{seen:?}");
        }
    }
}
