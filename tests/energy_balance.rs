//! The balance of the energy stays below the tolerance. That it is the sum of all works, stored energies and losses is tested
//! in `energy::balance` of the integrator.
//!
//! A force wrong by `e` along a way `s` of the tip changes the energy by at most `e s`: the balance has to stay below the
//! tolerance times the force scale times the way.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, FrictionKind, IntegerOutput, PusherKind, RealOutput};
use testing::rig::Rig;
use testing::scenes::{self, accelerated, supported, undamped};

/// Inputs over the communication step from an instant (s) by a length (s).
type Drive = fn(f64, f64) -> Inputs;

struct Case {
    name: &'static str,
    scene: Scene,
    drive: Drive,
    /// s.
    stop: f64,
    /// Velocity of the base at the start, m/s, where nothing else gets things going.
    launch: f64,
}

fn held(_: f64, _: f64) -> Inputs {
    Inputs::default()
}

/// 500 Hz, 150 m/s2, held.
fn base_held(time: f64, _: f64) -> Inputs {
    accelerated(150.0 * (TAU * 500.0 * time).sin(), 0.0)
}

/// The same, linear between communication points.
fn base_linear(time: f64, size: f64) -> Inputs {
    let at = |time: f64| 150.0 * (TAU * 500.0 * time).sin();
    accelerated(at(time), (at(time + size) - at(time)) / size)
}

/// The fixed contact goes back and forth by 40 nm, 800 times a second.
fn support_moves(time: f64, size: f64) -> Inputs {
    let at = |time: f64| 4e-8 * (1.0 - (TAU * 800.0 * time).cos());
    supported(at(time), (at(time + size) - at(time)) / size)
}

fn shaken(amplitude: f64) -> Scene {
    scenes::shaken(amplitude, 1000.0)
}

/// Without damping, so that the balance is the whole change of the energy.
fn undamped_law(kind: ContactLawKind) -> Scene {
    let mut scene = undamped();
    scene.effects.contact_law = kind;
    scene
}

/// Steps of the linear scenes are exact, unless a longest step is set.
fn law(kind: ContactLawKind, maximum_step: f64) -> Scene {
    let mut scene = shaken(300.0);
    scene.effects.contact_law = kind;
    scene.solver.maximum_step = maximum_step;
    scene
}

fn cases() -> Vec<Case> {
    let case = |name, scene, drive| Case { name, scene, drive, stop: 3e-3, launch: 0.0 };
    let launched = |name, kind| Case { launch: 0.1, ..case(name, undamped_law(kind), held) };
    vec![
        case("98 m/s2 at 1000 Hz", shaken(98.0), held),
        case("chatter at 400 m/s2", shaken(400.0), held),
        case("base held", Scene::default(), base_held),
        case("base linear", Scene::default(), base_linear),
        case("fixed contact moves", Scene::default(), support_moves),
        case("fixed contact moves, chatter", shaken(400.0), support_moves),
        case("rough", law(ContactLawKind::Rough, 2e-5), held),
        case("linearised", law(ContactLawKind::Linearised, 2e-5), held),
        case("bonded", law(ContactLawKind::Bonded, 2e-5), held),
        case("bonded, exact steps", law(ContactLawKind::Bonded, 0.0), held),
        Case { launch: 1e-3, ..case("undamped", undamped(), held) },
        launched("undamped, blows", ContactLawKind::Hertz),
        launched("undamped rough, blows", ContactLawKind::Rough),
        launched("undamped linearised, blows", ContactLawKind::Linearised),
        launched("undamped bonded", ContactLawKind::Bonded),
    ]
}

/// Runs a case with communication steps of `size` (s). Returns the balance, and what is allowed, J.
fn run(case: &Case, tolerance: f64, size: f64) -> (f64, f64) {
    let mut scene = case.scene.clone();
    scene.solver.tolerance = tolerance;
    scene.solver.modes = 6;
    scene.effects.energy = true;
    let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
    if case.launch > 0.0 {
        rig.throw(case.launch);
    }
    // Of the tip against the fixed contact, m.
    let mut way = 0.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousands
    let steps = (case.stop / size).round() as u32;
    for k in 0..steps {
        let inputs = (case.drive)(rig.state.time, size);
        let from = rig.state.contact().approach;
        rig.run_to(&inputs, f64::from(k + 1) * size).unwrap();
        way += (rig.state.contact().approach - from).abs();
    }
    (rig.state.energy_balance, tolerance * rig.model.force_scale * way)
}

#[test]
fn the_balance_stays_below_the_tolerance() {
    for case in cases() {
        for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
            for size in [1e-4, 1e-5] {
                let (balance, allowed) = run(&case, tolerance, size);
                assert!(
                    balance.abs() < allowed,
                    "{}, {tolerance:e}, {size:e} s: {balance:e} J, allowed {allowed:e} J",
                    case.name
                );
            }
        }
    }
}

/// With a coefficient of 0 no friction acts: also where a contact opens by its damping while a pusher presses.
#[test]
fn friction_without_force_does_not_change_the_balance() {
    let balance = |friction| {
        let mut scene = Scene::default();
        (scene.contact.overtravel, scene.pusher.position) = (-1e-4, 0.012);
        (scene.effects.pusher, scene.effects.friction) = (PusherKind::Prescribed, friction);
        (scene.friction.coefficient, scene.effects.energy) = (0.0, true);
        let pressed = Inputs { pusher_displacement: 3e-4, ..Inputs::default() };
        let mut simulation = Simulation::new(&scene, &pressed, 0.0).unwrap();
        for k in 0..40 {
            let support_displacement = if k % 2 == 0 { 0.0 } else { -2e-7 };
            let inputs = Inputs { support_displacement, ..pressed };
            simulation.step(&inputs, f64::from(k) * 2e-5, 2e-5).unwrap();
        }
        assert!(simulation.real(RealOutput::ContactLastOpening) > 0.0);
        simulation.real(RealOutput::EnergyBalance)
    };
    let [without, with] = [FrictionKind::None, FrictionKind::Coulomb].map(balance);
    assert!((with - without).abs() < 1e-12, "{with:e} {without:e}");
}

/// Chatter with the balance kept.
fn chatter() -> Simulation {
    let mut scene = shaken(400.0);
    scene.effects.energy = true;
    Simulation::new(&scene, &Inputs::default(), 0.0).unwrap()
}

#[test]
fn the_balance_belongs_to_the_communication_point() {
    let size = 1e-7;
    let mut simulation = chatter();
    let step = |simulation: &mut Simulation, k: u32| {
        simulation.step(&Inputs::default(), f64::from(k) * size, size).unwrap();
        let steps = simulation.integer(IntegerOutput::SolverSteps);
        (steps, simulation.real(RealOutput::EnergyBalance))
    };
    // Through the opening at 0.709 ms and the closing at 1.089 ms.
    let end = 12_000;
    let entries: Vec<_> = (0..end).map(|k| step(&mut simulation, k)).collect();
    // It is drawn up at the ends of the integrator's steps: between them it stays, also where the integrator is ahead.
    let inside = entries.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
    assert!(inside > 9_000, "{inside}");
    for pair in entries.windows(2) {
        assert!(pair[0].0 != pair[1].0 || pair[0].1 == pair[1].1);
    }
    // A drive that changes takes the motion back to the communication point: what was entered beyond it is forgotten.
    let changed = accelerated(1.0, 0.0);
    simulation.step(&changed, f64::from(end) * size, 1e-3).unwrap();
    let way = 1e-4; // m, far more than the tip moves
    assert!(simulation.real(RealOutput::EnergyBalance).abs() < 1e-6 * scenes::force_scale(&shaken(400.0)) * way);
}
