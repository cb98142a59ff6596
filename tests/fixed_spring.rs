//! A fixed contact on a spring of its own: against a rigid one, against its mirror image, and its statics.

use std::f64::consts::TAU;
use std::sync::Arc;

use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::Shape;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::rig::Rig;
use testing::scenes::{forces, largest_difference, shaken};
use testing::springs::{of_segments, segment, spring_file};

/// The scene with a uniform fixed spring of this width and thickness over those of the moving one.
fn on_spring(mut scene: Scene, width: f64, thickness: f64) -> Scene {
    let beam = &scene.beam;
    let whole = segment(beam.length, [width * beam.width; 2], [thickness * beam.thickness; 2]);
    scene.fixed_spring = spring_file("fixed.toml", of_segments([whole]));
    scene
}

/// The specimen without a rivet, at this tolerance.
fn plain(tolerance: f64) -> Scene {
    let mut scene = Scene::default();
    scene.tip.mass = 0.0;
    scene.tip.rotary_inertia = 0.0;
    scene.solver.tolerance = tolerance;
    scene
}

/// What lies on one side of the plane between two equal springs: a rigid wall at half the overtravel, approached by half of what
/// the springs approach each other, so that Hertz has 2^(3/2) times the coefficient.
fn half(mut scene: Scene) -> Scene {
    scene.contact.overtravel /= 2.0;
    scene.contact.curvature_radius *= 8.0;
    scene
}

#[test]
fn two_equal_springs_are_a_rigid_wall_in_their_mirror_plane_at_rest() {
    let scene = plain(1e-8);
    let both = Model::new(&on_spring(scene.clone(), 1.0, 1.0), 0.0).unwrap();
    let one = Model::new(&half(scene), 0.0).unwrap();
    // To what the static compliance of a spring of segments is rounded.
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
    close(both.preload().force, one.preload().force);
    close(both.preload().indentation, 2.0 * one.preload().indentation);
    close(both.preload().deflection, one.preload().deflection);
    close(both.preload().fixed_deflection, -one.preload().deflection);
    // In the same way both move without the contact: that is their lowest mode, the cantilever's.
    let free = one.modes()[0].omega_squared.sqrt() / TAU;
    assert!((both.frequency() - free).abs() <= 1e-9 * free);
}

/// Struck in opposite ways, hard enough to open the contact, both springs move as one of them against the wall.
#[test]
fn two_equal_springs_struck_in_opposite_ways_are_one_against_a_rigid_wall() {
    let tolerance = 1e-8;
    let scene = plain(tolerance);
    let both = Model::new(&on_spring(scene.clone(), 1.0, 1.0), 0.0).unwrap();
    let one = Model::new(&half(scene), 0.0).unwrap();
    // An impulse on each contact: a velocity in proportion to what the mode moves there.
    let impulse = 4e-5;
    let struck = |model: &Model| -> Vec<f64> { model.modes().iter().map(|mode| impulse * mode.tip).collect() };
    let (mut pair, mut single) = (Rig::new(both.clone()), Rig::new(one.clone()));
    pair.launch(&struck(&both));
    single.launch(&struck(&one));
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for n in 1..=400 {
        let time = f64::from(n) * 1e-5;
        pair.run_to(&Inputs::default(), time).unwrap();
        single.run_to(&Inputs::default(), time).unwrap();
        let [a, b] = [&pair, &single].map(|rig| rig.state.contact().force);
        (least, greatest) = (least.min(b), greatest.max(b));
        // Each is right to the tolerance of the largest force so far.
        let allowed = 2.0 * tolerance * greatest.max(both.force_scale()).max(one.force_scale());
        assert!((a - b).abs() <= allowed, "{time}: {a} {b}");
    }
    assert!(
        least == 0.0 && greatest > 3.0 * one.preload().force,
        "{least} {greatest}"
    );
}

/// The scene with a short fixed spring that is so many times stiffer than the moving one.
fn stiffer(scene: Scene, times: f64) -> Scene {
    let (length, modulus) = (1e-3, 1e13);
    let cube = times * scene.beam.youngs_modulus / modulus * (length / scene.beam.length).powi(3);
    let mut scene = on_spring(scene, 1.0, cube.cbrt());
    let file = Arc::make_mut(scene.fixed_spring.as_mut().unwrap());
    let Shape::Segments(segments) = &mut file.shape else {
        panic!("segments")
    };
    for segment in &mut segments.segments {
        (segment.length, segment.youngs_modulus) = (length, Some(modulus));
    }
    scene
}

/// A fixed spring much stiffer than the moving one is a rigid contact; where it opens, much stiffer than the contact in a blow,
/// of 1e7 N/m.
#[test]
fn a_stiff_fixed_spring_is_a_rigid_contact() {
    // A closed contact of 3.5e6 N/m on a spring of 120 N/m hardly feels what is behind it: 3 % less of the one changes the other
    // by a few millionths. In blows the force follows the stiffness, and what is a hundred thousandth stays some of it.
    for (amplitude, times, share) in [(98.0, 1e6, 1e-5), (400.0, 1e10, 1e-4)] {
        let mut scene = shaken(amplitude, 1000.0);
        scene.solver.tolerance = 1e-8;
        let (rigid, stiff) = (forces(&scene, 1e-5, 500), forces(&stiffer(scene, times), 1e-5, 500));
        let greatest = rigid.iter().copied().fold(0.0, f64::max);
        assert_eq!(rigid.contains(&0.0), amplitude > 200.0, "whether it opens");
        let worst = largest_difference(&rigid, &stiff);
        assert!(
            worst > 0.0 && worst < share * greatest,
            "{amplitude} m/s2: {worst} of {greatest}"
        );
    }
}

/// Both springs lag under a constant acceleration, and give way to the contact force.
#[test]
fn gravity_and_contact_force_bend_both_springs() {
    let mut scene = plain(0.0);
    scene.environment.gravity = 50.0;
    scene = on_spring(scene, 0.5, 2.0);
    let model = Model::new(&scene, 1e-5).unwrap();
    let beam = &scene.beam;
    let (load, bending) = (
        beam.density * beam.width * beam.thickness,
        beam.youngs_modulus * beam.width * beam.thickness.powi(3) / 12.0,
    );
    let length = beam.length;
    // Uniform cantilevers (Timoshenko): F L^3 / (3 EI) and q L^4 / (8 EI). The fixed one has the same load, 4 times the stiffness.
    let (per_force, per_load) = (length.powi(3) / (3.0 * bending), length.powi(4) / (8.0 * bending));
    let preload = model.preload();
    let moving = preload.force * per_force - 50.0 * load * per_load;
    let fixed = -preload.force * per_force / 4.0 - 50.0 * load * per_load / 4.0;
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} {b}");
    close(preload.deflection, moving);
    close(preload.fixed_deflection, fixed);
    close(preload.indentation, scene.contact.overtravel + 1e-5 + fixed - moving);
}

/// Outputs of the fixed spring are those of its modes, also inside the integrator's steps, and its velocity is the derivative.
#[test]
fn the_fixed_contact_moves_as_its_outputs_say() {
    let mut scene = on_spring(shaken(300.0, 700.0), 1.0, 1.5);
    scene.solver.tolerance = 1e-8;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let mut coarse = simulation.clone();
    let get = |simulation: &Simulation, output| simulation.real(output);
    let (overtravel, step) = (scene.contact.overtravel, 1e-6);
    let (mut before, mut furthest) = (None, 0.0_f64);
    for n in 0..6000 {
        simulation.step(&Inputs::default(), f64::from(n) * step, step).unwrap();
        let fixed = get(&simulation, RealOutput::FixedDisplacement);
        let tip = get(&simulation, RealOutput::TipDisplacement);
        let indentation = get(&simulation, RealOutput::ContactIndentation);
        assert!((overtravel - tip + fixed - indentation).abs() < 1e-15);
        if let Some((d, v)) = before {
            let velocity = get(&simulation, RealOutput::FixedVelocity);
            // The trapezoidal rule is wrong by the third derivative, a_max omega step^3 / 12.
            let expected: f64 = d + 0.5 * step * (v + velocity);
            assert!((fixed - expected).abs() < 1e-12, "{n}: {fixed} {expected}");
        }
        before = Some((fixed, get(&simulation, RealOutput::FixedVelocity)));
        if (n + 1) % 50 == 0 {
            let time = coarse.time();
            coarse
                .step(&Inputs::default(), time, f64::from(n + 1) * step - time)
                .unwrap();
            let other = get(&coarse, RealOutput::FixedDisplacement);
            // A part in 1e8 of the force bends the spring by that of its deflection.
            assert!((fixed - other).abs() < 1e-8 * overtravel, "{n}: {fixed} {other}");
            // It is where the modes say that it is.
            let state = simulation.state_now().unwrap();
            let modes = simulation.model().modes().iter().zip(&state.modes);
            let moved: f64 = modes.map(|(mode, at)| mode.fixed * at.q).sum();
            let expected = simulation.model().preload().fixed_deflection + moved;
            assert!((fixed - expected).abs() < 1e-8 * overtravel, "{n}: {fixed} {expected}");
            furthest = furthest.max(moved.abs());
        }
    }
    assert!(furthest > 0.01 * overtravel, "{furthest}");
}
