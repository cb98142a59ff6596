//! Springs of files: by their parts, and random ones of segments, tapered, stepped, with masses, beyond their contact, on
//! clamps from rigid to nearly hinged.

use std::f64::consts::TAU;
use std::sync::Arc;

use fastrand::Rng;
use relay_contact::reference::{Mode, Model, Spring};
use relay_contact::scene::Scene;
use relay_contact::scene::spring::{GivenMode, Modes, PointMass, Segment, Segments, Shape, SpringFile};

use crate::relays::{Relay, logarithmic, uniform};
use crate::scenes::tip_stiffness;

/// What a scene has of a spring file of this name and shape.
#[allow(clippy::unnecessary_wraps)] // as a field of the scene has it
pub fn spring_file(name: &str, shape: Shape) -> Option<Arc<SpringFile>> {
    let name = name.to_owned();
    Some(Arc::new(SpringFile { name, shape }))
}

/// A spring of these segments.
pub fn of_segments(segments: impl IntoIterator<Item = Segment>) -> Shape {
    Shape::Segments(Segments { segments: segments.into_iter().collect(), ..Segments::default() })
}

/// A spring of these modes, which has this compliance, m/N.
pub fn of_modes(compliance: f64, modes: impl IntoIterator<Item = GivenMode>) -> Shape {
    Shape::Modes(Modes { compliance, parallel_compliance: None, modes: modes.into_iter().collect() })
}

/// A segment of this length, with width and thickness at its start and end (m), of the scene's material.
pub fn segment(length: f64, width: [f64; 2], thickness: [f64; 2]) -> Segment {
    Segment { length, width, thickness, youngs_modulus: None, density: None }
}

/// A uniform spring of this width and thickness over those of the scene's own.
pub fn uniform_spring(scene: &Scene, width: f64, thickness: f64) -> Option<Arc<SpringFile>> {
    let beam = &scene.beam;
    let whole = segment(beam.length, [width * beam.width; 2], [thickness * beam.thickness; 2]);
    spring_file("uniform.toml", of_segments([whole]))
}

/// The scene's own spring, forked at a share of its length.
pub fn forked(scene: &Scene, share: f64) -> Option<Arc<SpringFile>> {
    let beam = &scene.beam;
    let segments = Segments {
        segments: vec![segment(beam.length, [beam.width; 2], [beam.thickness; 2])],
        fork_position: Some(share * beam.length),
        ..Segments::default()
    };
    spring_file("forked.toml", Shape::Segments(segments))
}

/// The springs of a model by their modes, with the compliance of these.
pub fn modes_of(model: &Model) -> Modes {
    let modes = model.modes.iter().map(|own| GivenMode {
        rotation: Some(own.rotation),
        pusher: Some(own.pusher),
        parallel: Some(own.parallel),
        ..mode(own.omega_squared.sqrt() / TAU, own.tip, own.participation)
    });
    let compliance = model.modes.iter().map(Mode::compliance).sum();
    Modes { compliance, parallel_compliance: None, modes: modes.collect() }
}

/// A mode of this frequency (Hz) with what every mode has: displacement of the contact (1/sqrt(kg)), load per base acceleration
/// (sqrt(kg)).
pub fn mode(frequency: f64, contact: f64, participation: f64) -> GivenMode {
    GivenMode { frequency, contact, participation, damping: None, rotation: None, pusher: None, parallel: None }
}

impl Relay {
    /// The relay of a number, its spring made of segments that are about as stiff and heavy as its own spring. The contact is
    /// pressed with the same force.
    pub fn with_segments(number: u64) -> Self {
        let mut relay = Self::draw(number);
        let scene = &mut relay.scene;
        let stiffness = tip_stiffness(scene);
        let shape = Shape::Segments(segments(&mut Rng::with_seed(number), scene));
        scene.spring = spring_file(&format!("random spring {number}"), shape);
        let spring = Spring::new(scene);
        let softer = stiffness / spring.statics.section.tip_stiffness();
        scene.contact.overtravel = (scene.contact.overtravel * softer).clamp(-0.01, 0.01);
        scene.beam.axial_force *= 0.5 * spring.statics.buckling_load() / (stiffness * scene.beam.length * 0.822);
        relay
    }
}

pub(crate) fn segments(rng: &mut Rng, scene: &Scene) -> Segments {
    let beam = &scene.beam;
    let shares: Vec<f64> = (0..=rng.usize(..4)).map(|_| uniform(rng, 0.2, 1.0)).collect();
    let whole: f64 = shares.iter().sum();
    let segments = shares.iter().map(|share| {
        let mut ends = |value: f64, least: f64| {
            let start = value * logarithmic(rng, least, 1.0 / least);
            [start, if rng.bool() { start } else { start * logarithmic(rng, 0.3, 1.0) }]
        };
        let (width, thickness) = (ends(beam.width, 0.4), ends(beam.thickness, 0.7));
        segment(beam.length * share / whole, width, thickness)
    });
    let segments = segments.collect();
    let mass = beam.density * beam.width * beam.thickness * beam.length;
    let masses = (0..rng.usize(..3)).map(|_| PointMass {
        position: beam.length * uniform(rng, 0.1, 1.0),
        mass: mass * logarithmic(rng, 0.01, 1.0),
        rotary_inertia: if rng.bool() { 0.0 } else { mass * beam.length.powi(2) * logarithmic(rng, 1e-5, 1e-2) },
    });
    let masses = masses.collect();
    // E I / L, from nearly rigid to nearly hinged.
    let bending = tip_stiffness(scene) * beam.length.powi(2) / 3.0;
    Segments {
        segments,
        masses,
        fork_position: None,
        contact_position: rng.bool().then(|| beam.length * uniform(rng, 0.7, 1.0)),
        clamp_stiffness: rng.bool().then(|| bending * logarithmic(rng, 0.02, 100.0)),
    }
}
