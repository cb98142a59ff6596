//! Levels of vibration required by standards, and what each comes to.

use std::f64::consts::TAU;

use anyhow::Result;
use rayon::prelude::*;

use super::vibration::{COLUMNS, G, Outcome, Thresholds, shake};
use crate::content::{Curve, Style, Table};

/// A level of vibration required by a standard.
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
        let points = [low, crossover, high].map(|frequency| (frequency, self.amplitude(frequency) / G));
        let name = format!("{} g: {}", self.acceleration, self.name);
        Curve::new(&name, points, Style::Dashed, colour)
    }
}

/// What a level comes to over the frequencies it covers.
pub struct Verdict {
    pub level: Level,
    /// The worst of each at any frequency.
    pub worst: Outcome,
    /// Frequencies of the least force and of the longest interruption, Hz.
    least_force_at: f64,
    pub longest_at: f64,
    /// Smallest acceleration that interrupts over that of the level, and its frequency, Hz.
    margin: (f64, f64),
}

/// Runs a level at every frequency of the map that it covers.
pub fn verdict(level: Level, points: &[Thresholds]) -> Result<Verdict> {
    let covered: Vec<&Thresholds> = points.iter().filter(|point| level.covers(point.frequency)).collect();
    let shake = |point: &&Thresholds| shake(point.frequency, level.amplitude(point.frequency), None);
    let outcomes: Vec<Outcome> = covered.par_iter().map(shake).collect::<Result<_>>()?;
    let least = |value: &dyn Fn(&Thresholds, &Outcome) -> f64| {
        let runs = covered.iter().zip(&outcomes);
        least(runs.map(|(point, outcome)| (value(point, outcome), point.frequency)))
    };
    let (least_force, least_force_at) = least(&|_, outcome| outcome.least_force);
    let (longest, longest_at) = least(&|_, outcome| -outcome.longest);
    let margin = least(&|point, _| point.interrupts / level.amplitude(point.frequency));
    Ok(Verdict {
        worst: Outcome {
            opened: outcomes.iter().any(|outcome| outcome.opened),
            least_force,
            interruptions: outcomes.iter().map(|outcome| outcome.interruptions).max().unwrap_or(0),
            longest: -longest,
        },
        least_force_at,
        longest_at,
        margin,
        level,
    })
}

/// The point of the least value.
pub fn least(points: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    points.fold(
        (f64::INFINITY, 0.0),
        |least, point| if point.0 < least.0 { point } else { least },
    )
}

pub fn table(verdicts: &[Verdict]) -> Table {
    let rows = verdicts.iter().map(|verdict| {
        let level = &verdict.level;
        let [opens, counts, longest, force] = verdict.worst.cells();
        let at = |text: String, frequency: f64| format!("{text} at {frequency:.0} Hz");
        vec![
            format!("{} g", level.acceleration),
            level.name.to_owned(),
            format!("{:.0} to {:.0} Hz", level.frequencies.0, level.frequencies.1),
            opens,
            counts,
            if verdict.worst.longest > 0.0 {
                at(longest, verdict.longest_at)
            } else {
                longest
            },
            at(force, verdict.least_force_at),
            at(format!("{:.2}", verdict.margin.0), verdict.margin.1),
        ]
    });
    let columns: Vec<&str> = ["level", "standard", "frequencies"]
        .into_iter()
        .chain(COLUMNS)
        .chain(["smallest margin"])
        .collect();
    let caption = "Vibration. Each level was run at every frequency of the figure that it covers. Margin: the acceleration at which \
                   the contact opens for 10 µs, divided by that of the level; below 1 the test fails.";
    Table::new(caption, &columns, rows.collect())
}
