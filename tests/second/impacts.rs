//! Impacts between two stops, against closed forms.

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Law, Model};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::rig::{Rig, oscillator};

use super::changeover;

/// Coefficients of both contacts, N/m^1.5.
fn coefficients(scene: &Scene, model: &Model) -> [f64; 2] {
    let Law::Power(hertz) = &model.law else { panic!() };
    let second = (scene.second.curvature_radius / scene.contact.curvature_radius).sqrt();
    [hertz.coefficient, hertz.coefficient * second]
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
        let coefficients = coefficients(&scene, &model);
        let depths = coefficients.map(|coefficient| (1.25 * mass * speed * speed / coefficient).powf(0.4));
        let forces = [0, 1].map(|n| coefficients[n] * depths[n].powf(1.5));
        let durations = depths.map(|depth| 2.943_275_184_3 * depth / speed);
        let scale = forces[0].max(forces[1]);
        let model = model.with(|model| {
            model.modes = vec![oscillator(mass, 0.0)];
            model.force_scale = scale;
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

/// Nothing adds up over the impacts on both sides.
#[test]
fn no_energy_is_made_or_lost_between_two_undamped_stops() {
    const IMPACTS: u32 = 2000;
    let mut scene = changeover(1e-5);
    scene.effects.contact_damping = false;
    scene.beam.stiffness_damping = 0.0;
    scene.solver.modes = 6;
    scene.solver.tolerance = 1e-6;
    let model = Model::new(&scene, 0.0).unwrap();
    let mut rig = Rig::new(model);
    rig.throw(-0.05);
    let [_, second] = coefficients(&scene, &rig.model);
    // Open at rest: the modes, the first contact and the second.
    let energy = |rig: &Rig| {
        let indentation = -rig.state.contact().approach - scene.second.gap;
        rig.energy() + 0.4 * second * indentation.max(0.0).powf(2.5)
    };
    let start = energy(&rig);
    let (mut closings, mut last, mut point, mut off) = ([0, 0], [None; 2], 0_u32, 0.0_f64);
    while closings[0] + closings[1] < IMPACTS {
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
    assert!(closings.iter().all(|closings| *closings > IMPACTS / 4), "{closings:?}");
    // The bar of the hard cases: relative to the energy as the force is to its scale.
    assert!(off <= scene.solver.tolerance, "{off:e}");
}
