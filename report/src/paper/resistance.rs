//! Published contact resistances beside ours.

use anyhow::Result;

use super::published as paper;
use super::results::Results;
use super::runs::{linear_force, resistance};
use super::table::{cells, comparison, row};
use crate::content::Block;
use crate::numbers::{number, percent, signed};

/// Deviations of least and greatest resistance from the measured ones at 1000 Hz, %, where the force has extremes (N).
pub fn resistance_deviations(least: f64, greatest: f64) -> (f64, f64) {
    let (low, high) = paper::MEASURED_RESISTANCE;
    (
        100.0 * (resistance(greatest) / low - 1.0),
        100.0 * (resistance(least) / high - 1.0),
    )
}

/// Contact resistance.
pub fn resistances(results: &Results) -> Result<[Block; 2]> {
    let run = results.at(paper::BEST, 1000.0)?;
    let (low, high) = paper::MEASURED_RESISTANCE;
    let place = "section 4.2, Fig. 16";
    let mut rows = vec![
        row(
            "least resistance, 1000 Hz, measured",
            low,
            resistance(run.greatest),
            2,
            "mΩ",
            place,
        ),
        row(
            "greatest resistance, 1000 Hz, measured",
            high,
            resistance(run.least),
            2,
            "mΩ",
            place,
        ),
    ];
    let points = |quantity: &str, published: f64, ours: f64, place: &str| {
        cells(&[
            quantity,
            &format!("{published} %"),
            &percent(ours),
            &format!("{} points", signed(ours.abs() - published, 2)),
            place,
        ])
    };
    for (ratio, least, greatest) in paper::RESISTANCE_DEVIATIONS {
        let run = results.at(ratio, 1000.0)?;
        let (ours_least, ours_greatest) = resistance_deviations(run.least, run.greatest);
        let name = |what: &str| format!("{what} resistance against measured, ratio {ratio}");
        rows.push(points(&name("greatest"), greatest, ours_greatest, "Table 6"));
        rows.push(points(&name("least"), least, ours_least, "Table 6"));
    }
    let force = results.specimen.preload().force;
    let model = results.alpha(5125.0)?;
    for (frequency, published) in paper::FREQUENCY_DOMAIN_DEVIATIONS {
        let ours = resistance(force - linear_force(model, frequency) / 100.0);
        let name = format!("greatest resistance against measured, alpha = 5125 1/s, {frequency} Hz");
        if frequency == 1000.0 {
            let deviation = 100.0 * (ours / high - 1.0);
            rows.push(points(&name, published, deviation, "section 4.2, Fig. 18"));
        } else {
            let ours = format!("{} mΩ", number(ours, 2));
            let unknown = "measured value not published";
            rows.push(cells(&[
                &name,
                &format!("{published} %"),
                &ours,
                unknown,
                "section 4.2, Fig. 18",
            ]));
        }
    }
    let table = comparison(
        "Contact resistance, 98 m/s²; published deviations have no sign, so sizes are compared, in percentage points. Table 6 names no \
         frequency; it is taken for 1000 Hz",
        rows,
    );
    Ok([table, consistency()])
}

/// What the publication's own force gives by its own power law.
fn consistency() -> Block {
    let (coefficient, exponent) = paper::RESISTANCE;
    let (low, high) = paper::MEASURED_RESISTANCE;
    let law = |force: f64| coefficient * force.powf(-exponent);
    let amplitude = paper::FORCE_AMPLITUDE / 100.0;
    let (_, least, greatest) = paper::RESISTANCE_DEVIATIONS[0];
    Block::Text(format!(
        "Table 6 does not follow from the publication's other numbers, if it belongs to 1000 Hz: the published force amplitude of {} cN about the published static force of {} N gives, \
         by the published power law, {} for the greatest and {} for the least resistance against the measured ones, where Table 6 has \
         {greatest} % and {least} %. Those are ours.",
        paper::FORCE_AMPLITUDE,
        paper::FORCE,
        percent(100.0 * (law(paper::FORCE - amplitude) / high - 1.0)),
        percent(100.0 * (law(paper::FORCE + amplitude) / low - 1.0)),
    ))
}
