//! A linear scene against its closed form: a sum of damped oscillators under a sine.
//!
//! With one stiffness damping for beam and contact, the modes of the beam with the contact as a spring are uncoupled, and
//! the response of each from rest is textbook. With other dampings, against the matrix exponential of the whole.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};
use relay_contact::inputs::Inputs;
use relay_contact::reference::{Model, Space};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, IntegerOutput, RealOutput};
use testing::rig::Rig;
use testing::scenes::{accelerated, shaken};
use testing::{near, worst};

const FREQUENCY: f64 = 1000.0;
const AMPLITUDE: f64 = 98.0;

/// Turns beyond whole ones, which are dropped before anything is rounded.
fn turned(frequency: f64, t: f64) -> f64 {
    let turns = frequency * t;
    turns.fract() + frequency.mul_add(t, -turns)
}

/// Displacement and velocity at `t` of `x'' + c x' + w^2 x = Im e^(i omega t)` from rest.
fn from_rest(omega_squared: f64, damping: f64, t: f64) -> (f64, f64) {
    let omega = TAU * FREQUENCY;
    let i = Complex::new(0.0, 1.0);
    let steady = 1.0 / Complex::new(omega_squared - omega * omega, omega * damping);
    let (x0, v0) = (steady.im, (i * omega * steady).im);
    // What the steady motion has at the start is taken back by a free one, `a e^(l1 t) + b e^(l2 t)`.
    let root = Complex::new(damping * damping / 4.0 - omega_squared, 0.0).sqrt();
    let (l1, l2) = (-root - damping / 2.0, omega_squared / (-root - damping / 2.0));
    let a = (Complex::from(-v0) + l2 * x0) / (l1 - l2);
    let b = -x0 - a;
    let (e1, e2) = (a * (l1 * t).exp(), b * (l2 * t).exp());
    let now = steady * Complex::from_polar(1.0, TAU * turned(FREQUENCY, t));
    (now.im + (e1 + e2).re, (i * omega * now).im + (l1 * e1 + l2 * e2).re)
}

/// The force above the preload force, by the closed form.
fn force(model: &Model, t: f64) -> f64 {
    let preload = &model.preload;
    let beta = model.law.damping;
    Space::new(model.modes.len())
        .modes(&model.section, preload.axial_force, preload.contact_stiffness)
        .unwrap()
        .iter()
        .map(|mode| {
            let (x, v) = from_rest(mode.omega_squared, beta * mode.omega_squared, t);
            preload.contact_stiffness * mode.tip * mode.participation * AMPLITUDE * (x + beta * v)
        })
        .sum()
}

fn scene(law: ContactLawKind) -> Scene {
    let mut scene = shaken(AMPLITUDE, FREQUENCY);
    // With them steps would be short.
    scene.effects.extremes = false;
    scene.effects.chatter = false;
    scene.effects.contact_law = law;
    scene.solver.modes = 8;
    scene
}

/// The exact solution at any step length, with one step per communication step, and with longer ones where the
/// integrator may take them. Rounding: the sum of the modes' displacements loses some two digits, the phase at `t` some
/// more.
#[test]
fn exact_steps_of_a_bonded_contact_are_right_to_1e_12() {
    for size in [1e-7, 1.3e-5, 1e-3, 0.7] {
        for single in [true, false] {
            let mut scene = scene(ContactLawKind::Bonded);
            scene.solver.maximum_step = if single { 1.001 * size } else { 0.0 };
            let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
            for k in 1..=50 {
                rig.run_to(&Inputs::default(), f64::from(k) * size).unwrap();
                let exact = rig.model.preload.force + force(&rig.model, rig.state.time);
                let error = (rig.state.contact().force - exact).abs() / rig.model.force_scale;
                assert!(error < 1e-12, "{size} s, step {k}: {error:e}");
            }
            let fewer = !single && size < 1e-3;
            assert_eq!(rig.state.steps < 50, fewer, "{size} s");
            assert!(rig.state.steps <= 50, "{size} s");
        }
    }
}

/// Communication points inside long exact steps, which are read from polynomials: within the tolerance of single exact
/// steps, also just after an input has changed, and the same bits after a restored state.
#[test]
fn what_is_read_inside_exact_steps_is_within_the_tolerance() {
    for law in [ContactLawKind::Bonded, ContactLawKind::Linearised] {
        for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
            for size in [1e-6, 7e-6] {
                let mut scene = scene(law);
                scene.solver.tolerance = tolerance;
                let mut inside = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                let allowed = tolerance * inside.model().force_scale;
                let stiffness = inside.real(RealOutput::PreloadContactStiffness);
                scene.solver.maximum_step = 1.001 * size;
                let mut single = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                let mut restored = inside.clone();
                for k in 0..600 {
                    let pulsed = accelerated(if k / 100 % 2 == 1 { 20.0 } else { 0.0 }, 0.0);
                    let time = f64::from(k) * size;
                    for simulation in [&mut inside, &mut single, &mut restored] {
                        simulation.step(&pulsed, time, size).unwrap();
                    }
                    let read = [RealOutput::ContactForce, RealOutput::ContactIndentation]
                        .map(|output| (inside.real(output), single.real(output), restored.real(output)));
                    for ((found, exact, restored), allowed) in read.into_iter().zip([allowed, allowed / stiffness]) {
                        assert_eq!(found, restored);
                        near(format_args!("{law:?}, {tolerance:e}, {size} s, step {k}"), found, exact, allowed);
                    }
                    if k % 37 == 0 {
                        restored = Simulation::resume(
                            &inside.model().scene,
                            &relay_contact::reference::Initial::default(),
                            inside.motion(),
                        )
                        .unwrap();
                    }
                }
                assert_eq!(single.integer(IntegerOutput::SolverSteps), 600);
                let steps = inside.integer(IntegerOutput::SolverSteps);
                assert!(steps < 300, "{law:?}, {tolerance:e}, {size} s: {steps}");
            }
        }
    }
}

/// Damping of beam (alpha, beta) and contact (beta_c): equal, none, one of the three alone, and mixtures.
const DAMPINGS: [(f64, f64, f64); 9] = [
    (0.0, 8.063e-5, 8.063e-5),
    (0.0, 0.0, 0.0),
    (3000.0, 0.0, 0.0),
    (0.0, 8.063e-5, 0.0),
    (0.0, 0.0, 8.063e-5),
    (100.0, 8.063e-5, 8.063e-5),
    (100.0, 8.063e-5, 1e-5),
    (500.0, 1e-6, 1e-4),
    (0.0, 8.063e-5, 8.0631e-5),
];

/// Of so many modes.
fn damped(law: ContactLawKind, modes: i32, (alpha, beta, contact): (f64, f64, f64)) -> Scene {
    let mut scene = scene(law);
    scene.solver.modes = modes;
    scene.beam.mass_damping = alpha;
    scene.beam.stiffness_damping = beta;
    scene.contact.damping = contact;
    scene
}

/// Contact `factor` times as stiff under the same preload force, or nearly.
fn stiffen(scene: &mut Scene, factor: f64) {
    let root = factor.sqrt();
    scene.contact.curvature_radius *= root.min(40.0);
    scene.contact.moving.youngs_modulus *= root.powi(2).min(100.0);
    scene.contact.fixed.youngs_modulus *= root.powi(2).min(100.0);
}

/// Largest error of the contact force, relative to its scale and in roundings of what it is made of, under acceleration held or growing,
/// moving support and the generator, against the exponential of the matrix of all of it.
///
/// Both round each mode to the last place in every step, and the force is the sum of what spring and damper make of the modes,
/// up to 1000 times the force scale with the stiff contact.
fn error_against_the_exponential(scene: &Scene) -> (f64, f64) {
    let length = 3e-6;
    let mut rig = Rig::new(Model::new(scene, 0.0).unwrap());
    let model = rig.model.clone();
    let (k, beta_c) = (model.law.coefficient, model.law.damping);
    let (n, omega) = (model.modes.len(), TAU * scene.excitation.frequency);
    // q_i w, v_i, then u, u', acceleration of the input, sine, cosine, jerk: w makes displacements as large as velocities.
    let w = model.modes.last().unwrap().omega_squared.sqrt();
    let mut matrix = DMatrix::zeros(2 * n + 6, 2 * n + 6);
    for (i, mode) in model.modes.iter().enumerate() {
        matrix[(i, n + i)] = w;
        matrix[(n + i, i)] = -mode.omega_squared / w;
        matrix[(n + i, n + i)] = -mode.damping;
        for (j, other) in model.modes.iter().enumerate() {
            matrix[(n + i, j)] -= k * mode.tip * other.tip / w;
            matrix[(n + i, n + j)] -= k * beta_c * mode.tip * other.tip;
        }
        matrix[(n + i, 2 * n)] = k * mode.tip;
        matrix[(n + i, 2 * n + 1)] = k * beta_c * mode.tip;
        matrix[(n + i, 2 * n + 2)] = -mode.participation;
        matrix[(n + i, 2 * n + 3)] = -mode.participation;
    }
    matrix[(2 * n, 2 * n + 1)] = 1.0;
    matrix[(2 * n + 2, 2 * n + 5)] = 1.0;
    matrix[(2 * n + 3, 2 * n + 4)] = omega;
    matrix[(2 * n + 4, 2 * n + 3)] = -omega;
    let matrix = matrix * length;
    let step = matrix.exp();

    let mut motion = DVector::zeros(2 * n + 6);
    let (mut support, mut off, mut largest) = (0.0, 0.0_f64, model.force_scale);
    for count in 0..40 {
        let start = rig.state.time;
        let inputs = Inputs {
            base_acceleration: if count < 20 { 30.0 } else { -50.0 },
            base_acceleration_rate: f64::from(count % 3) * 20.0 / length,
            support_displacement: 1e-9 * f64::from(count % 7),
            ..Inputs::default()
        };
        let phase = TAU * turned(scene.excitation.frequency, start);
        let rate = (inputs.support_displacement - support) / length;
        let loads = [
            support,
            rate,
            inputs.base_acceleration,
            AMPLITUDE * phase.sin(),
            AMPLITUDE * phase.cos(),
            inputs.base_acceleration_rate,
        ];
        motion.rows_mut(2 * n, 6).copy_from_slice(&loads);
        motion = &step * motion;
        support = inputs.support_displacement;
        rig.run_to(&inputs, f64::from(count + 1) * length).unwrap();

        let mut force = k * (support + beta_c * rate);
        for (i, mode) in model.modes.iter().enumerate() {
            let parts = [motion[i] / w, beta_c * motion[n + i]].map(|part| k * mode.tip * part);
            force -= parts[0] + parts[1];
            largest = largest.max(parts[0].abs() + parts[1].abs());
        }
        off = worst(off, (rig.state.contact().force - model.preload.force - force).abs());
    }
    assert_eq!(rig.state.steps, 40);
    (off / model.force_scale, off / (f64::EPSILON * largest))
}

#[test]
fn every_damping_and_load_against_the_matrix_exponential() {
    for damping in DAMPINGS {
        for (modes, factor, mass) in
            [(1, 1.0, 22.6e-6), (4, 1.0, 22.6e-6), (4, 1.0, 0.0), (3, 100.0, 22.6e-6), (3, 0.01, 0.0)]
        {
            let mut scene = damped(ContactLawKind::Bonded, modes, damping);
            scene.tip.mass = mass;
            stiffen(&mut scene, factor);
            // At the resonance, which without damping has no steady motion.
            scene.excitation.frequency = Model::new(&scene, 0.0).unwrap().frequency;
            let (_, roundings) = error_against_the_exponential(&scene);
            // Spring and damper, of both, in forty steps, which add up as they happen to.
            assert!(roundings < 160.0_f64.sqrt(), "{damping:?} {modes} {factor} {mass}: {roundings}");
        }
    }
}

/// Two equal eigenvalues, which have one eigenvector: with one damping for beam and contact, and with two.
#[test]
fn exact_steps_hold_through_critical_damping() {
    let model = Model::new(&damped(ContactLawKind::Bonded, 1, (0.0, 0.0, 0.0)), 0.0).unwrap();
    let mode = model.modes[0];
    let contact = model.preload.contact_stiffness * mode.tip * mode.tip;
    let critical = 2.0 * (mode.omega_squared + contact).sqrt();
    for off in [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-5, -1e-5, 1e-4, 1e-3, 1e-2, -1e-2] {
        let both = critical * (1.0 + off) / (mode.omega_squared + contact);
        let beam = 1e-6;
        let unequal = (critical * (1.0 + off) - beam * mode.omega_squared) / contact;
        for damping in [(0.0, both, both), (0.0, beam, unequal), (0.0, 0.0, critical * (1.0 + off) / contact)] {
            let (worst, _) = error_against_the_exponential(&damped(ContactLawKind::Bonded, 1, damping));
            assert!(worst < 1e-12, "{off:e} {damping:?}: {worst:e}");
        }
    }
}

/// One step or many: the same to rounding, from the default number of modes to the most.
///
/// A step rounds each mode to the last place, and the force is the sum of what spring and damper make of the modes; the errors
/// of steps add up as a random walk where nothing is damped. Without damping the phase of a mode of frequency w is uncertain by
/// w t units of the last place whatever the method, so the time is short.
#[test]
fn one_long_step_is_many_short_ones() {
    for damping in DAMPINGS {
        for modes in [1, 2, 8, 22, 40] {
            let (size, parts) = (1e-4, 100);
            let mut scene = damped(ContactLawKind::Bonded, modes, damping);
            let mut one = Rig::new(Model::new(&scene, 0.0).unwrap());
            scene.solver.maximum_step = 1.001 * size / f64::from(parts);
            let mut many = Rig::new(Model::new(&scene, 0.0).unwrap());
            let mut off = 0.0;
            for count in 0..5 {
                let inputs = accelerated(20.0 * f64::from(count), 0.0);
                one.run_to(&inputs, f64::from(count + 1) * size).unwrap();
                for part in 1..=parts {
                    many.run_to(&inputs, (f64::from(count) + f64::from(part) / f64::from(parts)) * size).unwrap();
                }
                off =
                    worst(off, (one.state.contact().force - many.state.contact().force).abs() / one.model.force_scale);
            }
            assert_eq!((one.state.steps, many.state.steps), (5, 500), "{damping:?}, {modes} modes");
            assert!(off < 1e-12, "{damping:?}, {modes} modes: {off:e}");
        }
    }
}

/// With the cut out of reach the linearised contact is the bonded one, in no more steps than communication steps.
#[test]
fn linearised_out_of_reach_of_the_cut_is_bonded() {
    for damping in DAMPINGS {
        let run = |law| {
            let mut scene = damped(law, 8, damping);
            // Without damping the force swings as far again as the steady motion does.
            scene.excitation.amplitude = 20.0;
            let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
            for k in 1..=30 {
                rig.run_to(&Inputs::default(), f64::from(k) * 1.3e-4).unwrap();
            }
            assert!(rig.state.steps <= 30, "{law:?}, {damping:?}");
            (rig.state.steps, rig.state.contact().force)
        };
        assert_eq!(run(ContactLawKind::Bonded), run(ContactLawKind::Linearised), "{damping:?}");
    }
}

/// Where the contact opens, the collocation finds it, as it does without exact steps.
#[test]
fn linearised_that_opens_is_left_to_the_collocation() {
    let mut scene = scene(ContactLawKind::Linearised);
    scene.excitation.amplitude = 400.0;
    let mut mixed = Rig::new(Model::new(&scene, 0.0).unwrap());
    let mut plain = Rig::new(mixed.model.clone().with(|_| ()));
    let allowed = 2.0 * scene.solver.effective_tolerance() * mixed.model.force_scale;
    for k in 1..=100 {
        for rig in [&mut mixed, &mut plain] {
            rig.run_to(&Inputs::default(), f64::from(k) * 2e-5).unwrap();
        }
        let difference = (mixed.state.contact().force - plain.state.contact().force).abs();
        assert!(difference <= allowed, "step {k}: {difference:e}");
        assert!(mixed.state.contact().force >= 0.0);
    }
    assert!(mixed.state.contact().last_opening > Some(0.0), "the contact never opened");
}

/// A generator that starts inside a communication step: one exact step from there on, as the contact rests before.
#[test]
fn the_generator_starts_inside_a_step() {
    let mut scene = scene(ContactLawKind::Bonded);
    scene.excitation.start_time = 1e-4;
    let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
    rig.run_to(&Inputs::default(), 2.5e-4).unwrap();
    let exact = rig.model.preload.force + force(&rig.model, 1.5e-4);
    assert_eq!(rig.state.steps, 1);
    assert!((rig.state.contact().force - exact).abs() < 1e-12 * rig.model.force_scale);
}
