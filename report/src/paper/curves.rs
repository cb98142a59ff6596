//! Axes and curves shared by the figures.

use super::runs::Periodic;
use crate::content::{Axis, Curve, Style};

pub const FREQUENCY: Axis = Axis::linear("frequency", "Hz");
pub const FORCE_AMPLITUDE: Axis = Axis::linear("amplitude of the contact force", "cN");

/// The force amplitude over the frequency.
pub fn amplitudes(name: &str, runs: &[Periodic], style: Style, colour: usize) -> Curve {
    let points = runs.iter().map(|run| (run.frequency, run.amplitude()));
    Curve::new(name, points, style, colour)
}

/// Published points, if there are any.
pub fn published(name: &str, points: impl IntoIterator<Item = (f64, f64)>, colour: usize) -> Option<Curve> {
    let curve = Curve::new(&format!("published, {name}"), points, Style::Markers, colour);
    (!curve.x.is_empty()).then_some(curve)
}
