//! The parameters and effects, grouped by what they describe, generated from `modelDescription.xml` by `build.rs`. Their start
//! values are the specimen.

#![expect(clippy::struct_excessive_bools, reason = "each is a parameter of its own")]
#![allow(clippy::unreadable_literal, clippy::too_many_lines)]

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::scene::spring::SpringFile;
use crate::variables::{
    AxialForceKind, BooleanParameter, ContactLawKind, EnumerationParameter, ExcitationKind, FrictionKind,
    IntegerParameter, PusherKind, RealParameter, ResistanceKind,
};

include!(concat!(env!("OUT_DIR"), "/scene.rs"));

impl Scene {
    pub(crate) fn rubs(&self) -> bool {
        self.effects.friction != FrictionKind::None
    }

    /// Distance from the clamp at which a pusher presses the spring, m, where there is one.
    pub(crate) fn pushed_at(&self) -> Option<f64> {
        (self.effects.pusher != PusherKind::None).then_some(self.pusher.position)
    }
}

impl Solver {
    /// Tolerance if neither the scene nor the experiment sets one.
    pub const DEFAULT_TOLERANCE: f64 = 1e-6;
    /// Smaller tolerances are raised to this one.
    pub const TOLERANCE_FLOOR: f64 = 1e-11;

    /// The effective tolerance.
    pub fn effective_tolerance(&self) -> f64 {
        if self.tolerance > 0.0 { self.tolerance.max(Self::TOLERANCE_FLOOR) } else { Self::DEFAULT_TOLERANCE }
    }
}
