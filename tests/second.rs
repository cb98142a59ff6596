//! The second contact of a changeover relay: its mirror image, its absence, impacts and their energy. Its motion between contacts that
//! move, its false makes and the smallest gap are compared with another solution in `tests/python/test_second_contact.py`.

use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, BooleanOutput, ExcitationKind, IntegerOutput, RealOutput};
use testing::rig::{Rig, oscillator};
use testing::scenes::accelerated;
use testing::worst;

/// A relay whose moving contact lies open in the middle between both fixed ones.
pub fn changeover(gap: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.second_contact = true;
    scene.contact.overtravel = -gap;
    scene.second.gap = gap;
    scene.contact.damping = 1e-6;
    scene.second.damping = 1e-6;
    scene
}

/// Outputs of one contact, then those of the other.
const PAIRS: [(RealOutput, RealOutput); 8] = [
    (RealOutput::ContactForce, RealOutput::SecondForce),
    (RealOutput::ContactResistance, RealOutput::SecondResistance),
    (RealOutput::ContactLastOpening, RealOutput::SecondLastOpening),
    (RealOutput::ContactLastClosing, RealOutput::SecondLastClosing),
    (RealOutput::StepMinimumForce, RealOutput::SecondMinimumForce),
    (RealOutput::StepMaximumForce, RealOutput::SecondMaximumForce),
    (RealOutput::ChatterLongestFalseMake, RealOutput::SecondLongestFalseMake),
    (RealOutput::ChatterTotalFalseMake, RealOutput::SecondTotalFalseMake),
];

/// Bits of the outputs of both contacts and of their rates.
fn outputs(simulation: &Simulation) -> [Vec<u64>; 2] {
    let bits = |output| {
        let rate = simulation.rate(output).unwrap_or_default();
        [simulation.real(output).to_bits(), (rate + 0.0).to_bits()]
    };
    let [mut first, mut second] = [vec![], vec![]];
    for (a, b) in PAIRS {
        first.extend(bits(a));
        second.extend(bits(b));
    }
    let count = |output| u64::from(simulation.integer(output).unsigned_abs());
    first.push(count(IntegerOutput::ChatterFalseMakes));
    second.push(count(IntegerOutput::SecondFalseMakes));
    first.push(simulation.boolean(BooleanOutput::ContactClosed).into());
    second.push(simulation.boolean(BooleanOutput::SecondClosed).into());
    [first, second]
}

/// With the excitation turned round the contacts change their parts, to the last bit.
#[test]
fn a_mirrored_relay_has_the_same_bits() {
    let gap = 2e-5;
    let mut made = [0; 2];
    for (case, kind) in [ExcitationKind::Sine, ExcitationKind::LogSweep, ExcitationKind::HalfSine, ExcitationKind::None]
        .into_iter()
        .enumerate()
    {
        let mut scene = changeover(gap);
        scene.effects.excitation = kind;
        scene.effects.energy = true;
        scene.effects.axial_force = [AxialForceKind::FromDeflection, AxialForceKind::None][case % 2];
        scene.excitation.amplitude = 300.0;
        scene.excitation.frequency = 700.0;
        scene.excitation.end_frequency = 2000.0;
        scene.excitation.duration = 4e-3;
        for size in [1e-3, 2e-5, 3e-6] {
            let mut image = scene.clone();
            image.excitation.amplitude = -scene.excitation.amplitude;
            let at = |sign: f64, time: f64| {
                accelerated(sign * if kind == ExcitationKind::None { 250.0 } else { 30.0 * (2e3 * time).sin() }, 0.0)
            };
            let mut own = Simulation::new(&scene, &at(1.0, 0.0), 0.0).unwrap();
            let mut other = Simulation::new(&image, &at(-1.0, 0.0), 0.0).unwrap();
            let mut time = 0.0;
            while time < 4e-3 {
                own.step(&at(1.0, time), time, size).unwrap();
                other.step(&at(-1.0, time), time, size).unwrap();
                time = own.time();
                let [first, second] = outputs(&own);
                let [image_of_second, image_of_first] = outputs(&other);
                assert_eq!(first, image_of_first, "{kind:?} {size} s at {time} s");
                assert_eq!(second, image_of_second, "{kind:?} {size} s at {time} s");
                let tip = |simulation: &Simulation| simulation.real(RealOutput::TipDisplacement);
                assert_eq!(tip(&own), -tip(&other), "{kind:?} {size} s at {time} s");
                let balance = |simulation: &Simulation| simulation.real(RealOutput::EnergyBalance);
                assert_eq!(balance(&own), balance(&other), "{kind:?} {size} s at {time} s");
            }
            made[0] += own.integer(IntegerOutput::ChatterFalseMakes);
            made[1] += own.integer(IntegerOutput::SecondFalseMakes);
        }
    }
    assert!(made.iter().all(|made| *made > 10), "{made:?} closings");
}

/// A second contact so far away that it is not reached leaves every bit of the first as it is.
#[test]
fn a_far_second_contact_changes_nothing() {
    for (kind, amplitude) in
        [(ExcitationKind::Sine, 400.0), (ExcitationKind::Random, 0.0), (ExcitationKind::HalfSine, -490.0)]
    {
        let mut scene = Scene::default();
        scene.effects.excitation = kind;
        scene.excitation.amplitude = amplitude;
        scene.excitation.end_frequency = 2000.0;
        scene.excitation.frequency = 1000.0;
        scene.excitation.duration = 2e-3;
        scene.excitation.spectral_density = 60.0;
        for size in [1e-3, 1e-5] {
            let inputs = Inputs::default();
            let mut alone = Simulation::new(&scene, &inputs, 0.0).unwrap();
            let mut with = scene.clone();
            with.effects.second_contact = true;
            with.second.gap = 5e-3;
            let mut with = Simulation::new(&with, &inputs, 0.0).unwrap();
            while alone.time() < 1e-2 {
                for simulation in [&mut alone, &mut with] {
                    simulation.step(&inputs, simulation.time(), size).unwrap();
                }
                let time = alone.time();
                assert_eq!(outputs(&alone)[0], outputs(&with)[0], "{kind:?} {size} s at {time} s");
                let steps = |simulation: &Simulation| simulation.integer(IntegerOutput::SolverSteps);
                assert_eq!(steps(&alone), steps(&with), "{kind:?} {size} s at {time} s");
            }
            assert!(alone.real(RealOutput::ContactLastOpening) > 0.0, "{kind:?} does not open");
        }
    }
}

/// Coefficients of both contacts, which have the root of their radius, N/m^1.5.
fn coefficients(scene: &Scene, model: &Model) -> [f64; 2] {
    let second = (scene.second.curvature_radius / scene.contact.curvature_radius).sqrt();
    [model.law.coefficient, model.law.coefficient * second]
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

/// Nothing adds up over the impacts on contacts of different radius on both sides.
#[test]
fn no_energy_is_made_or_lost_between_two_undamped_stops() {
    const IMPACTS: u32 = 2000;
    let mut scene = changeover(1e-5);
    scene.effects.contact_damping = false;
    scene.second.curvature_radius = 0.3 * scene.contact.curvature_radius;
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
        off = worst(off, (energy(&rig) / start - 1.0).abs());
    }
    assert!(closings.iter().all(|closings| *closings > IMPACTS / 4), "{closings:?}");
    // The bar of the hard cases: relative to the energy as the force is to its scale.
    assert!(off <= scene.solver.tolerance, "{off:e}");
}

/// A contact that is closed at the start has not been made; each make after an interruption counts.
#[test]
fn a_closed_start_is_no_false_make() {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    let run = |scene: &Scene| {
        let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
        simulation.step(&Inputs::default(), 0.0, 5e-3).unwrap();
        let makes = simulation.integer(IntegerOutput::ChatterFalseMakes);
        (simulation.integer(IntegerOutput::ChatterCount), makes)
    };
    assert_eq!(run(&scene), (0, 0));
    scene.excitation.amplitude = 400.0;
    let (interruptions, makes) = run(&scene);
    assert!(interruptions > 2 && (0..=1).contains(&(interruptions - makes)), "{interruptions}, {makes}");
    // The minimum duration is that of makes.
    scene.second.minimum_duration = 1.0;
    assert_eq!(run(&scene), (interruptions, 0));
}

/// The fixed contacts may approach each other, but not meet.
#[test]
fn fixed_contacts_do_not_meet() {
    let mut scene = Scene::default();
    scene.effects.second_contact = true;
    scene.contact.overtravel = -1e-4;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let inputs = |second_displacement| Inputs { second_displacement, ..Inputs::default() };
    // Into the spring, to within 10 um of the first, and held there.
    for (time, displacement) in [(0.0, 3.9e-4), (1e-2, 3.9e-4)] {
        simulation.step(&inputs(displacement), time, 1e-2).unwrap();
    }
    assert!(simulation.real(RealOutput::SecondForce) > 0.0);
    let error = simulation.step(&inputs(4.1e-4), 2e-2, 1e-3).unwrap_err().to_string();
    assert!(error.contains("second.displacement = 0.00041 m") && error.contains("less than 0.00039999"), "{error}");
    // The step that failed has changed nothing.
    simulation.step(&inputs(3.9e-4), 2e-2, 1e-3).unwrap();
}
