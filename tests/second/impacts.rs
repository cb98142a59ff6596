//! Impacts between two stops, against closed forms and another integrator.

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Generator, Law, Mode, Model};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};
use testing::rig::{Rig, oscillator};

use super::changeover;

/// Coefficients (N/m^1.5) and damping times (s) of both contacts.
fn laws(scene: &Scene, model: &Model) -> [(f64, f64); 2] {
    let Law::Power(hertz) = model.law() else { panic!() };
    let second = (scene.second.curvature_radius / scene.contact.curvature_radius).sqrt();
    [
        (hertz.coefficient, hertz.damping),
        (hertz.coefficient * second, scene.second.damping),
    ]
}

/// A free mass flies to and fro between two undamped Hertz stops of different radius. Each impact lasts 2.9432751843 times
/// the greatest indentation over the speed and returns the speed (K. L. Johnson, Contact Mechanics, 1985, section 11.4).
#[test]
fn a_mass_between_two_stops() {
    let (mass, speed) = (2e-5_f64, 0.2);
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut scene = changeover(2e-5);
        scene.effects.contact_damping = false;
        scene.second.curvature_radius = 0.3 * scene.contact.curvature_radius;
        scene.second.gap = 5e-5;
        scene.solver.tolerance = tolerance;
        let model = Model::new(&scene, 0.0).unwrap();
        let depths = laws(&scene, &model).map(|(coefficient, _)| (1.25 * mass * speed * speed / coefficient).powf(0.4));
        let forces = [0, 1].map(|n| laws(&scene, &model)[n].0 * depths[n].powf(1.5));
        let durations = depths.map(|depth| 2.943_275_184_3 * depth / speed);
        let scale = forces[0].max(forces[1]);
        let model = model.with(|parts| {
            parts.modes = vec![oscillator(mass, 0.0)];
            parts.force_scale = scale;
        });
        let mut rig = Rig::new(model);
        rig.launch(&[-speed * mass.sqrt()]);
        let between = (scene.second.gap - scene.contact.overtravel) / speed;
        let mut contact = Simulation::from_state(rig.model, &rig.state);
        let mut to = |time: f64| {
            let start = contact.time();
            contact.step(&Inputs::default(), start, time - start).unwrap();
            [RealOutput::ContactForce, RealOutput::SecondForce].map(|output| contact.real(output))
        };
        let allowed = tolerance * scale;
        let mut touch = -scene.contact.overtravel / speed;
        for impact in 0..20 {
            let side = impact % 2;
            // In the middle of each impact its force is greatest, and stationary.
            let found = to(touch + 0.5 * durations[side]);
            let error = (found[side] - forces[side]).abs();
            assert!(
                error <= allowed && found[1 - side] == 0.0,
                "{tolerance}, impact {impact}: {found:?} N, {} N expected",
                forces[side]
            );
            touch += durations[side] + between;
            assert_eq!(to(touch - 0.5 * between), [0.0, 0.0], "{tolerance}, impact {impact}");
        }
    }
}

/// Forces of both contacts every 10 us, by the classical Runge-Kutta method with steps of `h` (s).
fn by_runge_kutta(scene: &Scene, inputs: impl Fn(f64) -> Inputs, end: u32, h: f64) -> Vec<[f64; 2]> {
    let model = Model::new(scene, 0.0).unwrap();
    let generator = Generator::new(scene).unwrap();
    let [first, second] = laws(scene, &model);
    let preload = model.preload();
    let law = |(coefficient, damping): (f64, f64), d: f64, rate: f64| {
        let root = coefficient * d.max(0.0).sqrt();
        (root * (d + 1.5 * damping * rate)).max(0.0)
    };
    let modes: &[Mode] = model.modes();
    let forces = |t: f64, y: &[[f64; 2]]| {
        let driven = inputs(t);
        let (mut d, mut rate) = (driven.support_displacement, driven.support_displacement_rate);
        for (mode, [q, v]) in modes.iter().zip(y) {
            d -= mode.tip * q;
            rate -= mode.tip * v;
        }
        let e = driven.second_displacement - scene.second.gap - d;
        let second = law(second, e, driven.second_displacement_rate - rate);
        [law(first, preload.indentation + d, rate), second]
    };
    let slopes = |t: f64, y: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let [first, second] = forces(t, y);
        let base = inputs(t).base_acceleration + generator.acceleration(t);
        let slope = |(mode, [q, v]): (&Mode, &[f64; 2])| {
            let load = mode.tip * (first - second - preload.force) - mode.participation * base;
            [*v, load - mode.damping * v - mode.omega_squared * q]
        };
        modes.iter().zip(y).map(slope).collect()
    };
    let moved = |y: &[[f64; 2]], k: &[[f64; 2]], h: f64| -> Vec<[f64; 2]> {
        y.iter()
            .zip(k)
            .map(|(y, k)| [y[0] + h * k[0], y[1] + h * k[1]])
            .collect()
    };
    let mut y = vec![[0.0; 2]; modes.len()];
    let every = (1e-5 / h).round();
    let mut course = Vec::new();
    for point in 0..end {
        let start = f64::from(point) * 1e-5;
        let mut part = 0.0;
        while part < every {
            let t = start + part * h;
            let a = slopes(t, &y);
            let b = slopes(t + 0.5 * h, &moved(&y, &a, 0.5 * h));
            let c = slopes(t + 0.5 * h, &moved(&y, &b, 0.5 * h));
            let d = slopes(t + h, &moved(&y, &c, h));
            for (k, share) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
                y = moved(&y, &k, share * h / 6.0);
            }
            part += 1.0;
        }
        course.push(forces(start + 1e-5, &y));
    }
    course
}

/// Points of time, 10 us apart.
const ROWS: u32 = 200;

/// The spring between two contacts of different radius and damping, both moving, against the classical Runge-Kutta method
/// on the same modes, whose own error is seen from steps of twice the length.
#[test]
fn a_spring_between_two_contacts() {
    for (kind, second_rate) in [(ExcitationKind::Sine, 0.0), (ExcitationKind::Random, 2e-3)] {
        let mut scene = changeover(1e-5);
        scene.effects.excitation = kind;
        scene.excitation.amplitude = 250.0;
        scene.excitation.frequency = 500.0;
        scene.excitation.end_frequency = 1500.0;
        scene.excitation.spectral_density = 60.0;
        scene.environment.gravity = 9.81;
        scene.effects.axial_force = relay_contact::variables::AxialForceKind::None;
        scene.second.curvature_radius = 2e-3;
        scene.second.damping = 4e-6;
        scene.solver.modes = 4;
        scene.solver.tolerance = 1e-5;
        let inputs = |time: f64| Inputs {
            support_displacement: 1e-3 * time,
            support_displacement_rate: 1e-3,
            second_displacement: second_rate * time,
            second_displacement_rate: second_rate,
            ..Inputs::default()
        };
        let [fine, coarse] = [2e-8, 4e-8].map(|h| by_runge_kutta(&scene, inputs, ROWS, h));
        let mut simulation = Simulation::new(&scene, &inputs(0.0), 0.0).unwrap();
        let mut scale = simulation.model().force_scale();
        let (mut closed, mut error, mut unsure) = ([0, 0], 0.0_f64, 0.0_f64);
        for (row, (fine, coarse)) in fine.iter().zip(&coarse).enumerate() {
            let time = simulation.time();
            simulation
                .step(&inputs(time), time, 1e-5 * (row as f64 + 1.0) - time)
                .unwrap();
            let found = [RealOutput::ContactForce, RealOutput::SecondForce].map(|output| simulation.real(output));
            for n in 0..2 {
                closed[n] += u32::from(found[n] > 0.0);
                scale = scale.max(found[n]);
                error = error.max((found[n] - fine[n]).abs() / scale);
                unsure = unsure.max((fine[n] - coarse[n]).abs() / scale);
            }
        }
        println!("{kind:?}: {error:e}, reference {unsure:e}, closed at {closed:?} of {ROWS} points");
        assert!(closed.iter().all(|closed| *closed > 10), "{kind:?}: {closed:?}");
        // A method of first order at each impact is wrong by as much as it changes from twice the step.
        assert!(
            error <= scene.solver.tolerance + unsure,
            "{kind:?}: {error:e}, {unsure:e}"
        );
        assert!(unsure < 1e-4, "{kind:?}: the reference is wrong by {unsure:e}");
    }
}

/// Nothing adds up over the impacts on both sides.
#[test]
fn no_energy_is_made_or_lost_between_two_undamped_stops() {
    energy_is_kept_over(2000);
}

#[test]
#[ignore = "ten minutes in release"]
fn no_energy_is_made_or_lost_in_a_million_impacts() {
    energy_is_kept_over(1_000_000);
}

fn energy_is_kept_over(impacts: u32) {
    let mut scene = changeover(1e-5);
    scene.effects.contact_damping = false;
    scene.beam.stiffness_damping = 0.0;
    scene.solver.modes = 6;
    scene.solver.tolerance = 1e-6;
    let model = Model::new(&scene, 0.0).unwrap();
    let mut rig = Rig::new(model);
    let velocities: Vec<f64> = rig
        .model
        .modes()
        .iter()
        .map(|mode| -0.05 * mode.participation)
        .collect();
    rig.launch(&velocities);
    let [first, second] = laws(&scene, &rig.model);
    let energy = |rig: &Rig| {
        let modes = rig.model.modes().iter().zip(&rig.state.modes);
        let beam: f64 = modes
            .map(|(mode, at)| 0.5 * (at.v * at.v + mode.omega_squared * at.q * at.q))
            .sum();
        let tip: f64 = rig
            .model
            .modes()
            .iter()
            .zip(&rig.state.modes)
            .map(|(mode, at)| mode.tip * at.q)
            .sum();
        let stored = |(coefficient, _): (f64, f64), d: f64| 0.4 * coefficient * d.max(0.0).powf(2.5);
        beam + stored(first, scene.contact.overtravel - tip) + stored(second, tip - scene.second.gap)
    };
    let start = energy(&rig);
    let (mut closings, mut last, mut point, mut off) = ([0, 0], [None; 2], 0_u32, 0.0_f64);
    while closings[0] + closings[1] < impacts {
        point += 1;
        rig.run_to(&Inputs::default(), 1e-5 * f64::from(point)).unwrap();
        for (n, link) in rig.state.links.iter().take(2).enumerate() {
            let now = link.last_closing;
            if now > last[n] {
                (closings[n], last[n]) = (closings[n] + 1, now);
            }
        }
        off = off.max((energy(&rig) / start - 1.0).abs());
    }
    println!("{off:e}, closings {closings:?}");
    assert!(closings.iter().all(|closings| *closings > impacts / 4), "{closings:?}");
    // The bar of the hard cases: relative to the energy as the force is to its scale.
    assert!(off <= scene.solver.tolerance, "{off:e}");
}
