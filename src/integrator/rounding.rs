//! Rounding of the motion of links.

use crate::integrator::constants::MOTION_ROUNDING;
use crate::link::Link;
use crate::model::Model;
use crate::state::{LinkState, State};

/// Rounding of the approach (m) of a link and of its rate (m/s).
pub(crate) fn motion_rounding(model: &Model, link: (&Link, &LinkState), state: &State) -> (f64, f64) {
    let (displacement, velocity) = magnitude(model, link, state);
    (MOTION_ROUNDING * displacement, MOTION_ROUNDING * velocity)
}

/// Magnitude of all that the approach (m) of a link and its rate (m/s) are made of. Of the modes: after an impact their velocities are
/// large and their sum at the tip is small. Of the sum itself: a contact that an input has moved a long way closes with an indentation
/// that is the small difference of that way and the gap.
pub(crate) fn magnitude(model: &Model, (link, at): (&Link, &LinkState), state: &State) -> (f64, f64) {
    let (mut displacement, mut velocity) = (at.approach.abs(), at.rate.abs());
    if let Some(port) = model.ports.get(link.port) {
        for (factor, at) in port.shape.iter().zip(&state.modes).take(port.modes.end) {
            displacement += (factor * at.q).abs();
            velocity += (factor * at.v).abs();
        }
    }
    (displacement, velocity)
}
