//! Levels of vibration that standards ask for, and what each comes to.

use std::f64::consts::TAU;

use anyhow::Result;

use super::vibration::{Outcome, Thresholds, shake};
use super::{G, yes};
use crate::content::{Curve, Style, Table};
use crate::threads;

/// A level of vibration that standards ask for.
pub struct Level {
    name: &'static str,
    /// g.
    pub acceleration: f64,
    /// Hz.
    pub frequencies: (f64, f64),
    /// Largest displacement, from end to end, m.
    double_amplitude: f64,
}

pub const LEVELS: [Level; 4] = [
    Level {
        name: "MIL-STD-202 method 204, condition A",
        acceleration: 10.0,
        frequencies: (10.0, 500.0),
        double_amplitude: 1.52e-3,
    },
    Level {
        name: "MIL-STD-202 method 204, condition B",
        acceleration: 15.0,
        frequencies: (10.0, 2000.0),
        double_amplitude: 1.52e-3,
    },
    Level {
        name: "MIL-STD-202 method 204, condition D",
        acceleration: 20.0,
        frequencies: (10.0, 2000.0),
        double_amplitude: 1.52e-3,
    },
    Level {
        name: "MIL-PRF-28776 (relays)",
        acceleration: 30.0,
        frequencies: (10.0, 3000.0),
        double_amplitude: 4.95e-3,
    },
];

impl Level {
    /// Amplitude at a frequency (Hz), m/s2.
    fn amplitude(&self, frequency: f64) -> f64 {
        (G * self.acceleration).min(0.5 * self.double_amplitude * (TAU * frequency).powi(2))
    }

    fn covers(&self, frequency: f64) -> bool {
        (self.frequencies.0..=self.frequencies.1).contains(&frequency)
    }

    pub fn curve(&self, colour: usize) -> Curve {
        let (low, high) = self.frequencies;
        let crossover = (G * self.acceleration / (0.5 * self.double_amplitude)).sqrt() / TAU;
        let x = vec![low, crossover, high];
        Curve {
            name: format!("{} g: {}", self.acceleration, self.name),
            y: x.iter().map(|frequency| self.amplitude(*frequency) / G).collect(),
            x,
            style: Style::Dashed,
            colour,
        }
    }
}

/// What a level comes to over the frequencies it covers.
pub struct Verdict {
    pub level: Level,
    /// Worst of each, and the frequency (Hz) at which it occurs.
    least_force: (f64, f64),
    pub longest: (f64, f64),
    pub opened: bool,
    pub interruptions: i32,
    /// Acceleration that interrupts, over that of the level.
    margin: (f64, f64),
}

/// Runs a level at every frequency of the map that it covers.
pub fn verdict(level: Level, points: &[Thresholds]) -> Result<Verdict> {
    let covered: Vec<&Thresholds> = points.iter().filter(|point| level.covers(point.frequency)).collect();
    let outcomes = threads::map(&covered, |point| {
        shake(point.frequency, level.amplitude(point.frequency), None)
    })?;
    let runs = || covered.iter().zip(&outcomes);
    let worst = |value: &dyn Fn(&Thresholds, &Outcome) -> f64| {
        let values = runs().map(|(point, outcome)| (value(point, outcome), point.frequency));
        values.fold(
            (f64::INFINITY, 0.0),
            |worst, value| if value.0 < worst.0 { value } else { worst },
        )
    };
    let least_force = worst(&|_, outcome| outcome.least_force);
    let longest = worst(&|_, outcome| -outcome.longest);
    let margin = worst(&|point, _| point.interrupts / level.amplitude(point.frequency));
    Ok(Verdict {
        least_force,
        longest: (-longest.0, longest.1),
        opened: outcomes.iter().any(|outcome| outcome.opened),
        interruptions: outcomes.iter().map(|outcome| outcome.interruptions).max().unwrap_or(0),
        margin,
        level,
    })
}

pub fn table(verdicts: &[Verdict]) -> Table {
    let rows = verdicts.iter().map(|verdict| {
        let level = &verdict.level;
        vec![
            format!("{} g", level.acceleration),
            level.name.to_owned(),
            format!("{:.0} to {:.0} Hz", level.frequencies.0, level.frequencies.1),
            yes(verdict.opened),
            yes(verdict.interruptions > 0),
            microseconds(verdict.longest),
            format!(
                "{:.1} % at {:.0} Hz",
                100.0 * verdict.least_force.0,
                verdict.least_force.1
            ),
            format!("{:.2} at {:.0} Hz", verdict.margin.0, verdict.margin.1),
        ]
    });
    Table {
        caption: "Vibration. Each level was run at every frequency of the figure that it covers. Margin: the acceleration that \
                  interrupts for 10 µs, over that of the level; below 1 the test fails."
            .to_owned(),
        columns: [
            "level",
            "asked by",
            "range",
            "opens at all",
            "opens for 10 µs",
            "longest interruption",
            "least force, of the preload",
            "lowest margin",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
    }
}

fn microseconds((longest, frequency): (f64, f64)) -> String {
    if longest > 0.0 {
        format!("{:.1} µs at {frequency:.0} Hz", 1e6 * longest)
    } else {
        "none".to_owned()
    }
}
