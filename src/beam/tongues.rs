//! A spring that forks into two equal tongues, each with a contact (`fork_position` of a spring file).
//!
//! Each tongue has half the width of the segments beyond the fork and half of each mass there. Forces on both tongues together
//! bend the spring as if it did not fork. Opposite ones bend each tongue as a cantilever from the fork on, where they leave no
//! moment and no force: so the modes are those of the spring as a whole, in which both contacts move together, and those of the
//! tongues, in which they move against each other. Torsion of the spring before the fork is left out.

use std::sync::Arc;

use crate::scene::Scene;
use crate::scene::spring::{PointMass, Segment, Segments, Shape, SpringFile};
use crate::variables::PusherKind;

/// The scene with both tongues, side by side from the fork on, in the place of the spring, if it forks and both contacts are used. The
/// static compliance is then the deflection of a contact per force on it less the same force on the other.
pub fn scene(scene: &Scene) -> Option<Scene> {
    let file = scene.spring.as_ref().filter(|_| scene.effects.parallel_contact)?;
    let Shape::Segments(segments) = &file.shape else { return None };
    let mut own = scene.clone();
    own.spring = Some(Arc::new(SpringFile {
        name: file.name.clone(),
        shape: Shape::Segments(beyond(segments, segments.fork_position?)),
    }));
    own.fixed_spring = None;
    own.effects.pusher = PusherKind::None;
    Some(own)
}

/// What lies beyond a fork, as a spring of its own.
fn beyond(spring: &Segments, fork: f64) -> Segments {
    let mut end = 0.0;
    let segments = spring.segments.iter().filter_map(|segment| {
        let cut = (fork - end).max(0.0);
        end += segment.length;
        (end > fork).then(|| from(segment, cut))
    });
    let masses = spring.masses.iter().filter(|mass| mass.position > fork);
    let moved = |mass: &PointMass| PointMass { position: mass.position - fork, ..*mass };
    Segments {
        segments: segments.collect(),
        masses: masses.map(moved).collect(),
        contact_position: spring.contact_position.map(|position| position - fork),
        ..Segments::default()
    }
}

/// A segment from a distance from its start on, m.
fn from(segment: &Segment, cut: f64) -> Segment {
    let share = cut / segment.length;
    let at_cut = |[start, end]: [f64; 2]| [start + share * (end - start), end];
    Segment {
        length: segment.length - cut,
        width: at_cut(segment.width),
        thickness: at_cut(segment.thickness),
        ..*segment
    }
}
