//! Extreme accelerations. A jump at a communication point is in every [`Ride::shaken`].

use crate::ride::{Ride, Segment};
use relay_contact::scene::Scene;

#[test]
fn ten_thousand_g() {
    shake(8.063e-5);
}

#[test]
fn ten_thousand_g_without_damping() {
    shake(0.0);
}

fn shake(damping: f64) {
    let mut scene = Scene::default();
    scene.contact.damping = damping;
    let mut ride = Ride::shaken(scene);
    ride.segments = [98_066.5, -98_066.5, 98_066.5, 0.0]
        .map(|acceleration| Segment {
            duration: 1e-4,
            acceleration,
            support: 0.0,
        })
        .to_vec();
    ride.keeps_its_properties();
}

#[test]
fn a_jump_in_acceleration_at_every_communication_point() {
    let mut ride = Ride::shaken(Scene::default());
    ride.segments = (0..200)
        .map(|k| Segment {
            duration: 1e-5,
            acceleration: if k % 3 == 0 { -2000.0 } else { 1000.0 },
            support: 0.0,
        })
        .collect();
    ride.keeps_its_properties();
}
