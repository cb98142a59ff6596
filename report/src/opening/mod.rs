//! Does the contact open? The verdict of the standards on the specimen.
//!
//! [`vibration`]: a sine, and the accelerations from which on it opens;   [`levels`]: those that standards ask for;
//! [`shock`]: a half sine.

mod levels;
mod shock;
mod vibration;

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use rayon::prelude::*;
use relay_contact::reference::{Model, opening_threshold};

use self::levels::{LEVELS, Verdict, least, table, verdict};
use self::shock::shock;
use self::vibration::{COLUMNS, DWELL, G, RAMP, RESOLUTION, Thresholds, thresholds};
use crate::content::{Arguments, Axis, Block, Curve, Figure, Section, Style, Table};
use crate::paper;

/// Range of the map, Hz.
const RANGE: (f64, f64) = (10.0, 3000.0);

/// Shocks of MIL-STD-202 method 213: condition, g, s.
const SHOCKS: [(&str, f64, f64); 3] = [("A", 50.0, 11e-3), ("B", 75.0, 6e-3), ("C", 100.0, 6e-3)];

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let points = map(if arguments.quick { 12 } else { 80 })?;
    let verdicts = LEVELS
        .into_iter()
        .map(|level| verdict(level, &points))
        .collect::<Result<Vec<_>>>()?;
    let parts = paper::uncertainties()?;
    let uncertainty = parts[0].hypot(parts[1]);
    let asked = verdicts.last().context("no levels")?;
    let lead = answer(&verdicts, asked, uncertainty);
    let blocks = vec![
        Block::Text(format!("{lead} {}", weakest(&points, parts)?)),
        Block::Figure(figure(&points)),
        Block::Table(table(&verdicts, uncertainty)),
        Block::Table(shocks(arguments.quick)?),
        Block::Text(method(points.len())),
    ];
    Ok(vec![Section {
        id: "opening",
        title: "Does the contact open?",
        lead,
        blocks,
    }])
}

/// Frequencies closer than this part of them are one.
const SAME: f64 = 1e-6;

/// Thresholds at `count` frequencies at equal ratios and at the ends of the levels, and more of them where they are lowest.
fn map(count: u32) -> Result<Vec<Thresholds>> {
    let between = |(low, high): (f64, f64), count: u32| {
        (0..count).map(move |k| low * (high / low).powf(f64::from(k) / f64::from(count - 1)))
    };
    let ends = LEVELS
        .iter()
        .flat_map(|level| [level.frequencies.0, level.frequencies.1]);
    let mut coarse: Vec<f64> = between(RANGE, count).chain(ends).collect();
    coarse.sort_by(f64::total_cmp);
    coarse.dedup_by(|a, b| (*a / *b - 1.0).abs() < SAME);
    let mut points = all_thresholds(&coarse)?;
    let lowest = points.iter().enumerate().min_by(|a, b| a.1.opens.total_cmp(&b.1.opens));
    let lowest = lowest.map_or(0, |(index, _)| index);
    let around = points.get(lowest.saturating_sub(1)..(lowest + 2).min(points.len()));
    if let Some([first, .., last]) = around {
        let fine = between((first.frequency, last.frequency), 11).skip(1).take(9);
        let known = |frequency: f64| {
            points
                .iter()
                .any(|point| (point.frequency / frequency - 1.0).abs() < SAME)
        };
        let new: Vec<f64> = fine.filter(|frequency| !known(*frequency)).collect();
        points.extend(all_thresholds(&new)?);
        points.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    }
    Ok(points)
}

fn all_thresholds(frequencies: &[f64]) -> Result<Vec<Thresholds>> {
    frequencies.par_iter().map(|frequency| thresholds(*frequency)).collect()
}

fn answer(verdicts: &[Verdict], asked: &Verdict, uncertainty: f64) -> String {
    let acceleration = asked.level.acceleration;
    let (margin, frequency) = asked.margin;
    let opens = format!(
        "in steady vibration it opens for 10 µs from {:.1} g on, at {frequency:.0} Hz, ± {:.1} % by the published numbers, the form of the model not counted",
        margin * acceleration,
        100.0 * uncertainty,
    );
    let answer = match asked.word(uncertainty) {
        "passed" => format!("The contact passes {acceleration} g"),
        "failed" => format!("The contact fails at {acceleration} g"),
        _ => format!("Whether the contact passes {acceleration} g is undecided"),
    };
    let passed = verdicts.iter().filter(|verdict| verdict.word(uncertainty) == "passed");
    let passed: Vec<_> = passed
        .map(|verdict| format!("{} g", verdict.level.acceleration))
        .collect();
    let passed = if passed.is_empty() {
        "none of the levels".to_owned()
    } else {
        passed.join(", ")
    };
    format!("**{answer}: {opens}.** It passes {passed}.")
}

/// Where it opens first, and the parts of the uncertainty.
fn weakest(points: &[Thresholds], parts: [f64; 2]) -> Result<String> {
    let (opens, frequency) = least(points.iter().map(|point| (point.opens, point.frequency)));
    let [maximum, preload] = parts.map(|part| format!("{:.2} %", 100.0 * part));
    let elastic = Model::new(&crate::scene::read("paper-elastic")?.scene, 0.0)?;
    let linear =
        |model: &dyn Fn(&Thresholds) -> f64| least(points.iter().map(|point| (model(point), point.frequency))).0;
    let part = linear(&|point| opening_threshold(&elastic, TAU * point.frequency)) / linear(&|point| point.linear);
    Ok(format!(
        "The specimen opens most easily near its first resonance: the contact force first reaches zero at {:.1} g ({opens:.0} m/s²) and \
         {frequency:.0} Hz. This acceleration is as uncertain as the preload over the maximum of the force amplitude: the published \
         maximum differs from that of this model by {maximum}, and half a unit in the last digit of the published preload is {preload}. \
         Neither scatter between contacts nor the form of the model is included: fitted as if the publication showed the elastic force \
         (`scenes/paper-elastic.toml`), the contact opens at {:.2} times this acceleration by linear theory.",
        opens / G,
        part,
    ))
}

fn figure(points: &[Thresholds]) -> Figure {
    let curve = |name: &str, value: fn(&Thresholds) -> f64, style| {
        let points = points.iter().map(|point| (point.frequency, value(point) / G));
        Curve::new(name, points, style, 0)
    };
    let mut curves = vec![
        curve(
            "opens for 10 µs, steady vibration",
            |point| point.interrupts,
            Style::Line,
        ),
        curve("the same after a sudden start", |point| point.sudden, Style::Dashed),
    ];
    curves.extend(
        LEVELS
            .iter()
            .zip(1..)
            .map(|(level, colour)| level.curve(points, colour)),
    );
    let furthest = |other: fn(&Thresholds) -> f64| {
        let parts = points.iter().map(|point| (other(point) / point.interrupts - 1.0).abs());
        100.0 * parts.fold(0.0, f64::max)
    };
    let at_2000 = |threshold: fn(&Thresholds) -> f64| {
        let point = points.iter().find(|point| point.frequency == 2000.0);
        point.map_or_else(String::new, |point| format!("{:.1}", threshold(point) / G))
    };
    Figure {
        id: "opening-map",
        title: "Base acceleration that opens the contact".to_owned(),
        x: Axis::logarithmic("frequency", "Hz"),
        y: Axis::logarithmic("amplitude of the base acceleration", "g"),
        curves,
        caption: format!(
            "The specimen passes a test level where the level's line lies below the first curve. Below its crossover frequency a level is \
             limited by displacement: the acceleration then goes with the square of the frequency. The acceleration at which the force \
             first reaches zero differs from the first curve by {:.1} % at most, that of linear theory by {:.1} %. A vibration that \
             starts at once with its whole amplitude opens the contact earlier above the resonance, by its transient: at 2000 Hz from \
             {} g on instead of {} g. 1 g = {G} m/s².",
            furthest(|point| point.opens),
            furthest(|point| point.linear),
            at_2000(|point| point.sudden),
            at_2000(|point| point.interrupts),
        ),
    }
}

fn shocks(quick: bool) -> Result<Table> {
    let conditions = SHOCKS.iter().take(if quick { 1 } else { SHOCKS.len() });
    let directions = [("presses the contact", 1.0), ("pulls it open", -1.0)];
    let runs: Vec<_> = conditions
        .flat_map(|condition| directions.map(|direction| (condition, direction)))
        .collect();
    let row = |((name, acceleration, duration), (direction, sign)): &(&(&str, f64, f64), (&str, f64))| {
        let head = [
            format!("method 213, condition {name}"),
            format!("{acceleration} g, {:.0} ms", 1e3 * duration),
            (*direction).to_owned(),
        ];
        let outcome = shock(sign * G * acceleration, *duration)?;
        Ok(head.into_iter().chain(outcome.cells()).collect())
    };
    let columns: Vec<&str> = ["test", "shock", "direction"].into_iter().chain(COLUMNS).collect();
    Ok(Table::new(
        "Half-sine shock of MIL-STD-202, in both directions along the motion of the contact.",
        &columns,
        runs.par_iter().map(row).collect::<Result<_>>()?,
    ))
}

fn method(frequencies: usize) -> String {
    let ((ramp, periods), (duration, _)) = (RAMP, DWELL);
    format!(
        "How it was found: at {frequencies} frequencies the nonlinear specimen is shaken with a sine whose amplitude grows from zero over \
         {:.0} ms or {periods:.0} periods, whichever is longer, and then stays for {:.0} ms or {periods:.0} periods. It *opens at all* where \
         the contact force reaches zero at any instant, and is *interrupted* where the resistance stays above 60 Ω for 10 µs. Each threshold \
         is the smallest such acceleration, found by bisection to {} %.\n\n\
         MIL-PRF-28776F asks for the sine of the table (4.8.10.1); closed contacts may then open for at most 10 µs and open contacts close \
         for at most 1 µs (4.8.9). Its monitor stands for a threshold of 600 Ω (see `chatter.resistanceThreshold`); between 60 and 600 Ω the \
         contact force falls by less than a thousandth of the preload, which no threshold above shows. Not run here: its random vibration \
         (4.8.10.2: MIL-STD-202 method 214, condition G, shaped spectrum of 0.4 g²/Hz, 23.91 g rms).\n\n\
         The result holds for the equivalent beam with its identified damping, vibrated along the motion of the contact, after the contact \
         has come to rest: bounce after switching and resonances of the relay's case are not included.",
        1e3 * ramp,
        1e3 * duration,
        100.0 * RESOLUTION,
    )
}
