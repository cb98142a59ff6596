//! Contacts side by side: against one contact of twice the constant, by beam formulas, and what counts as interrupted.

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Model, reduced_modulus};
use relay_contact::scene::Scene;
use relay_contact::scene::spring::{PointMass, Segments, Shape};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{
    AxialForceKind, BooleanOutput, ContactLawKind, IntegerOutput, RealOutput, ResistanceKind,
};
use testing::scenes::{course, force_scale, forces, largest_difference, shaken, tip_stiffness};
use testing::springs::{self, modes_of, segment, spring_file};
use testing::{close, near, worst};

/// The scene with a parallel contact, equal to the first.
fn pair(mut scene: Scene) -> Scene {
    scene.effects.parallel_contact = true;
    scene.parallel.curvature_radius = scene.contact.curvature_radius;
    scene.parallel.damping = scene.contact.damping;
    scene
}

/// With one contact of twice the constant: Hertz has the root of the radius.
fn doubled(mut scene: Scene) -> Scene {
    scene.contact.curvature_radius *= 4.0;
    scene
}

/// The uniform spring forked at a share of its length.
fn forked(mut scene: Scene, share: f64) -> Scene {
    scene.spring = springs::forked(&scene, share);
    scene
}

/// Forces of both contacts.
const BOTH: [RealOutput; 2] = [RealOutput::ContactForce, RealOutput::ParallelForce];

#[test]
fn two_equal_contacts_are_one_of_twice_the_constant() {
    let tolerance = 1e-7;
    let mut scene = shaken(400.0, 900.0);
    scene.solver.tolerance = tolerance;
    scene.solver.modes = 24;
    for fork in [None, Some(0.4)] {
        let spring = |scene: Scene| fork.map_or(scene.clone(), |share| forked(scene.clone(), share));
        let (expected, one) = course(&spring(doubled(scene.clone())), 1e-5, 1000, [RealOutput::ContactForce]);
        let (found, both) = course(&spring(pair(scene.clone())), 1e-5, 1000, BOTH);
        let largest = expected.iter().flatten().copied().fold(force_scale(&scene), f64::max);
        // Both simulations keep the tolerance, each of the forces of the two by itself.
        let allowed = 3.0 * tolerance * largest;
        for (n, ([sum], [first, other])) in expected.iter().zip(&found).enumerate() {
            assert!((first - other).abs() <= allowed, "{fork:?} {n}: {first} {other}");
            near(format_args!("{fork:?} {n}"), first + other, *sum, allowed);
        }
        assert!(one.real(RealOutput::ContactLastOpening) > 0.0);
        let frequencies = [&one, &both].map(|simulation| simulation.real(RealOutput::PreloadFrequency));
        assert!((frequencies[0] / frequencies[1] - 1.0).abs() < 1e-6, "{frequencies:?}");
    }
}

/// On a fixed contact that springs, too: a blow of either excites both springs, whichever is the stiffer.
#[test]
fn two_different_contacts_on_one_tip_may_change_places() {
    let mut scene = shaken(2000.0, 900.0);
    scene.contact.damping = 1e-6;
    let mut scene = pair(scene);
    scene.fixed_spring = springs::uniform_spring(&scene, 1.0, 1.5);
    scene.fixed.stiffness_damping = 1e-7;
    scene.effects.contact_law = ContactLawKind::Rough;
    (scene.contact.stiffness, scene.parallel.stiffness) = (1e7, 1e4);
    let mut changed = scene.clone();
    (changed.contact.stiffness, changed.parallel.stiffness) = (1e4, 1e7);
    let (expected, _) = course(&scene, 1e-5, 300, BOTH);
    let (found, last) = course(&changed, 1e-5, 300, BOTH);
    assert!(last.real(RealOutput::ParallelLastOpening) > 0.0);
    let greatest = expected.iter().flatten().copied().fold(force_scale(&scene), f64::max);
    for (n, (expected, [first, other])) in expected.iter().zip(found).enumerate() {
        for (expected, found) in expected.iter().zip([other, first]) {
            near(n, found, *expected, 3e-6 * greatest);
        }
    }
    // Too few modes are told, whichever is the stiffer.
    for modes in [12, 20] {
        changed.solver.modes = modes;
        let (found, last) = course(&changed, 1e-5, 300, BOTH);
        let missed = expected.iter().zip(found).map(|(expected, found)| (expected[0] - found[1]).abs() / greatest);
        let (missed, told) = (missed.fold(0.0, worst), last.real(RealOutput::SolverForceError));
        assert!(missed > 1e-4 && told > missed, "{modes}: {missed} {told}");
    }
}

#[test]
fn a_contact_that_stays_back_further_than_the_other_is_pressed_is_not_there() {
    let mut scene = shaken(300.0, 900.0);
    scene.solver.modes = 16;
    let expected = forces(&scene, 1e-5, 500);
    let mut both = pair(scene);
    both.parallel.offset = 1e-3;
    let (found, last) = course(&both, 1e-5, 500, BOTH);
    for (found, expected) in found.into_iter().zip(expected) {
        assert_eq!(found, [expected, 0.0]);
    }
    assert!(!last.boolean(BooleanOutput::ParallelClosed));
}

/// A tongue of half the width, clamped where the spring forks, gives way by `(L - f)^3 / (3 E I / 2)` to its own force, beside
/// what the fork moves and turns under both.
#[test]
fn the_preload_of_both_follows_from_beam_formulas() {
    let share = 0.6;
    for offset in [0.0, 3e-5, -3e-5, 2.2e-4, -2.2e-4] {
        let mut scene = forked(pair(Scene::default()), share);
        scene.tip.mass = 0.0;
        scene.effects.axial_force = AxialForceKind::None;
        scene.parallel.offset = offset;
        scene.parallel.curvature_radius *= 3.0;
        let model = Model::new(&scene, 0.0).unwrap();
        let preload = model.preload;
        let together = 1.0 / tip_stiffness(&scene);
        let against = together * (1.0_f64 - share).powi(3);
        let [first, other] = [preload.force, preload.parallel_force];
        let deflection = |own: f64, across: f64| together * (own + across) + against * (own - across);
        let overtravel = scene.contact.overtravel;
        let indentations = [overtravel - deflection(first, other), overtravel - offset - deflection(other, first)];
        // To what the compliance of a spring of segments is rounded.
        let rounding = 1e-12 * overtravel;
        let found = [preload.indentation, preload.parallel_indentation];
        for (found, expected) in found.into_iter().zip(indentations) {
            assert!((found - expected).abs() <= rounding, "{offset}: {found} {expected}");
        }
        // Hertz: the force grows with the power 3/2 of the indentation and the root of the radius.
        if first > 0.0 && other > 0.0 {
            let ratio = (found[1] / found[0]).powf(1.5) * 3.0_f64.sqrt();
            assert!((other / first / ratio - 1.0).abs() < 1e-9);
        } else {
            assert!(first > 0.0 || other > 0.0, "one of them holds the spring");
        }
    }
}

/// Twins part at the same instant, which may be located before the communication point reaches it.
#[test]
fn a_motion_set_again_keeps_the_events_of_both() {
    let mut plain = Simulation::new(&pair(shaken(500.0, 900.0)), &Inputs::default(), 0.0).unwrap();
    let (mut other, mut count) = (plain.clone(), 0);
    for _ in 0..2000 {
        let motion = *other.motion();
        other.go_on_from(&motion);
        let [expected, found] = [&mut plain, &mut other].map(|simulation| {
            simulation.step(&Inputs::default(), simulation.time(), 2e-6).unwrap();
            simulation.events().0.copied().collect::<Vec<_>>()
        });
        assert_eq!(found, expected);
        count += found.len();
    }
    assert!(count >= 8, "{count}");
}

/// Force, resistance, and interruptions of contacts that open at different times, against what each of 250,000 instants says.
#[test]
fn the_circuit_is_interrupted_while_both_are_open() {
    let mut scene = forked(pair(shaken(600.0, 900.0)), 0.3);
    scene.parallel.offset = 1e-5;
    scene.parallel.curvature_radius *= 0.2;
    scene.effects.chatter = true;
    scene.chatter.minimum_duration = 0.0;
    scene.solver.tolerance = 1e-7;
    let mut fine = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let (step, count) = (2e-8, 250_000_u32);
    let (mut open, mut apart, mut begins, mut was_open) = (0.0, 0.0, 0, false);
    let mut highest = Vec::new();
    let mut resistance = 0.0_f64;
    for k in 0..count {
        let start = f64::from(k) * step;
        fine.step(&Inputs::default(), start, step).unwrap();
        let [first, other] = BOTH.map(|output| fine.real(output));
        let is_open = first == 0.0 && other == 0.0;
        open += if is_open { step } else { 0.0 };
        let one_is_open = !is_open && (first == 0.0 || other == 0.0);
        apart += if one_is_open { step } else { 0.0 };
        begins += i32::from(is_open && !was_open);
        was_open = is_open;
        resistance = resistance.max(fine.real(RealOutput::ContactResistance));
        if (k + 1) % 500 == 0 {
            highest.push(resistance);
            resistance = fine.real(RealOutput::ContactResistance);
        }
    }
    assert!(begins > 2 && apart > 2e-4, "{begins} {apart}");
    let (found, coarse) = course(&scene, 1e-5, 500, [RealOutput::StepMaximumResistance]);
    for (n, ([found], expected)) in found.into_iter().zip(highest).enumerate() {
        // Samples 20 ns apart miss the rise at an opening, where the resistance follows the root of the time.
        assert!(expected <= found * (1.0 + 1e-4), "{n}: {found} {expected}");
        assert!(expected > 0.8 * found, "{n}: {found} {expected}");
    }
    for simulation in [&fine, &coarse] {
        assert_eq!(simulation.integer(IntegerOutput::ChatterCount), begins);
        let total = simulation.real(RealOutput::ChatterTotalInterruption);
        // Two samples for each interruption, and the time in which the resistance is above the threshold while a contact touches.
        let allowed = f64::from(begins) * (2.0 * step + 1e-7);
        assert!((total - open).abs() < allowed, "{total} {open}");
    }
}

/// While one contact unloads and the other is loaded, the resistance of both together turns between instants at which neither force
/// does, anywhere in an integration step.
#[test]
fn the_greatest_resistance_of_both_is_that_of_instants_within_the_step() {
    for (amplitude, frequency, offset) in
        [(428.588_36, 1761.6964, 1e-6), (427.509_85, 1814.7433, 1e-6), (402.297_53, 1942.2115, -1e-6)]
    {
        let mut scene = pair(shaken(amplitude, frequency));
        scene.effects.contact_law = ContactLawKind::Rough;
        scene.parallel.offset = offset;
        let (instants, _) = course(&scene, 1e-6, 3000, [RealOutput::ContactResistance]);
        let (found, _) = course(&scene, 1e-4, 30, [RealOutput::StepMaximumResistance]);
        let mut compared = 0;
        for (n, (instants, [found])) in instants.chunks(100).zip(found).enumerate() {
            let expected = instants.iter().flatten().copied().fold(0.0, f64::max);
            // Where both open, the resistance leaps.
            if found < 1.0 {
                compared += 1;
                assert!(expected <= found * (1.0 + 5e-5), "{amplitude} {n}: {found} {expected}");
            }
        }
        assert!(compared > 10, "{amplitude}: {compared}");
    }
}

/// By Barber, `k / (rho E*)` with the stiffness `k` of each under its own force: of spheres `(6 E*^2 R F)^(1/3)`, of rough contacts
/// `k_r (F / F_r)^n`.
#[test]
fn each_conducts_by_its_own_stiffness() {
    let mut scene = pair(shaken(98.0, 1000.0));
    scene.effects.resistance = ResistanceKind::Barber;
    (scene.parallel.curvature_radius, scene.parallel.stiffness) = (1e-3, 4.37e5);
    let modulus = reduced_modulus(&scene.contact);
    for law in [ContactLawKind::Hertz, ContactLawKind::Rough] {
        scene.effects.contact_law = law;
        let (contact, parallel) = (&scene.contact, &scene.parallel);
        let of_each = [(contact.curvature_radius, contact.stiffness), (parallel.curvature_radius, parallel.stiffness)];
        let conducts = |force: f64, (radius, stiffness): (f64, f64)| {
            let stiffness = match law {
                ContactLawKind::Hertz => (6.0 * modulus.powi(2) * radius * force).cbrt(),
                _ => stiffness * (force / contact.stiffness_force).powf(contact.stiffness_exponent),
            };
            stiffness / (scene.resistance.resistivity * modulus)
        };
        let outputs = [BOTH[0], BOTH[1], RealOutput::ContactConductance];
        let (found, last) = course(&scene, 1e-5, 50, outputs);
        for (n, [first, other, conductance]) in found.into_iter().enumerate() {
            let expected = conducts(first, of_each[0]) + conducts(other, of_each[1]);
            near(format_args!("{law:?} {n}"), conductance, expected, 1e-6 * expected);
        }
        let [greatest, present] =
            [RealOutput::StepMaximumResistance, RealOutput::ContactResistance].map(|o| last.real(o));
        assert!(greatest >= present * (1.0 - 1e-12), "{greatest} {present}");
        // Both have the same voltage, which heats the first by `T^2 = T_0^2 + V^2 / (4 L)`; the second circuit stays open.
        let mut heated = scene.clone();
        (heated.effects.heating, heated.effects.second_contact) = (true, true);
        let inputs = Inputs { contact_current: -10.0, ..Inputs::default() };
        let started = Simulation::new(&heated, &inputs, 0.0).unwrap();
        let open = 1.0 / scene.resistance.open;
        let conductance = started.real(RealOutput::ContactConductance) - open;
        let warm = scene.environment.temperature.hypot(10.0 / conductance / 2.0 / 2.45e-8_f64.sqrt());
        close("K", started.real(RealOutput::ContactTemperature), warm, 1e-12);
        close("V", started.real(RealOutput::ContactVoltage), -10.0 / conductance, 1e-9);
        close("S", started.real(RealOutput::SecondConductance), open, 1e-15);
    }
}

/// Modes with the same tongues as a forked spring give the same forces.
#[test]
fn modes_of_a_forked_spring_are_that_spring() {
    let mut scene = forked(pair(shaken(300.0, 700.0)), 0.5);
    scene.parallel.offset = 1e-6;
    scene.solver.modes = 12;
    scene.effects.axial_force = AxialForceKind::None;
    let mut given = scene.clone();
    // The compliance of all modes: the same truncation on both sides.
    given.spring = spring_file("modes.toml", Shape::Modes(modes_of(&Model::new(&scene, 0.0).unwrap())));
    let [expected, found] = [&scene, &given].map(|scene| course(scene, 1e-5, 300, BOTH).0.concat());
    // The segments' static compliance is that of all modes, here that of 24.
    let difference = largest_difference(&found, &expected);
    assert!(difference < 2e-3 * force_scale(&scene), "{difference}");
}

/// Also where one contact alone, or the bend that it makes, is far from what both hold.
#[test]
fn contacts_of_all_heights_find_their_preload() {
    for offset in [-1e-3, -1e-4, -1e-5, 0.0, 1e-5, 1e-4, 1e-3] {
        for overtravel in [-1e-4, 1e-5, 3e-4] {
            for axial_force in [AxialForceKind::None, AxialForceKind::FromPreload] {
                for law in [ContactLawKind::Hertz, ContactLawKind::Rough] {
                    for fork in [0.0, 0.5] {
                        let mut scene = pair(Scene::default());
                        scene.effects.axial_force = axial_force;
                        scene.effects.contact_law = law;
                        (scene.parallel.offset, scene.contact.overtravel) = (offset, overtravel);
                        let scene = if fork > 0.0 { forked(scene, fork) } else { scene };
                        let model = Model::new(&scene, 0.0).unwrap();
                        let preload = model.preload;
                        let closed = [preload.force > 0.0, preload.parallel_force > 0.0];
                        let indented = [preload.indentation > 0.0, preload.parallel_indentation > 0.0];
                        assert_eq!(closed, indented, "{offset} {overtravel}");
                        assert_eq!(closed.contains(&true), overtravel.max(overtravel - offset) > 0.0);
                    }
                }
            }
        }
    }
}

/// No equilibrium is found where the spring were bent by more than its length.
#[test]
fn the_preload_of_both_follows_a_material_without_jumps() {
    for offset in [-1e-4, -1e-5, -1e-6] {
        let mut scene = pair(Scene::default());
        scene.effects.axial_force = AxialForceKind::FromPreload;
        scene.parallel.offset = offset;
        scene.solver.modes = 4;
        let forces = (0..400).map(|k| {
            scene.contact.moving.poisson_ratio = 0.25 + 5e-4 * f64::from(k);
            Model::new(&scene, 0.0).unwrap().preload.parallel_force
        });
        let forces: Vec<f64> = forces.collect();
        for (k, pair) in forces.windows(2).enumerate() {
            assert!((pair[1] / pair[0] - 1.0).abs() < 1e-3, "{offset} m, value {k}: {pair:?} N");
        }
    }
}

/// Against each other the tongues of a forked spring move as the cantilever that both are beyond the fork: here of a tapered
/// spring with a mass and a contact before its end, its dimensions at the cut worked out by hand.
#[test]
fn tongues_are_the_cantilever_beyond_the_fork() {
    let mut scene = pair(Scene::default());
    scene.effects.axial_force = AxialForceKind::None;
    scene.solver.modes = 12;
    let spring = |length: f64, [width, thickness]: [f64; 2], before: f64, fork_position: Option<f64>| Segments {
        segments: vec![segment(length, [width, 2e-3], [thickness, 8e-5])],
        masses: vec![PointMass { position: 11e-3 - before, mass: 2e-5, rotary_inertia: 0.0 }],
        contact_position: Some(15e-3 - before),
        fork_position,
        ..Segments::default()
    };
    let forked = spring(16e-3, [4e-3, 1.2e-4], 0.0, Some(4e-3));
    // A quarter of the way from 4 to 2 mm and from 0.12 to 0.08 mm.
    let beyond = spring(12e-3, [3.5e-3, 1.1e-4], 4e-3, None);
    let [all, tongues] = [forked, beyond].map(|segments| {
        scene.spring = spring_file("spring.toml", Shape::Segments(segments));
        Model::new(&scene, 0.0).unwrap().modes
    });
    let against = all.iter().filter(|mode| mode.tip * mode.parallel < 0.0);
    for (n, (found, expected)) in against.zip(&tongues).take(4).enumerate() {
        close(n, found.omega_squared, expected.omega_squared, 1e-9);
        near(n, found.tip.abs(), expected.tip.abs(), 1e-9 * expected.tip.abs());
        assert_eq!(found.participation, 0.0);
    }
}
