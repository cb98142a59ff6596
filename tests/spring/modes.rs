//! Springs of modes.

use relay_contact::error::Remark;
use relay_contact::inputs::Inputs;
use relay_contact::reference::{Mode, Model, reduced_modulus};
use relay_contact::scene::Scene;
use relay_contact::scene::spring::{GivenMode, Modes, Segment, Segments, Shape};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, IntegerOutput, RealOutput};
use testing::close;
use testing::scenes::{course, forces, largest_difference, shaken, supported};
use testing::springs::{mode, modes_of, of_modes, segment};

use super::{TAU, with};

#[test]
fn modes_written_by_our_own_beam_and_read_again_are_the_beam() {
    for amplitude in [98.0, 400.0] {
        let scene = shaken(amplitude, 1000.0);
        let plain = Model::new(&scene, 0.0).unwrap();
        let given = with(scene.clone(), Shape::Modes(modes_of(&plain)));
        let model = Model::new(&given, 0.0).unwrap();
        assert_eq!(model.modes.len(), plain.modes.len(), "nothing is missing in the Ritz modes");
        assert_eq!(model.remarks(), []);
        for (found, expected) in [
            (model.preload.force, plain.preload.force),
            (model.frequency, plain.frequency),
            (model.force_scale, plain.force_scale),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
        let (found, expected) = (forces(&given, 2e-5, 200), forces(&scene, 2e-5, 200));
        let largest = expected.iter().copied().fold(0.0, f64::max);
        let difference = largest_difference(&found, &expected);
        assert!(difference < 1e-9 * largest, "{amplitude}: {difference:e}");
    }
}

/// Modes say what the rivet, the material and the place of a pusher do; tongues are joined where no second contact is on one.
#[test]
fn what_does_not_count_beside_a_file_is_told() {
    let mut scene = with(Scene::default(), Shape::Modes(modes_of(&Model::new(&Scene::default(), 0.0).unwrap())));
    (scene.tip.mass, scene.beam.density, scene.pusher.position) = (2e-4, 8000.0, 0.005);
    let names = |scene: &Scene| -> Vec<_> {
        let remarks = Model::new(scene, 0.0).unwrap().remarks();
        let name = |remark| match remark {
            Remark::NotUsed { name, .. } | Remark::Joined { name, .. } => name,
            other => panic!("{other}"),
        };
        remarks.into_iter().map(name).collect()
    };
    assert_eq!(names(&scene), ["beam.density", "tip.mass", "pusher.position"]);
    scene.fixed_spring.clone_from(&scene.spring);
    assert_eq!(names(&scene), ["beam.density", "tip.mass", "pusher.position"]);
    // The fixed contact's may be of that material.
    let bar = Segments { segments: vec![segment(0.01, [4e-3; 2], [3e-4; 2])], ..Segments::default() };
    scene.fixed_spring = with(Scene::default(), Shape::Segments(bar)).spring;
    assert_eq!(names(&scene), ["tip.mass", "pusher.position"]);
    let forked = Segments {
        segments: vec![segment(0.0155, [4e-3; 2], [3e-4; 2])],
        fork_position: Some(0.01),
        ..Segments::default()
    };
    scene = with(Scene::default(), Shape::Segments(forked));
    scene.fixed_spring.clone_from(&scene.spring);
    assert_eq!(names(&scene), ["beam.file", "fixed.file"]);
    scene.fixed_spring = None;
    scene.effects.parallel_contact = true;
    assert_eq!(names(&scene), [""; 0]);
}

/// With a density in g/cm3 a contact that opens had passed with a margin of 18.
#[test]
fn a_material_that_may_be_in_another_unit_is_told() {
    let told = |of_scene: f64, of_segment: Option<f64>| {
        let mut scene = Scene::default();
        scene.beam.density = of_scene;
        let part = Segment { density: of_segment, ..segment(30e-3, [4e-3; 2], [0.2e-3; 2]) };
        let scene = with(scene, Shape::Segments(Segments { segments: vec![part], ..Segments::default() }));
        let remarks = Model::new(&scene, 0.0).unwrap().remarks();
        remarks.iter().any(|remark| matches!(remark, Remark::Unusual { name: "beam.density", value: 8.25, .. }))
    };
    assert!(!told(8250.0, None) && told(8.25, None) && told(8250.0, Some(8.25)));
}

/// Of 3 mm, typed as a number of mm, a contact was a hundred times stiffer without a word.
#[test]
fn sizes_that_may_be_in_another_unit_are_told() {
    let told = |radius: f64, mass: f64, damping: f64| {
        let mut scene = Scene::default();
        (scene.contact.curvature_radius, scene.tip.mass, scene.contact.damping) = (radius, mass, damping);
        let remarks = Model::new(&scene, 0.0).unwrap().remarks();
        remarks.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(told(3e-3, 2e-5, 8e-5), "");
    assert_eq!(
        told(3.0, 2e-5, 8e-5),
        "contact.curvatureRadius = 3 m: usual is 5e-5 to 0.2; is it meant in another unit?"
    );
    assert_eq!(told(3e-3, 0.02, 8e-5), "tip.mass = 0.02 kg: usual is 0 to 0.005; is it meant in another unit?");
    assert_eq!(told(3e-3, 2e-5, 0.08), "contact.damping = 0.08 s: usual is 0 to 0.005; is it meant in another unit?");
}

/// Modes in tonnes and millimetres, of another normalisation or without the first, and a compliance in mm/N, had passed.
#[test]
fn modes_that_may_be_in_another_unit_are_told() {
    let own = modes_of(&Model::new(&Scene::default(), 0.0).unwrap());
    let told = |change: fn(&mut Modes)| {
        let mut modes = own.clone();
        change(&mut modes);
        let fixed = with(Scene::default(), Shape::Modes(modes)).spring;
        let remarks = Model::new(&Scene { fixed_spring: fixed, ..Scene::default() }, 0.0).unwrap().remarks();
        remarks.iter().any(|remark| matches!(remark, Remark::Compliance { name: "fixed.file", .. }))
    };
    assert!(!told(|_| ()));
    assert!(told(|modes| modes.compliance *= 1e3));
    assert!(told(|modes| modes.modes = modes.modes[1..].to_vec()));
    assert!(told(|modes| modes.modes.iter_mut().for_each(|mode| mode.contact = 1.0)));
    assert!(told(|modes| modes.modes.iter_mut().for_each(|mode| mode.frequency *= TAU)));
    assert!(told(|modes| {
        modes.compliance *= 1e3;
        modes.modes.iter_mut().for_each(|mode| mode.contact *= 1e3_f64.sqrt());
    }));
}

#[test]
fn damping_that_may_be_in_per_cent_or_another_unit_is_told() {
    for (damping, told) in [(8.063e-5, false), (8.063e-4, true)] {
        let mut scene = Scene::default();
        scene.beam.stiffness_damping = damping;
        assert_eq!(matches!(Model::new(&scene, 0.0).unwrap().remarks()[..], [Remark::Damped { .. }]), told);
    }
    for (ratio, told) in [(0.34, false), (1.0, true)] {
        let mut modes = modes_of(&Model::new(&Scene::default(), 0.0).unwrap());
        // Higher modes may have any.
        (modes.modes[0].damping, modes.modes[1].damping) = (Some(ratio), Some(5.0));
        let scene = with(Scene::default(), Shape::Modes(modes));
        let remarks = Model::new(&scene, 0.0).unwrap().remarks();
        assert_eq!(matches!(remarks[..], [Remark::Damped { .. }]), told, "{remarks:?}");
    }
}

#[test]
fn the_compliance_of_modes_left_out_acts_as_a_spring_in_series() {
    // The eigenvectors of a beam, cut off. Below them the series is exact but for the square of the ratio of frequencies.
    let mut scene = shaken(98.0, 500.0);
    scene.beam.stiffness_damping = 2e-6;
    let mut fine = scene.clone();
    fine.solver.modes = 64;
    let all = modes_of(&Model::new(&fine, 0.0).unwrap());
    let expected = forces(&scene, 1e-4, 100);
    let swing = expected.iter().map(|force| (force - 0.152).abs()).fold(0.0, f64::max);
    let error = |count: usize| {
        let modes = all.modes[..count].iter().map(|own| GivenMode { parallel: None, ..*own });
        let modes = Modes { modes: modes.collect(), ..all.clone() };
        let scene = with(scene.clone(), Shape::Modes(modes));
        let model = Model::new(&scene, 0.0).unwrap();
        assert_eq!(model.modes.len(), count + 1);
        assert!(matches!(model.remarks()[..], [Remark::FewModes { .. }]));
        largest_difference(&forces(&scene, 1e-4, 100), &expected) / swing
    };
    let errors = [2, 4, 8, 16].map(error);
    assert!(errors[3] < 1e-4 && errors.is_sorted_by(|a, b| a > b), "{errors:?}");
}

#[test]
fn a_single_mode_with_its_residual_is_a_mass_between_two_springs() {
    // Bonded contact: mass m on k, the contact k_c and the residual c in series beside it.
    let (mass, frequency, contact) = (1e-4_f64, 1000.0, 0.9);
    let omega_squared = (TAU * frequency).powi(2);
    let held = contact * contact / mass / omega_squared;
    let given = GivenMode { damping: Some(0.005), ..mode(frequency, contact / mass.sqrt(), mass.sqrt()) };
    let mut scene = shaken(20.0, 300.0);
    scene.effects.contact_law = ContactLawKind::Bonded;
    scene.contact.damping = 0.0;
    let scene = with(scene, of_modes(1.1 * held, [given]));
    let model = Model::new(&scene, 0.0).unwrap();
    let series = 1.0 / (1.0 / model.preload.contact_stiffness + 0.1 * held);
    let expected = (omega_squared + series * contact * contact / mass).sqrt() / TAU;
    // The residual mode is 1e4 times faster than the other: the square of that.
    close("frequency, Hz", model.frequency, expected, 1e-7);
    // It gives way in the damping time of the other one, but that of a ratio of 0.01 at least.
    close("s", model.modes[1].damping / model.modes[1].omega_squared, 0.02 / omega_squared.sqrt(), 1e-12);
    // Steady state by the same series: q = -g a / (omega_0^2 - omega^2 + k_s T^2 + i omega c), F = -k_s T q.
    let omega = TAU * 300.0;
    let (real, imaginary) =
        (omega_squared - omega * omega + series * contact * contact / mass, omega * 0.01 * omega_squared.sqrt());
    let amplitude = 20.0 * mass.sqrt() * series * contact / mass.sqrt() / real.hypot(imaginary);
    let late = &forces(&scene, 1e-4, 2000)[1000..];
    let middle = model.preload.force;
    let found = late.iter().map(|force| (force - middle).abs()).fold(0.0, f64::max);
    // A hundred points a third of a period apart miss the crest by less than 1e-3.
    assert!((found / amplitude - 1.0).abs() < 2e-3, "{found} {amplitude}");
}

/// In series with the contact's damper a residual compliance holds a force that changes slowly. Where it forgot that at once, damped
/// critically, there were 85,000 steps.
#[test]
fn a_residual_compliance_takes_few_steps() {
    let mut scene = shaken(98.0, 1000.0);
    let mut fine = scene.clone();
    fine.solver.modes = 64;
    let all = modes_of(&Model::new(&fine, 0.0).unwrap()).modes;
    let modes = all.iter().take(8).map(|own| GivenMode { parallel: None, damping: Some(0.02), ..*own });
    let held: f64 = modes.clone().map(|mode| mode.contact.powi(2) / mode.omega_squared()).sum();
    let [without, beside] = [1.0, 1.01].map(|share| {
        scene = with(scene.clone(), of_modes(share * held, modes.clone()));
        let (_, simulation) = course(&scene, 1e-4, 100, [RealOutput::ContactForce]);
        simulation.integer(IntegerOutput::SolverSteps)
    });
    assert!(beside < 5 * without, "{beside} steps, {without} without a residual compliance");
}

#[test]
fn each_mode_may_have_its_own_damping() {
    let scene = Scene::default();
    let mut modes = modes_of(&Model::new(&scene, 0.0).unwrap());
    for (n, mode) in modes.modes.iter_mut().enumerate() {
        mode.damping = (n > 0).then_some(0.03);
    }
    let model = Model::new(&with(scene.clone(), Shape::Modes(modes)), 0.0).unwrap();
    let [first, second, ..] = model.modes.as_slice() else { panic!() };
    let beta = scene.beam.stiffness_damping;
    assert_eq!(first.damping, beta * first.omega_squared);
    assert!((second.damping / (0.06 * second.omega_squared.sqrt()) - 1.0).abs() < 1e-12);
}

/// A mode shaken at its frequency with the contact open: all that holds it is its damping, `q = g a / (c omega)`.
#[test]
fn mass_damping_limits_a_mode_at_its_resonance() {
    let (frequency, contact, participation, acceleration) = (1000.0, 150.0, 5e-3, 10.0);
    let mut scene = shaken(acceleration, frequency);
    scene.contact.overtravel = -1e-3;
    (scene.beam.mass_damping, scene.beam.stiffness_damping) = (400.0, 1e-5);
    let scene = with(scene, of_modes(1e-3, [mode(frequency, contact, participation)]));
    let omega = TAU * frequency;
    let damping = 400.0 + 1e-5 * omega * omega;
    let expected = contact * participation * acceleration / (damping * omega);
    // 50 ms: what the start left is exp(-c t / 2) = 3e-9.
    let (rows, _) = course(&scene, 1e-5, 5000, [RealOutput::TipDisplacement]);
    let found = rows[4900..].iter().flatten().fold(0.0_f64, |most, y| most.max(y.abs()));
    // A hundred instants a cycle miss the crest by up to (pi / 100)^2 / 2.
    close("swing, m", found, expected, 6e-4);
}

/// Modes that move two equal contacts alike, and what each contact has beyond them in series with itself, as much for both if the file
/// does not say it: in rest at the start, and after its support has moved.
#[test]
fn contacts_side_by_side_have_a_residual_compliance_each() {
    let (held, rest) = (8e-4, 3e-4);
    let displacement = TAU * 800.0 * f64::sqrt(held);
    let given = GivenMode { damping: Some(1.0), parallel: Some(displacement), ..mode(800.0, displacement, 5e-3) };
    for (beyond, of_parallel) in [(rest, None), (5e-4, Some(held + 5e-4))] {
        let modes = Modes { compliance: held + rest, parallel_compliance: of_parallel, modes: vec![given] };
        let mut scene = with(Scene::default(), Shape::Modes(modes));
        scene.effects.parallel_contact = true;
        scene.parallel.curvature_radius = scene.contact.curvature_radius;
        let hertz = 4.0 / 3.0 * reduced_modulus(&scene.contact) * scene.contact.curvature_radius.sqrt();
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        for overtravel in [scene.contact.overtravel, scene.contact.overtravel + 1e-4] {
            let forces = [RealOutput::ContactForce, RealOutput::ParallelForce].map(|output| simulation.real(output));
            for (force, own) in forces.into_iter().zip([rest, beyond]) {
                let deflections = held * (forces[0] + forces[1]) + own * force + (force / hertz).powf(2.0 / 3.0);
                close(own, deflections, overtravel, 1e-6);
            }
            simulation.step(&supported(0.0, 1e-2), simulation.time(), 1e-2).unwrap();
            simulation.step(&supported(1e-4, 0.0), simulation.time(), 0.1).unwrap();
        }
    }
}

/// However many modes both springs have, all of them at rest give way as the files say: what there is no room for is in the residual
/// compliance of each.
#[test]
fn springs_of_more_modes_than_there_is_room_for_keep_their_compliance() {
    let given = |size: f64| {
        let modes = (1..=100).map(|n| mode(500.0 * f64::from(n), size, 0.0));
        let held: f64 = modes.clone().map(|mode| mode.contact.powi(2) / mode.omega_squared()).sum();
        (1.3 * held, of_modes(1.3 * held, modes))
    };
    let [(moving, shape), (fixed, other)] = [given(100.0), given(50.0)];
    let mut scene = with(Scene::default(), shape);
    scene.fixed_spring = with(Scene::default(), other).spring;
    for count in [0, 64] {
        scene.solver.modes = count;
        let model = Model::new(&scene, 0.0).unwrap();
        // To rounding.
        close(count, model.modes.iter().map(Mode::compliance).sum(), moving + fixed, 1e-12);
    }
}
