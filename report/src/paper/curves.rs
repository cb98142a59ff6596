//! Axes and curves that the figures share.

use super::runs::Periodic;
use crate::content::{Axis, Curve, Style};

pub const FREQUENCY: Axis = axis("frequency", "Hz");
pub const FORCE_AMPLITUDE: Axis = axis("force amplitude", "cN");

/// A linear axis.
pub const fn axis(label: &'static str, unit: &'static str) -> Axis {
    Axis {
        label,
        unit,
        logarithmic: false,
    }
}

/// A curve through points.
pub fn curve(name: &str, points: impl IntoIterator<Item = (f64, f64)>, style: Style, colour: usize) -> Curve {
    let (x, y) = points.into_iter().unzip();
    Curve {
        name: name.to_owned(),
        x,
        y,
        style,
        colour,
    }
}

/// The force amplitude over the frequency.
pub fn amplitudes(name: &str, runs: &[Periodic], style: Style, colour: usize) -> Curve {
    curve(
        name,
        runs.iter().map(|run| (run.frequency, run.amplitude())),
        style,
        colour,
    )
}

/// Published points.
pub fn published(name: &str, points: impl IntoIterator<Item = (f64, f64)>, colour: usize) -> Curve {
    curve(&format!("published, {name}"), points, Style::Markers, colour)
}
