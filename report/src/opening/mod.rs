//! Does the contact open? The verdict of the standards on the specimen.
//!
//! [`vibration`]: a sine, and the accelerations from which on it opens;   [`levels`]: those that standards ask for;
//! [`shock`]: a half sine.

mod levels;
mod shock;
mod vibration;

use anyhow::{Context, Result};
use rayon::prelude::*;

use self::levels::{LEVELS, Verdict, least, table, verdict};
use self::shock::shock;
use self::vibration::{COLUMNS, DWELL, G, Outcome, RESOLUTION, Thresholds, thresholds};
use crate::content::{Arguments, Axis, Block, Curve, Figure, Section, Style, Table};

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
    let least =
        |threshold: fn(&Thresholds) -> f64| least(points.iter().map(|point| (threshold(point), point.frequency)));
    let (opens, interrupts) = (least(|point| point.opens), least(|point| point.interrupts));
    let asked = verdicts.last().context("no levels")?;
    let lead = answer(&verdicts, asked);
    let mut blocks = vec![
        Block::Text(format!("{lead} {}", weakest(opens, interrupts))),
        Block::Figure(figure(&points)),
        Block::Table(table(&verdicts)),
        Block::Table(shocks(arguments.quick)?),
    ];
    blocks.push(Block::Text(method(points.len())));
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
        let fine: Vec<f64> = between((first.frequency, last.frequency), 11).skip(1).take(9).collect();
        let new: Vec<f64> = fine
            .into_iter()
            .filter(|frequency| {
                points
                    .iter()
                    .all(|point| (point.frequency / frequency - 1.0).abs() > SAME)
            })
            .collect();
        points.extend(all_thresholds(&new)?);
        points.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    }
    Ok(points)
}

fn all_thresholds(frequencies: &[f64]) -> Result<Vec<Thresholds>> {
    frequencies.par_iter().map(|frequency| thresholds(*frequency)).collect()
}

fn answer(verdicts: &[Verdict], asked: &Verdict) -> String {
    let acceleration = asked.level.acceleration;
    let verdict = if asked.worst.interruptions == 0 {
        format!("**At {acceleration} g no contact opens for 10 µs or more at any frequency from 10 to 3000 Hz")
    } else {
        format!(
            "**At {acceleration} g the contact does open for 10 µs or more, for up to {:.0} µs at {:.0} Hz",
            1e6 * asked.worst.longest,
            asked.longest_at
        )
    };
    let shorter = if asked.worst.interruptions == 0 && asked.worst.opened {
        ", though it opens for a shorter time"
    } else {
        ""
    };
    format!("{verdict}{shorter}.** {}", passed(verdicts))
}

fn weakest(opens: (f64, f64), interrupts: (f64, f64)) -> String {
    format!(
        "The specimen opens most easily near its first resonance: from {} on at {:.0} Hz the contact force reaches zero, from {} on \
         at {:.0} Hz the contact opens for 10 µs. The identified damping, rivet mass and preload are known to some \
         per cent, and so is this acceleration.",
        acceleration_text(opens.0),
        opens.1,
        acceleration_text(interrupts.0),
        interrupts.1,
    )
}

/// The levels at which nothing is interrupted, as a sentence.
fn passed(verdicts: &[Verdict]) -> String {
    let passed = verdicts.iter().filter(|verdict| verdict.worst.interruptions == 0);
    let levels: Vec<String> = passed
        .map(|verdict| format!("{} g", verdict.level.acceleration))
        .collect();
    if levels.is_empty() {
        "It passes none of the levels below.".to_owned()
    } else {
        format!("It passes {}.", levels.join(", "))
    }
}

fn acceleration_text(acceleration: f64) -> String {
    format!("{:.1} g ({acceleration:.0} m/s²)", acceleration / G)
}

fn figure(points: &[Thresholds]) -> Figure {
    let curve = |name: &str, value: fn(&Thresholds) -> f64, style, colour| {
        let points = points.iter().map(|point| (point.frequency, value(point) / G));
        Curve::new(name, points, style, colour)
    };
    let mut curves = vec![
        curve("opens for 10 µs or more", |point| point.interrupts, Style::Line, 0),
        curve("opens at all", |point| point.opens, Style::Dashed, 1),
        curve(
            "linear theory: force reaches zero",
            |point| point.linear,
            Style::Line,
            2,
        ),
    ];
    curves.extend(LEVELS.iter().zip(3..).map(|(level, colour)| level.curve(colour)));
    Figure {
        id: "opening-map",
        title: "Base acceleration that opens the contact".to_owned(),
        x: Axis::logarithmic("frequency", "Hz"),
        y: Axis::linear("amplitude of the base acceleration", "g"),
        curves,
        caption: format!(
            "The first two curves differ by {:.1} % at most: once the force reaches zero, the resistance soon stays above 60 Ω for \
             10 µs. Above the resonance they lie below linear theory because the transient of the sudden start opens the \
             contact. The specimen passes a test level where the level's dashed line lies below the first curve. At low \
             frequencies a level is limited by displacement, not by acceleration. 1 g = {G} m/s².",
            100.0
                * points
                    .iter()
                    .map(|point| (point.interrupts / point.opens - 1.0).abs())
                    .fold(0.0, f64::max),
        ),
    }
}

fn shocks(quick: bool) -> Result<Table> {
    let conditions = SHOCKS.get(..if quick { 1 } else { SHOCKS.len() }).unwrap_or_default();
    let directions = [("presses the contact", 1.0), ("pulls it open", -1.0)];
    let runs: Vec<_> = conditions
        .iter()
        .flat_map(|condition| directions.map(|direction| (condition, direction)))
        .collect();
    let shock = |((_, acceleration, duration), (_, sign)): &(&(_, f64, f64), (_, f64))| {
        shock(sign * G * acceleration, *duration)
    };
    let outcomes = runs.par_iter().map(shock).collect::<Result<Vec<_>>>()?;
    let row =
        |(((name, acceleration, duration), (direction, _)), outcome): (&(&(_, f64, f64), (&str, _)), &Outcome)| {
            let head = [
                format!("method 213, condition {name}"),
                format!("{acceleration} g, {:.0} ms", 1e3 * duration),
                (*direction).to_owned(),
            ];
            head.into_iter().chain(outcome.cells()).collect()
        };
    let columns: Vec<&str> = ["test", "shock", "direction"].into_iter().chain(COLUMNS).collect();
    Ok(Table::new(
        "Half-sine shock of MIL-STD-202, in both directions along the motion of the contact.",
        &columns,
        runs.iter().zip(&outcomes).map(row).collect(),
    ))
}

fn method(frequencies: usize) -> String {
    let (duration, periods) = DWELL;
    format!(
        "How it was found: the nonlinear specimen is shaken from rest with a sine for {:.0} ms or {periods:.0} periods, whichever \
         is longer, at {frequencies} frequencies; by then the transient of the start has decayed, but it counts too. It *opens at all* where \
         the contact force reaches zero at any instant, and is *interrupted* where the resistance stays above 60 Ω for 10 µs \
         (MIL-PRF-28776; MIL-STD-202 method 310). Each threshold is the smallest such acceleration, found by bisection to {} %. The result holds for the equivalent beam \
         with its identified damping, vibrated along the motion of the contact, after the contact has come to rest: bounce after \
         switching and resonances of the relay's case are not included.",
        1e3 * duration,
        100.0 * RESOLUTION,
    )
}
