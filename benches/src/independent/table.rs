//! Results of the comparison as CSV and as Markdown.

use std::fmt::Write as _;

use super::comparison::{Comparison, Outcome, Row};
use crate::machine;

/// Damping of the first mode relative to critical, between which relays are counted together.
const CLASSES: [(f64, f64, &str); 3] = [
    (0.0, 0.01, "0.1 to 1 %"),
    (0.01, 0.1, "1 to 10 %"),
    (0.1, f64::INFINITY, "10 to 34 %"),
];

/// The relays compared, a line each.
pub fn csv(rows: &[Row]) -> String {
    let mut text =
        String::from("relay,damping,events,tolerance,deviation,deviation_at_tightest,change_by_refinement,elements\n");
    for row in rows {
        let _ = writeln!(
            text,
            "{},{:.2e},{},{:.2e},{:.2e},{:.2e},{:.2e},{}",
            row.number, row.damping, row.events, row.asked, row.deviation, row.tightest, row.refinement, row.elements
        );
    }
    text
}

/// Median and largest of them by class of damping, and what was left out.
pub fn report(Comparison { rows, others }: &Comparison) -> String {
    let largest = |value: fn(&Row) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let mut text = format!(
        "Compared on {}: {} relays. The last refinement of the second solution changed its force by at most {:.0e} of the \
         tolerance asked.\n\n| damping of the first mode | relays | deviation over \
         tolerance, median | largest | deviation at 1e-11, median | largest |\n|---|---:|---:|---:|---:|---:|\n",
        machine::date(),
        rows.len(),
        largest(|row| row.refinement / row.asked)
    );
    let classes = CLASSES.iter().chain([&(0.0, f64::INFINITY, "all")]);
    for (least, most, name) in classes {
        let rows: Vec<&Row> = rows
            .iter()
            .filter(|row| (*least..*most).contains(&row.damping))
            .collect();
        let sorted = |value: fn(&Row) -> f64| {
            let mut values: Vec<f64> = rows.iter().map(|row| value(row)).collect();
            values.sort_by(f64::total_cmp);
            let at = |index: usize| values.get(index).copied().unwrap_or(f64::NAN);
            (at(values.len() / 2), at(values.len().saturating_sub(1)))
        };
        let (kept, tightest) = (sorted(|row| row.deviation / row.asked), sorted(|row| row.tightest));
        let _ = writeln!(
            text,
            "| {name} | {} | {:.0e} | {:.0e} | {:.0e} | {:.0e} |",
            rows.len(),
            kept.0,
            kept.1,
            tightest.0,
            tightest.1,
        );
    }
    let ill = others
        .iter()
        .filter(|(_, outcome)| matches!(outcome, Outcome::IllConditioned));
    let _ = writeln!(text, "\nIll-conditioned and left out: {}.", ill.count());
    for (number, outcome) in others {
        if let Outcome::Failed(why) = outcome {
            let _ = writeln!(text, "Relay {number} did not finish: {why}.");
        }
    }
    text
}
