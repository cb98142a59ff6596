//! The armature between magnet, return spring and stops: its two positions and what takes it from the core, by closed forms,
//! and its way between the stops by Runge and Kutta's method in small steps. Its bounces in a shock are compared with another
//! solution in `tests/python/test_relay_parts.py`.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{BooleanOutput, ExcitationKind, PusherKind, RealOutput};

/// An armature that feels all of its weight, and whose pusher meets the spring on the way to its core.
fn relay() -> Scene {
    let mut scene = Scene::default();
    scene.effects.pusher = PusherKind::Armature;
    scene.contact.overtravel = -5e-5;
    scene.armature.unbalance = 1.0;
    scene
}

/// The same out of reach of the spring, however far that swings.
fn alone() -> Scene {
    let mut scene = relay();
    scene.contact.overtravel = -1e-3;
    scene.armature.rest_position = -1.04e-2;
    scene.armature.core_position = -1e-2;
    scene.solver.tolerance = 1e-7;
    scene
}

fn coil(current: f64) -> Inputs {
    Inputs {
        coil_relative_current: current,
        ..Inputs::default()
    }
}

fn close(a: f64, b: f64, share: f64) {
    assert!((a - b).abs() <= share * b.abs(), "{a} {b}");
}

/// Balance of forces in both.
#[test]
fn the_coil_says_which_of_two_positions_it_has() {
    let scene = relay();
    let given = scene.armature;
    let on = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let preload = on.model().preload();
    assert!(preload.force > 0.1 && preload.pusher_force > 0.1 && on.boolean(BooleanOutput::PusherClosed));
    let place = on.real(RealOutput::ArmatureDisplacement);
    close(
        place,
        given.core_position + preload.armature.core_force / given.stop_stiffness,
        1e-12,
    );
    let spring = given.return_force + given.stiffness * (place - given.rest_position);
    close(
        preload.armature.core_force,
        given.hold_force - spring - preload.pusher_force,
        1e-9,
    );
    close(
        on.real(RealOutput::StepMinimumStopForce),
        preload.armature.core_force,
        1e-12,
    );
    close(on.real(RealOutput::ArmatureGap), given.core_position - place, 1e-9);

    let off = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
    let preload = off.model().preload();
    assert_eq!(
        (preload.force, preload.pusher_force, preload.armature.magnet_force),
        (0.0, 0.0, 0.0)
    );
    close(preload.armature.rest_force, given.return_force, 1e-3);
    // Too weak a current holds nothing.
    let weak = Simulation::new(&scene, &coil(0.2), 0.0).unwrap();
    assert!(weak.model().preload().armature.core_force == 0.0);
}

/// A slow acceleration takes the armature from its core where its weight is what holds it: hold force less return spring.
#[test]
fn a_slow_acceleration_releases_it_at_its_holding_force_over_its_mass() {
    let scene = alone();
    let given = scene.armature;
    let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let held = simulation.model().preload().armature.core_force;
    let threshold = held / given.mass;
    let (rate, step) = (-threshold / 0.05, 1e-4);
    for n in 0..600 {
        let time = f64::from(n) * step;
        let inputs = Inputs {
            base_acceleration: rate * time,
            base_acceleration_rate: rate,
            ..coil(1.0)
        };
        simulation.step(&inputs, time, step).unwrap();
    }
    let release = simulation.real(RealOutput::ArmatureLastRelease);
    // The stop swings at sqrt(k / m) = 22 kHz: the force lags by microseconds.
    assert!((release - 0.05).abs() < 5e-5, "{release}");
}

/// Equations of the armature alone.
struct Alone {
    scene: Scene,
    damper: f64,
    current: f64,
}

impl Alone {
    fn new(scene: &Scene) -> Self {
        let given = scene.armature;
        // From restitution to damping by its closed form (Schwager and Poeschel 2007), bisected.
        let left = |z: f64| {
            let root = (1.0 - z * z).sqrt();
            (-z / root * f64::atan2(2.0 * z * root, 2.0 * z * z - 1.0)).exp()
        };
        let (mut low, mut high) = (0.0, 0.999);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if left(middle) > given.stop_restitution {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self {
            scene: scene.clone(),
            damper: 2.0 * low * (given.stop_stiffness * given.mass).sqrt(),
            current: 1.0,
        }
    }

    fn acceleration(&self, p: f64, v: f64) -> f64 {
        let given = self.scene.armature;
        let gap = (given.core_position - p).max(0.0);
        let magnet = given.hold_force * self.current.powi(2) / (1.0 + gap / given.gap_constant).powi(2);
        let stop = |d: f64, rate: f64| {
            if d > 0.0 {
                (given.stop_stiffness * d + self.damper * rate).max(0.0)
            } else {
                0.0
            }
        };
        let stops = stop(given.rest_position - p, -v) - stop(p - given.core_position, v);
        let spring = given.return_force + given.stiffness * (p - given.rest_position) + given.damping * v;
        (magnet - spring + stops) / given.mass
    }

    /// Positions (m) at the multiples of a step, each of many small ones.
    fn course(&mut self, start: f64, current: impl Fn(f64) -> f64, steps: u32, step: f64) -> Vec<f64> {
        const PARTS: u32 = 4000;
        let h = step / f64::from(PARTS);
        let (mut p, mut v) = (start, 0.0);
        let mut course = Vec::new();
        for n in 0..steps {
            self.current = current(f64::from(n) * step);
            for _ in 0..PARTS {
                let rates = |p: f64, v: f64| (v, self.acceleration(p, v));
                let (k1, l1) = rates(p, v);
                let (k2, l2) = rates(p + 0.5 * h * k1, v + 0.5 * h * l1);
                let (k3, l3) = rates(p + 0.5 * h * k2, v + 0.5 * h * l2);
                let (k4, l4) = rates(p + h * k3, v + h * l3);
                p += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
            }
            course.push(p);
        }
        course
    }
}

/// Positions of the component.
fn course(simulation: &mut Simulation, inputs: impl Fn(f64) -> Inputs, steps: u32, step: f64) -> Vec<f64> {
    (0..steps)
        .map(|n| {
            let time = f64::from(n) * step;
            simulation.step(&inputs(time), time, step).unwrap();
            simulation.real(RealOutput::ArmatureDisplacement)
        })
        .collect()
}

/// Switched off it falls to its rest stop, switched on it is drawn back.
#[test]
fn a_coil_switched_off_and_on_moves_it_to_and_fro() {
    let scene = alone();
    let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
    let start = simulation.model().preload().armature.place;
    let current = |t: f64| if (0.001..0.021).contains(&(t + 1e-9)) { 0.0 } else { 1.5 };
    let found = course(&mut simulation, |t| coil(current(t)), 4000, 1e-5);
    let expected = Alone::new(&scene).course(start, current, 4000, 1e-5);
    let travel = scene.armature.core_position - scene.armature.rest_position;
    let least = expected.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least < scene.armature.rest_position);
    // Steps of 2.5 ns over jumps of the force leave some 1e-5 m/s of each touch.
    for (n, (a, b)) in found.iter().zip(&expected).enumerate() {
        assert!((a - b).abs() < 5e-5 * travel, "{n}: {a} {b}");
    }
}

/// The whole: contact, pusher and core under a shock; held, and released.
#[test]
fn a_released_armature_opens_the_contact() {
    let mut scene = relay();
    // A magnet that draws it back from any place.
    scene.armature.gap_constant = 5e-4;
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.duration = 2e-3;
    let run = |amplitude: f64| {
        let mut scene = scene.clone();
        scene.excitation.amplitude = amplitude;
        let mut simulation = Simulation::new(&scene, &coil(1.0), 0.0).unwrap();
        for n in 0..2000 {
            simulation.step(&coil(1.0), f64::from(n) * 1e-5, 1e-5).unwrap();
        }
        assert!(simulation.force_error() < 1e-5);
        let released = simulation.real(RealOutput::ArmatureLastRelease) > 0.0;
        let opened = simulation.real(RealOutput::ContactLastOpening) > 0.0;
        let back = simulation.real(RealOutput::ContactForce) / simulation.model().preload().force;
        (released, opened, back)
    };
    let (released, opened, _) = run(-100.0);
    assert!(!released && !opened);
    let (released, opened, back) = run(-3000.0);
    assert!(released && opened);
    close(back, 1.0, 1e-3);
}

/// Between elastic stops an armature alone keeps the sum of kinetic energy, that of its return spring and stops, and what the
/// magnet stores over the gap, `F_h g / (1 + g / g_0)`: by the formulas, and by the balance of the component.
#[test]
fn energy_is_kept_between_magnet_return_spring_and_stops() {
    let mut scene = alone();
    scene.effects.energy = true;
    scene.armature.stop_restitution = 1.0;
    scene.armature.damping = 0.0;
    // Enough to draw it from its rest.
    scene.armature.hold_force *= 4.0;
    let given = scene.armature;
    let mut simulation = Simulation::new(&scene, &coil(0.0), 0.0).unwrap();
    let energy = |simulation: &Simulation| {
        let [place, velocity] =
            [RealOutput::ArmatureDisplacement, RealOutput::ArmatureVelocity].map(|output| simulation.real(output));
        let gap = given.core_position - place;
        let way = place - given.rest_position;
        let stored = if gap > 0.0 {
            given.hold_force * gap / (1.0 + gap / given.gap_constant)
        } else {
            given.hold_force * gap + 0.5 * given.stop_stiffness * gap * gap
        };
        let rest = 0.5 * given.stop_stiffness * way.min(0.0).powi(2);
        0.5 * given.mass * velocity * velocity
            + given.return_force * way
            + 0.5 * given.stiffness * way * way
            + stored
            + rest
    };
    let start = energy(&simulation);
    let (mut seated, mut fastest) = (0, 0.0_f64);
    for n in 0..2000 {
        simulation.step(&coil(1.0), f64::from(n) * 1e-5, 1e-5).unwrap();
        seated += i32::from(simulation.real(RealOutput::ArmatureGap) < 0.0);
        fastest = fastest.max(simulation.real(RealOutput::ArmatureVelocity));
        let kinetic = 0.5 * given.mass * fastest * fastest;
        let lost = energy(&simulation) - start;
        assert!(lost.abs() < 1e-4 * kinetic.max(1e-7), "{n}: {lost} of {kinetic}");
        let balance = simulation.real(RealOutput::EnergyBalance);
        assert!(balance.abs() < 1e-4 * kinetic.max(1e-7), "{n}: {balance} of {kinetic}");
    }
    assert!(seated > 10 && fastest > 0.1, "{seated} {fastest}");
}
