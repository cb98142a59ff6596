//! Derivatives of inputs and outputs over communication steps.

use std::f64::consts::TAU;

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use roxmltree::Document;
use testing::near;
use testing::scenes::{LAWS, NEAR, accelerated, check_slope, force_scale, propped_mass, range, shaken, threes};

const FREQUENCY: f64 = 1000.0;

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
            assert!(
                difference.abs() <= 2.0 * scene.solver.tolerance * scale,
                "{law:?} {damping}: {difference}"
            );
            // Quasi-static growth of the force; the lowest mode swings about it with an amplitude of rate / omega.
            let mass = propped_mass(&scene);
            let omega = TAU * whole.real(RealOutput::PreloadFrequency);
            let grown = whole.real(RealOutput::ContactForce) - whole.real(RealOutput::PreloadForce);
            let swing = mass * rate / omega;
            near(
                format_args!("{law:?} {damping}"),
                grown,
                mass * rate * 1e-3,
                2.0 * swing,
            );
        }
    }
}

#[test]
fn the_voltage_follows_the_current() {
    let mut simulation = Simulation::new(&Scene::default(), &Inputs::default(), 0.0).unwrap();
    let mut inputs = Inputs {
        contact_current: 0.1,
        contact_current_rate: 50.0,
        ..Inputs::default()
    };
    simulation.step(&inputs, 0.0, 1e-3).unwrap();
    let resistance = simulation.real(RealOutput::ContactResistance);
    assert_eq!(
        simulation.real(RealOutput::ContactVoltage),
        (0.1 + 50.0 * 1e-3) / (1.0 / resistance)
    );
    let rate = simulation.rate(RealOutput::ContactVoltage).unwrap();
    assert!((rate / (50.0 * resistance) - 1.0).abs() < 1e-12, "{rate}");
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
        let inputs = Inputs {
            contact_current: current,
            contact_current_rate: current,
            ..Inputs::default()
        };
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

const CONTINUOUS: [RealOutput; 8] = [
    RealOutput::ContactForce,
    RealOutput::ContactElasticForce,
    RealOutput::ContactResistance,
    RealOutput::ContactConductance,
    RealOutput::ContactVoltage,
    RealOutput::ContactIndentation,
    RealOutput::TipDisplacement,
    RealOutput::TipVelocity,
];

/// A derivative lies between the slopes just before and just after it, at ends of the integrator's steps and inside them,
/// also where the contact opens and closes. Values are wrong by the tolerance, so slopes by that over the time between two.
#[test]
fn derivatives_of_outputs_are_the_slopes_of_their_courses() {
    const TOLERANCE: f64 = 1e-9;
    for law in LAWS {
        for (amplitude, size) in [(98.0, 1e-6), (98.0, 1e-5), (400.0, 1e-6), (400.0, 1e-5)] {
            let mut scene = shaken(amplitude, FREQUENCY);
            scene.effects.contact_law = law;
            scene.solver.tolerance = TOLERANCE;
            let inputs = Inputs {
                contact_current: 0.1,
                ..Inputs::default()
            };
            let rows = threes(&scene, &inputs, CONTINUOUS, size);
            for (n, output) in CONTINUOUS.into_iter().enumerate() {
                // Where the contact opens these jump: to what `resistance.open` says, which the conductance tells too; or to
                // zero, as the force without damping is not zero yet.
                let jumps = matches!(
                    output,
                    RealOutput::ContactResistance | RealOutput::ContactVoltage | RealOutput::ContactElasticForce
                );
                if jumps && amplitude > 98.0 {
                    continue;
                }
                let noise = 2.0 * TOLERANCE * range(&rows, n) / NEAR;
                let steepest = rows.iter().map(|[_, now, _]| now[n].1.abs()).fold(0.0, f64::max);
                assert!(
                    steepest > 100.0 * noise,
                    "{output:?}: nothing to be seen above {noise:e}"
                );
                for row in &rows {
                    let [before, _, after] = row;
                    // Steepest at no force, where the contact opens or closes between the three.
                    if output == RealOutput::ContactConductance && before[0].0.min(after[0].0) <= 0.0 {
                        continue;
                    }
                    check_slope(
                        row,
                        n,
                        noise,
                        &format!("{law:?}, {amplitude} m/s2, {size} s, {output:?}"),
                    );
                }
            }
        }
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
