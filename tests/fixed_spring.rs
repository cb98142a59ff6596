//! A fixed contact on a spring of its own: against its mirror image, its statics, to which `equilibrium.rs` compares where it comes to
//! rest, and its outputs. Forces on springs that differ are compared with finite elements in `tests/python/test_relay_parts.py`.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Mode, Model};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::rig::Rig;
use testing::scenes::{bending_stiffness, shaken};
use testing::{close, near, springs};

/// The scene with a uniform fixed spring of this width and thickness over those of the moving one.
fn on_spring(mut scene: Scene, width: f64, thickness: f64) -> Scene {
    scene.fixed_spring = springs::uniform_spring(&scene, width, thickness);
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

/// Struck in opposite ways, hard enough to open the contact, both springs move as one of them against the wall.
#[test]
fn two_equal_springs_struck_in_opposite_ways_are_one_against_a_rigid_wall() {
    let tolerance = 1e-8;
    let scene = plain(tolerance);
    let both = Model::new(&on_spring(scene.clone(), 1.0, 1.0), 0.0).unwrap();
    let one = Model::new(&half(scene), 0.0).unwrap();
    // In the same way both move without the contact: that is their lowest mode, the cantilever's.
    let free = one.modes[0].omega_squared.sqrt() / TAU;
    close("Hz", both.frequency, free, 1e-9);
    // An impulse on each contact: a velocity in proportion to what the mode moves there.
    let impulse = 4e-5;
    let struck = |model: &Model| -> Vec<f64> { model.modes.iter().map(|mode| impulse * mode.tip).collect() };
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
        let allowed = 2.0 * tolerance * greatest.max(both.force_scale).max(one.force_scale);
        assert!((a - b).abs() <= allowed, "{time}: {a} {b}");
    }
    assert!(least == 0.0 && greatest > 3.0 * one.preload.force, "{least} {greatest}");
}

/// Both springs lag under a constant acceleration, and give way to the contact force.
#[test]
fn gravity_and_contact_force_bend_both_springs() {
    let mut scene = plain(0.0);
    scene.environment.gravity = 50.0;
    scene = on_spring(scene, 0.5, 2.0);
    let model = Model::new(&scene, 1e-5).unwrap();
    let beam = &scene.beam;
    let (load, bending) = (beam.density * beam.width * beam.thickness, bending_stiffness(&scene));
    let length = beam.length;
    // Uniform cantilevers (Timoshenko): F L^3 / (3 EI) and q L^4 / (8 EI). The fixed one has the same load, 4 times the stiffness.
    let (per_force, per_load) = (length.powi(3) / (3.0 * bending), length.powi(4) / (8.0 * bending));
    let preload = model.preload;
    let moving = preload.force * per_force - 50.0 * load * per_load;
    let fixed = -preload.force * per_force / 4.0 - 50.0 * load * per_load / 4.0;
    let same = |found, expected| close("at rest", found, expected, 1e-9);
    same(preload.deflection, moving);
    same(preload.fixed_deflection, fixed);
    same(preload.indentation, scene.contact.overtravel + 1e-5 + fixed - moving);
}

#[test]
fn each_spring_has_its_own_damping() {
    let mut scene = on_spring(plain(0.0), 0.5, 2.0);
    let (own, of_fixed) = ((30.0, 1e-6), (500.0, 2e-5));
    (scene.beam.mass_damping, scene.beam.stiffness_damping) = own;
    (scene.fixed.mass_damping, scene.fixed.stiffness_damping) = of_fixed;
    for (n, mode) in Model::new(&scene, 0.0).unwrap().modes.iter().enumerate() {
        let (by_mass, by_stiffness) = if mode.fixed == 0.0 { own } else { of_fixed };
        close(n, mode.damping, by_mass + by_stiffness * mode.omega_squared, 1e-12);
    }
}

/// Outputs of both springs are those of their modes, also inside the integrator's steps, and the velocity is the derivative.
#[test]
fn the_fixed_contact_moves_as_its_outputs_say() {
    let mut scene = on_spring(shaken(300.0, 700.0), 1.0, 1.5);
    scene.solver.tolerance = 1e-8;
    let outputs = [RealOutput::FixedDisplacement, RealOutput::FixedVelocity, RealOutput::TipDisplacement];
    let (overtravel, step) = (scene.contact.overtravel, 1e-6);
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let (mut rows, mut furthest) = (Vec::new(), 0.0_f64);
    for n in 0..6000 {
        simulation.step(&Inputs::default(), f64::from(n) * step, step).unwrap();
        let row @ [fixed, _, tip] = outputs.map(|output| simulation.real(output));
        rows.push(row);
        if n % 50 == 0 {
            let state = simulation.state_now().unwrap();
            let sum = |shape: fn(&Mode) -> f64| -> f64 {
                let modes = simulation.model().modes.iter().zip(&state.modes);
                modes.map(|(mode, at)| shape(mode) * at.q).sum()
            };
            let preload = simulation.model().preload;
            let (moved, tip_moved) = (sum(|mode| mode.fixed), sum(|mode| mode.tip + mode.fixed));
            // A part in 1e8 of the force bends a spring by that of its deflection.
            near(n, fixed, preload.fixed_deflection + moved, 1e-8 * overtravel);
            near(n, tip, preload.deflection + tip_moved, 1e-8 * overtravel);
            furthest = furthest.max(moved.abs());
        }
    }
    for (n, pair) in rows.windows(2).enumerate() {
        let [[before, start, ..], [now, end, ..]] = pair else { panic!() };
        // The trapezoidal rule is wrong by the third derivative, a_max omega step^3 / 12.
        near(n, *now, before + 0.5 * step * (start + end), 1e-12);
    }
    assert!(furthest > 0.01 * overtravel, "{furthest}");
}
