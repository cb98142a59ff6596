//! Extreme contacts and ways of touching.

use crate::common::{Rig, compose, hertz, oscillator};
use crate::ride::{Ride, Segment};
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::ContactLawKind;

fn with_stiffness(factor: f64) -> Ride {
    let mut scene = Scene::default();
    scene.contact.moving.youngs_modulus *= factor;
    scene.contact.fixed.youngs_modulus *= factor;
    Ride::shaken(scene)
}

fn with_damping(damping: f64) -> Ride {
    let mut scene = Scene::default();
    scene.contact.damping = damping;
    Ride::shaken(scene)
}

#[test]
fn a_contact_100_times_stiffer() {
    with_stiffness(100.0).keeps_its_properties();
}

#[test]
fn a_contact_100_times_softer() {
    with_stiffness(0.01).keeps_its_properties();
}

#[test]
fn a_contact_without_damping() {
    with_damping(0.0).keeps_its_properties();
}

#[test]
fn a_contact_that_is_a_rigid_dashpot() {
    // Damping 1 s times the tangent stiffness of 3.5e6 N/m on some milligrams: an eigenvalue beyond -1e9 1/s.
    with_damping(1.0).keeps_its_properties();
}

#[test]
fn linear_laws() {
    for law in [ContactLawKind::Linearised, ContactLawKind::Bonded] {
        for damping in [0.0, 8.063e-5] {
            let mut ride = with_damping(damping);
            ride.scene.effects.contact_law = law;
            ride.keeps_its_properties();
        }
    }
}

/// A spring thrown at a contact it just reaches, or just misses, within one long communication step.
#[test]
fn a_grazing_touch() {
    let gap = 1e-5;
    let mut scene = Scene::default();
    scene.beam.stiffness_damping = 0.0;
    scene.contact.overtravel = -gap;
    scene.solver.modes = 4;
    let throw = |scene: &Scene, speed: f64| {
        let mut rig = Rig::new(Model::new(scene, 0.0).unwrap());
        let velocities: Vec<f64> = rig.model.modes.iter().map(|mode| -speed * mode.participation).collect();
        rig.launch(&velocities);
        rig
    };
    // How far a throw with 1 m/s goes within the time looked at: free motion, so it goes with the speed.
    let (duration, rest) = (1.7e-3, Inputs::default());
    let mut far = scene;
    far.contact.overtravel = -5e-3;
    let reach = |at: f64| {
        let mut rig = throw(&far, 1.0);
        rig.run_to(&rest, at).unwrap();
        (rig.state.indentation, rig.state.indentation_rate)
    };
    let samples = (1..1700).map(|k| 1e-6 * f64::from(k));
    let nearest = samples.max_by(|a, b| reach(*a).0.total_cmp(&reach(*b).0)).unwrap();
    let top = relay_contact::math::roots::bracketed(|at| reach(at).1, nearest - 2e-6, nearest + 2e-6).unwrap();
    let (highest, _) = reach(top);
    for (factor, touches) in [
        (1e-2, true),
        (1e-4, true),
        (1e-6, true),
        (-1e-12, false),
        (-1e-6, false),
        (-1e-2, false),
    ] {
        let mut rig = throw(&scene, gap / highest * (1.0 + factor));
        rig.run_to(&rest, duration).unwrap();
        assert_eq!(rig.state.last_closing > 0.0, touches, "overlap {factor} of the gap");
    }
}

/// A mass that falls on the contact again and again, a little less high each time, until it lies still under its weight.
#[test]
fn chatter_that_accumulates() {
    let (mass, weight) = (1e-4, 100.0);
    let model = compose(&[oscillator(mass, 0.0)], hertz(9.3e9, 1e-6), 1e-6, 1e-6, mass * weight);
    let mut coarse = Rig::new(model.clone());
    let mut fine = Rig::new(model);
    let inputs = Inputs {
        base_acceleration: weight,
        ..Inputs::default()
    };
    coarse.run_to(&inputs, 0.05).unwrap();
    let (mut closings, mut last) = (0, -1.0);
    for k in 1..=50_000 {
        fine.run_to(&inputs, 1e-6 * f64::from(k)).unwrap();
        assert!(fine.state.force >= 0.0 && fine.state.indentation.is_finite());
        closings += u32::from(fine.state.last_closing > last);
        last = fine.state.last_closing;
    }
    assert!(closings > 5, "{closings}");
    for rig in [&coarse, &fine] {
        let off = (rig.state.force - mass * weight).abs();
        assert!(off <= 1e-6 * mass * weight, "{off:e}");
        assert!(rig.state.steps < 100_000);
    }
}

#[test]
fn a_spring_pressed_against_the_contact_from_a_gap() {
    let mut scene = Scene::default();
    scene.contact.overtravel = -1e-5;
    scene.contact.damping = 1e-6;
    scene.beam.stiffness_damping = 1e-6;
    Ride {
        scene,
        speed: 0.0,
        segments: vec![
            Segment {
                duration: 2e-3,
                acceleration: 300.0,
                support: 0.0,
            };
            3
        ],
        steps: 100_000,
    }
    .keeps_its_properties();
}

#[test]
fn an_impact_at_10_metres_per_second() {
    impact(8.063e-5);
}

#[test]
fn an_undamped_impact_at_10_metres_per_second() {
    impact(0.0);
}

fn impact(damping: f64) {
    let mut scene = Scene::default();
    scene.contact.damping = damping;
    scene.contact.overtravel = -1e-4;
    Ride {
        scene,
        speed: -10.0,
        segments: vec![
            Segment {
                duration: 1e-4,
                acceleration: 0.0,
                support: 0.0,
            };
            3
        ],
        steps: 100_000,
    }
    .keeps_its_properties();
}

/// The surfaces touch without force at the start, and the fixed contact moves in at once.
#[test]
fn a_touch_at_the_start() {
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.0;
    let ride = Ride {
        scene,
        speed: 0.0,
        segments: vec![Segment {
            duration: 1e-3,
            acceleration: 0.0,
            support: 1e-4,
        }],
        steps: 100_000,
    };
    let outcome = ride.run(1).unwrap();
    assert!(
        (0.0..1e-9).contains(&outcome.rig.state.last_closing),
        "{:?}",
        outcome.rig.state.last_closing
    );
    ride.keeps_its_properties();
}

/// The surfaces touch without force at the start.
#[test]
fn no_gap_and_no_overlap() {
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.0;
    Ride::shaken(scene).keeps_its_properties();
}

#[test]
fn open_for_a_second_then_closing() {
    let segment = |duration, support| Segment {
        duration,
        acceleration: 0.0,
        support,
    };
    let ride = Ride {
        scene: Scene::default(),
        speed: 0.0,
        segments: vec![
            segment(1e-3, -3e-4),
            segment(1.0, -3e-4),
            segment(1e-3, 0.0),
            segment(0.02, 0.0),
        ],
        steps: 100_000,
    };
    let outcome = ride.keeps_its_properties();
    assert_eq!(outcome.forces[1], 0.0);
    // Back where it began.
    let preload = outcome.rig.model.preload.force;
    assert!(
        (outcome.forces[3] - preload).abs() < 1e-6 * preload,
        "{:?}",
        outcome.forces
    );
}

#[test]
fn a_support_that_crushes_by_a_millimetre() {
    for duration in [1e-2, 1e-3, 1e-4] {
        let segment = |duration, support| Segment {
            duration,
            acceleration: 0.0,
            support,
        };
        Ride {
            scene: Scene::default(),
            speed: 0.0,
            segments: vec![segment(duration, 1e-3), segment(1e-3, 1e-3)],
            steps: 1_000_000,
        }
        .keeps_its_properties();
    }
}

/// The support withdraws so slowly that the force passes every power of ten on its way to zero; preloads so small that
/// the force itself has lost digits.
#[test]
fn subnormal_forces_at_release() {
    let withdraw = Ride {
        scene: Scene::default(),
        speed: 0.0,
        segments: vec![Segment {
            duration: 0.2,
            acceleration: 0.0,
            support: -2.01e-4,
        }],
        steps: 100_000,
    };
    assert_eq!(withdraw.keeps_its_properties().forces, [0.0]);
    for overtravel in [1e-20, 1e-100, 1e-200, 1e-290, 1e-306, 1e-312, 5e-324] {
        let mut scene = Scene::default();
        scene.contact.overtravel = overtravel;
        Ride::shaken(scene).keeps_its_properties();
    }
}
