//! Axes that the figures share.

use crate::content::Axis;

pub const TIME: Axis = Axis::logarithmic("computing time per simulated second", "s");
pub const ERROR: Axis = Axis::logarithmic("error of the contact force, relative to the preload", "");
