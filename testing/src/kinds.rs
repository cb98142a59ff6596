//! Kinds of random relays: the one of a number with a law, a spring, an effect or inputs that not every relay has.

use std::f64::consts::TAU;

use fastrand::Rng;
use relay_contact::inputs::Inputs;
use relay_contact::reference::Spring;
use relay_contact::scene::Scene;
use relay_contact::scene::spring::GivenMode;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind, FrictionKind, ResistanceKind};

use crate::parts;
use crate::relays::{Relay, after, logarithmic, steps, uniform};
use crate::scenes::tip_stiffness;
use crate::springs::{mode, of_modes, spring_file};

/// A kind of relays: its name, how many of a hundred are of it, and the relay of a number.
pub type Kind = (&'static str, u8, fn(u64) -> Relay);

/// All of them.
pub const KINDS: [Kind; 16] = [
    ("plain", 8, Relay::draw),
    ("held", 4, held),
    ("knots", 12, knots),
    ("linear", 8, linear),
    ("rough", 8, rough),
    ("buckling", 6, near_buckling),
    ("segments", 6, Relay::with_segments),
    ("modes", 6, with_modes),
    ("closing", 6, closing),
    ("changeover", 6, changeover),
    ("friction", 6, friction),
    ("parallel", 6, parts::parallel),
    ("fixed", 6, parts::fixed_spring),
    ("pusher", 6, parts::pusher),
    ("armature", 6, parts::armature),
    ("combined", 0, combined),
];

/// The relay of a number, of any kind; a third of those that are shaken by a generator alone or by sines have inputs with
/// knots instead.
pub fn any(number: u64) -> Relay {
    let rng = &mut Rng::with_seed(number.rotate_left(16));
    let mut left = rng.u8(..100);
    let kind = KINDS.iter().find(|(_, share, _)| {
        let found = left < *share;
        left = left.wrapping_sub(*share);
        found
    });
    let (name, _, draw) = kind.expect("shares of a hundred");
    let mut relay = draw(number);
    relay.kind = name;
    if rng.u8(..3) == 0 && relay.knots.is_empty() && !relay.held {
        tie_knots(&mut relay, rng);
    }
    relay
}

/// The relay of a number with inputs that are linear between knots.
pub fn knots(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    tie_knots(&mut relay, &mut Rng::with_seed(!number));
    relay
}

/// Inputs that are linear between knots, beside the generator or alone: base acceleration, which jumps at the start and at
/// some knots, and support displacement.
fn tie_knots(relay: &mut Relay, rng: &mut Rng) {
    let acceleration = relay.scene.excitation.amplitude;
    if rng.bool() {
        relay.scene.effects.excitation = ExcitationKind::None;
    }
    let way = match rng.u8(..3) {
        0 => relay.scene.contact.overtravel.abs() * logarithmic(rng, 0.1, 2.0),
        _ => 0.0,
    };
    // Knots are this many communication steps apart at most.
    let widest = rng.u32(1..=12);
    let (_, count) = relay.steps;
    while relay.knots.len() < count as usize {
        let first = relay.knots.is_empty();
        let jumps = if first { rng.bool() } else { rng.u8(..5) == 0 };
        let jump = jumps.then(|| uniform(rng, -acceleration, acceleration));
        let steps = rng.u32(1..=widest);
        let to = (uniform(rng, -acceleration, acceleration), uniform(rng, -way, way));
        lead(relay, jump, to, steps);
    }
}

/// Inputs that lead from the last ones, or from a `jump` of the base acceleration to this value (m/s2), in a number of communication
/// steps to a base acceleration (m/s2) and a displacement of the fixed contact (m), at most at 0.5 m/s.
fn lead(relay: &mut Relay, jump: Option<f64>, (acceleration, displacement): (f64, f64), steps: u32) {
    let (size, _) = relay.steps;
    let mut from = relay.knots.last().copied().unwrap_or_default();
    from = after(&from, size);
    from.base_acceleration = jump.unwrap_or(from.base_acceleration);
    let duration = f64::from(steps) * size;
    let rate = (displacement - from.support_displacement) / duration;
    let first = Inputs {
        base_acceleration_rate: (acceleration - from.base_acceleration) / duration,
        support_displacement_rate: rate.clamp(-0.5, 0.5),
        ..from
    };
    let inputs = (0..steps).map(|k| after(&first, f64::from(k) * size));
    relay.knots.extend(inputs);
}

/// The relay of a number with a contact that is a spring with a damper: Linearised or Bonded, in exact steps or not.
pub fn linear(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let rng = &mut Rng::with_seed(!number);
    let scene = &mut relay.scene;
    scene.contact.overtravel = scene.contact.overtravel.abs();
    scene.effects.contact_law = [ContactLawKind::Linearised, ContactLawKind::Bonded][rng.usize(..2)];
    scene.effects.extremes = rng.bool();
    relay
}

/// The relay of a number with an axial force near the buckling load, or one that follows a large deflection.
pub fn near_buckling(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let rng = &mut Rng::with_seed(!number);
    let scene = &mut relay.scene;
    let softer = if rng.bool() {
        let rest = logarithmic(rng, 3e-3, 0.5);
        scene.effects.axial_force = AxialForceKind::Prescribed;
        scene.beam.axial_force = (1.0 - rest) * tip_stiffness(scene) * scene.beam.length * 0.822;
        rest
    } else {
        let overtravel = (scene.beam.length * logarithmic(rng, 0.03, 0.4)).min(0.01);
        scene.effects.axial_force = AxialForceKind::FromDeflection;
        overtravel / std::mem::replace(&mut scene.contact.overtravel, overtravel).abs()
    };
    scene.excitation.amplitude *= softer;
    relay.shake.0 *= softer;
    relay
}

/// The relay of a number with its spring given by some of its modes.
pub fn with_modes(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let rng = &mut Rng::with_seed(!number);
    let scene = &mut relay.scene;
    scene.effects.axial_force = AxialForceKind::None;
    let basis = Spring::new(scene).modes(rng.usize(4..=24), 0.0);
    let modes = basis.expect("a spring without axial force").modes;
    let own = rng.bool();
    let given = modes.iter().take(rng.usize(2..=modes.len())).map(|own_mode| GivenMode {
        damping: own.then(|| (0.5 * own_mode.damping / own_mode.omega_squared.sqrt()).min(1.0)),
        ..mode(own_mode.omega_squared.sqrt() / TAU, own_mode.tip, own_mode.participation)
    });
    let shape = of_modes(1.0 / tip_stiffness(scene), given);
    scene.spring = spring_file(&format!("random modes {number}"), shape);
    relay
}

/// The relay of a number with a gap that the fixed contact closes: at rest, at constant velocity, at rest.
pub fn closing(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let rng = &mut Rng::with_seed(!number);
    let scene = &mut relay.scene;
    scene.effects.contact_law = ContactLawKind::Hertz;
    let overtravel = scene.contact.overtravel.abs();
    let gap = overtravel * logarithmic(rng, 0.02, 0.5);
    scene.contact.overtravel = -gap;
    if rng.bool() {
        scene.effects.excitation = ExcitationKind::None;
    }
    relay.shake = (0.0, 1.0);
    let way = gap + overtravel * logarithmic(rng, 0.1, 1.0);
    let (size, count) = relay.steps;
    let (slowest, fastest) = (f64::from(count / 2) * size, way / 0.5);
    let parts =
        [rng.u32(..=count / 4), steps(size, logarithmic(rng, 0.02, 1.0).mul_add(slowest, fastest)).1, count / 2];
    for (steps, to) in parts.into_iter().zip([0.0, way, way]) {
        lead(&mut relay, None, (0.0, to), steps);
    }
    relay.steps.1 = parts.into_iter().sum();
    relay
}

/// The relay of a number, driven by an input alone that is sampled in steps as short as controllers have.
pub fn held(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let (rng, scene) = (&mut Rng::with_seed(!number), &mut relay.scene);
    relay.shake = (scene.excitation.amplitude, scene.excitation.frequency);
    relay.travel = (0.0, 1.0);
    relay.held = true;
    scene.effects.excitation = ExcitationKind::None;
    let step = logarithmic(rng, 2e-6, 2e-5);
    let duration = (5.0 / relay.shake.1).clamp(2e-3, 6e-3);
    relay.steps = steps(step, duration);
    relay
}

/// The relay of a number with a second contact as near as the spring moves.
pub fn changeover(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    let scene = &mut relay.scene;
    scene.effects.contact_law = ContactLawKind::Hertz;
    scene.excitation.amplitude *= 1.5;
    add_second(scene, &mut Rng::with_seed(!number));
    relay
}

/// A second contact.
fn add_second(scene: &mut Scene, rng: &mut Rng) {
    scene.effects.second_contact = true;
    scene.second.gap = scene.contact.overtravel.abs() * logarithmic(rng, 0.02, 0.5);
    scene.second.curvature_radius = logarithmic(rng, 3e-4, 3e-2);
    scene.second.damping = logarithmic(rng, 1e-7, 1e-4);
}

/// The relay of a number with friction.
pub fn friction(number: u64) -> Relay {
    let mut relay = Relay::draw(number);
    relay.scene.effects.contact_law = ContactLawKind::Hertz;
    add_friction(&mut relay.scene, &mut Rng::with_seed(!number));
    relay
}

fn add_friction(scene: &mut Scene, rng: &mut Rng) {
    parts::keep_axial_force(scene);
    scene.effects.friction = FrictionKind::Coulomb;
    scene.friction.coefficient = logarithmic(rng, 0.05, 1.0);
    scene.tip.contact_height = scene.beam.length * logarithmic(rng, 0.01, 0.2);
    if rng.u8(..3) == 0 {
        scene.friction.initial = uniform(rng, -1.0, 1.0);
    }
}

/// The relay of a number with several of these at once: inputs with knots, a rough contact, friction, a second contact, twin contacts, a
/// spring under the fixed contact, a pusher or an armature.
pub fn combined(number: u64) -> Relay {
    let rng = &mut Rng::with_seed(number.rotate_left(48));
    let rough_contact = rng.u8(..3) == 0;
    let mut relay = match rng.u8(..3) {
        _ if rough_contact => rough(3 * number),
        0 => Relay::with_segments(number),
        _ => Relay::draw(number),
    };
    let scene = &mut relay.scene;
    if !rough_contact {
        scene.effects.contact_law = ContactLawKind::Hertz;
    }
    let has = |rng: &mut Rng| rng.u8(..5) < 2;
    // Friction of one contact alone is in the model.
    if has(rng) {
        add_friction(scene, rng);
    } else {
        if has(rng) {
            add_second(scene, rng);
        }
        if has(rng) {
            parts::add_parallel(scene, rng);
        }
    }
    if has(rng) {
        parts::add_fixed_spring(scene, rng, &format!("random fixed spring {number}"));
    }
    match rng.u8(..4) {
        0 => parts::add_pusher(&mut relay, rng),
        1 => parts::add_armature(&mut relay, rng),
        _ => {}
    }
    if relay.knots.is_empty() && !relay.pushes && has(rng) {
        tie_knots(&mut relay, rng);
    }
    relay
}

/// The relay of a number with rough contacts, which are softer than spheres: alone, beside a second contact, or with
/// friction.
pub fn rough(number: u64) -> Relay {
    let mut relay = match number % 3 {
        0 => Relay::draw(number),
        1 => changeover(number),
        _ => friction(number),
    };
    let rng = &mut Rng::with_seed(number.rotate_left(32));
    let scene = &mut relay.scene;
    let tip = tip_stiffness(scene);
    let contact = &mut scene.contact;
    contact.stiffness_force = tip * contact.overtravel.abs();
    contact.stiffness = tip * logarithmic(rng, 10.0, 1e4);
    // With friction the tolerance is not promised outside this range.
    let rubs = scene.effects.friction != FrictionKind::None;
    let (least, most) = if rubs { (0.1, 0.6) } else { (0.0, 0.9) };
    let linear = rng.u8(..8) == 0 && !rubs;
    contact.stiffness_exponent = if linear { 0.0 } else { uniform(rng, least, most) };
    // The indentation at that force, beyond which the second contact lies.
    let depth = contact.stiffness_force / ((1.0 - contact.stiffness_exponent) * contact.stiffness);
    scene.second.gap += 1.5 * depth;
    scene.second.stiffness = contact.stiffness * logarithmic(rng, 0.1, 10.0);
    scene.effects.contact_law = ContactLawKind::Rough;
    scene.effects.resistance = ResistanceKind::Barber;
    relay
}
