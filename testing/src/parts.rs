//! Random relays with more than one spring and contact: twin contacts, a spring under the fixed contact, pusher, armature.

use std::sync::Arc;

use fastrand::Rng;
use relay_contact::inputs::Inputs;
use relay_contact::scene::spring::Shape;
use relay_contact::scene::{Armature, Scene};
use relay_contact::variables::{AxialForceKind, ContactLawKind, PusherKind};

use crate::relays::{Relay, logarithmic, uniform};
use crate::scenes::tip_stiffness;
use crate::springs::{segments, spring_file};

/// The relay of a number with contacts side by side, at one tip or on tongues.
pub fn parallel(number: u64) -> Relay {
    let forks = !number.is_multiple_of(4);
    let mut relay = if forks { Relay::with_segments(number) } else { Relay::draw(number) };
    relay.scene.effects.contact_law = ContactLawKind::Hertz;
    add_parallel(&mut relay.scene, &mut Rng::with_seed(!number));
    relay
}

/// A contact beside the first, on a tongue of its own where the spring is one of segments.
pub(crate) fn add_parallel(scene: &mut Scene, rng: &mut Rng) {
    keep_axial_force(scene);
    scene.effects.parallel_contact = true;
    scene.parallel.curvature_radius = logarithmic(rng, 3e-4, 3e-2);
    scene.parallel.damping = logarithmic(rng, 1e-7, 1e-4);
    scene.parallel.offset = match rng.u8(..4) {
        0 => 0.0,
        _ => scene.contact.overtravel * [-1.0, 1.0][rng.usize(..2)] * logarithmic(rng, 1e-4, 0.5),
    };
    if let Some(Shape::Segments(segments)) = scene.spring.as_mut().map(|file| &mut Arc::make_mut(file).shape) {
        let contact = segments.contact_position.unwrap_or(segments.length());
        segments.fork_position = Some(contact * uniform(rng, 0.1, 0.9));
    }
}

/// The relay of a number with its fixed contact on a spring.
pub fn fixed_spring(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    add_fixed_spring(&mut relay.scene, &mut Rng::with_seed(!number), &format!("random fixed spring {number}"));
    relay
}

pub(crate) fn add_fixed_spring(scene: &mut Scene, rng: &mut Rng, name: &str) {
    keep_axial_force(scene);
    let mut other = scene.clone();
    other.beam.thickness *= logarithmic(rng, 0.5, 4.0);
    other.beam.length *= logarithmic(rng, 0.3, 1.0);
    let shape = Shape::Segments(segments(rng, &other));
    scene.fixed_spring = spring_file(name, shape);
    scene.fixed.stiffness_damping = scene.beam.stiffness_damping * logarithmic(rng, 0.2, 2.0);
    scene.fixed.mass_damping = scene.beam.mass_damping * logarithmic(rng, 0.2, 2.0);
}

/// The relay of a number, closed by a pusher that rests, or moves to and fro.
pub fn pusher(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    relay.scene.effects.contact_law = ContactLawKind::Hertz;
    add_pusher(&mut relay, &mut Rng::with_seed(!number));
    relay
}

pub(crate) fn add_pusher(relay: &mut Relay, rng: &mut Rng) {
    let (place, _) = push(&mut relay.scene, rng);
    relay.scene.effects.pusher = PusherKind::Prescribed;
    relay.pusher = place;
    relay.pushes = rng.bool();
}

/// The relay of a number, closed by an armature: held, taken from its core by what shakes it, or switched off and on.
pub fn armature(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    relay.scene.effects.contact_law = ContactLawKind::Hertz;
    add_armature(&mut relay, &mut Rng::with_seed(!number));
    relay
}

pub(crate) fn add_armature(relay: &mut Relay, rng: &mut Rng) {
    let scene = &mut relay.scene;
    let (place, force) = push(scene, rng);
    scene.effects.pusher = PusherKind::Armature;
    let travel = place * logarithmic(rng, 0.3, 3.0);
    let beam = &scene.beam;
    let mass = beam.density * beam.width * beam.thickness * beam.length;
    let back = force * logarithmic(rng, 0.05, 0.5);
    scene.armature = Armature {
        mass: (mass * logarithmic(rng, 3.0, 100.0)).max(1e-6),
        stiffness: back / travel * uniform(rng, 0.0, 1.0),
        damping: 0.0,
        return_force: back,
        unbalance: uniform(rng, -1.0, 1.0),
        hold_force: (force + 2.0 * back) * logarithmic(rng, 1.1, 6.0),
        gap_constant: travel * logarithmic(rng, 0.1, 1.0),
        rest_position: place - travel,
        core_position: place,
        stop_stiffness: (tip_stiffness(scene) * logarithmic(rng, 1e2, 1e5)).clamp(1e2, 1e10),
        stop_restitution: uniform(rng, 0.1, 0.9),
    };
    if rng.u8(..3) == 0 {
        // The coil off and on again, at communication points.
        let (_, count) = relay.steps;
        let [off, on] = [uniform(rng, 0.05, 0.5), uniform(rng, 0.5, 0.95)].map(|share| share * f64::from(count));
        relay.knots = (0..count)
            .map(|k| Inputs {
                coil_relative_current: f64::from(u8::from(!(off..on).contains(&f64::from(k)))),
                ..Inputs::default()
            })
            .collect();
    }
}

/// A pusher that closes an open contact: where it stands (m), and about how hard it presses, N.
fn push(scene: &mut Scene, rng: &mut Rng) -> (f64, f64) {
    keep_axial_force(scene);
    let overtravel = scene.contact.overtravel.abs();
    let gap = overtravel * logarithmic(rng, 0.05, 1.0);
    scene.contact.overtravel = -gap;
    let share = uniform(rng, 0.3, 1.0);
    scene.pusher.position = share * scene.beam.length;
    // Deflection there per deflection of the tip, under a force there.
    let ratio = share.powi(3) / (share.powi(2) * (3.0 - share) / 2.0);
    let place = (gap + overtravel) * ratio;
    let stiffness = tip_stiffness(scene) / share.powi(3);
    scene.pusher.stiffness = (stiffness * logarithmic(rng, 30.0, 1e4)).clamp(1.0, 1e10);
    scene.pusher.damping = scene.pusher.stiffness * logarithmic(rng, 1e-7, 1e-5);
    (place, stiffness * place)
}

/// With an axial force that is constant.
pub(crate) fn keep_axial_force(scene: &mut Scene) {
    if scene.effects.axial_force == AxialForceKind::FromDeflection {
        scene.effects.axial_force = AxialForceKind::FromPreload;
    }
}
