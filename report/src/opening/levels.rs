//! Levels of vibration required by standards, and the verdict on each.

use std::f64::consts::TAU;

use anyhow::Result;
use rayon::prelude::*;

use super::vibration::{COLUMNS, G, Outcome, Start, Thresholds, shake};
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
    sine("MIL-STD-202 method 204, condition A", 10.0, 500.0, 1.52e-3),
    sine("MIL-STD-202 method 204, condition B", 15.0, 2000.0, 1.52e-3),
    sine("MIL-STD-202 method 204, condition D", 20.0, 2000.0, 1.52e-3),
    sine("MIL-PRF-28776F, 4.8.10.1", 30.0, 3000.0, 4.95e-3),
];

/// A level from 10 Hz on.
const fn sine(name: &'static str, acceleration: f64, highest: f64, double_amplitude: f64) -> Level {
    Level {
        name,
        acceleration,
        frequencies: (10.0, highest),
        double_amplitude,
    }
}

impl Level {
    /// Amplitude at a frequency (Hz), m/s2: limited by the displacement below the crossover.
    fn amplitude(&self, frequency: f64) -> f64 {
        (G * self.acceleration).min(0.5 * self.double_amplitude * (TAU * frequency).powi(2))
    }

    fn covers(&self, frequency: f64) -> bool {
        (self.frequencies.0..=self.frequencies.1).contains(&frequency)
    }

    /// Over the frequencies of the map, and at the crossover.
    pub fn curve(&self, points: &[Thresholds], colour: usize) -> Curve {
        let crossover = (G * self.acceleration / (0.5 * self.double_amplitude)).sqrt() / TAU;
        let mut frequencies: Vec<f64> = points.iter().map(|point| point.frequency).chain([crossover]).collect();
        frequencies.retain(|frequency| self.covers(*frequency));
        frequencies.sort_by(f64::total_cmp);
        let name = format!("{}: {} g", self.name, self.acceleration);
        let points = frequencies
            .into_iter()
            .map(|frequency| (frequency, self.amplitude(frequency) / G));
        Curve::new(&name, points, Style::Dashed, colour)
    }
}

/// The result of a level over the frequencies that it covers.
pub struct Verdict {
    pub level: Level,
    /// The worst values at any frequency.
    worst: Outcome,
    /// Frequencies of the least force and of the longest interruption, Hz.
    least_force_at: f64,
    longest_at: f64,
    /// Smallest acceleration that interrupts over that of the level, and its frequency, Hz.
    pub margin: (f64, f64),
}

impl Verdict {
    /// Of a margin that is known to a part of it.
    pub fn word(&self, uncertainty: f64) -> &'static str {
        match self.margin.0 {
            margin if margin > 1.0 + uncertainty => "passed",
            margin if margin < 1.0 - uncertainty => "failed",
            _ => "undecided",
        }
    }
}

/// Runs a level at every frequency of the map that it covers.
pub fn verdict(level: Level, points: &[Thresholds]) -> Result<Verdict> {
    let covered: Vec<&Thresholds> = points.iter().filter(|point| level.covers(point.frequency)).collect();
    let shake = |point: &&Thresholds| shake(point.frequency, level.amplitude(point.frequency), Start::Ramped, None);
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

pub fn table(verdicts: &[Verdict], uncertainty: f64) -> Table {
    let rows = verdicts.iter().map(|verdict| {
        let level = &verdict.level;
        let [_, _, longest, force] = verdict.worst.cells();
        let at = |text: String, frequency: f64| format!("{text} at {frequency:.0} Hz");
        let longest = match verdict.worst.longest {
            0.0 => longest,
            _ => at(longest, verdict.longest_at),
        };
        vec![
            format!("{}: {} g", level.name, level.acceleration),
            format!("{:.0} to {:.0} Hz", level.frequencies.0, level.frequencies.1),
            verdict.word(uncertainty).to_owned(),
            at(format!("{:.2}", verdict.margin.0), verdict.margin.1),
            longest,
            at(force, verdict.least_force_at),
        ]
    });
    let [_, _, longest, force] = COLUMNS;
    let columns = ["level", "frequencies", "verdict", "smallest margin", longest, force];
    let caption = format!(
        "Vibration. Each level was run, in steady vibration, at every frequency of the figure that it covers. Margin: the \
         acceleration at which the contact opens for 10 µs, divided by that of the level; within 1 ± {uncertainty:.3} the verdict \
         is undecided."
    );
    Table::new(&caption, &columns, rows.collect())
}
