//! Published contact resistances compared with those of this model.

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
            "minimum resistance, 1000 Hz, measured",
            low,
            resistance(run.greatest),
            2,
            "mΩ",
            place,
        ),
        row(
            "maximum resistance, 1000 Hz, measured",
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
        let name = |what: &str| format!("deviation of {what} resistance from measurement, ratio {ratio}");
        rows.push(points(&name("maximum"), greatest, ours_greatest, "Table 6"));
        rows.push(points(&name("minimum"), least, ours_least, "Table 6"));
    }
    let force = results.specimen.preload().force;
    let model = results.alpha(5125.0)?;
    for (frequency, published) in paper::FREQUENCY_DOMAIN_DEVIATIONS {
        let ours = resistance(force - linear_force(model, frequency) / 100.0);
        let name = format!("deviation of maximum resistance from measurement, alpha = 5125 1/s, {frequency} Hz");
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
        "Contact resistance, 98 m/s²; published deviations have no sign, so absolute values are compared, in \
         percentage points. Table 6 states no frequency; 1000 Hz is assumed",
        rows,
    );
    Ok([table, consistency()])
}

/// The publication's own force inserted into its own power law.
fn consistency() -> Block {
    let (coefficient, exponent) = paper::RESISTANCE;
    let (low, high) = paper::MEASURED_RESISTANCE;
    let law = |force: f64| coefficient * force.powf(-exponent);
    let amplitude = paper::FORCE_AMPLITUDE / 100.0;
    let (_, least, greatest) = paper::RESISTANCE_DEVIATIONS[0];
    Block::Text(format!(
        "If Table 6 refers to 1000 Hz, it does not follow from the publication's other numbers: with the published \
         power law, the published force amplitude of {} cN about the published static force of {} N gives deviations \
         of {} for the maximum and {} for the minimum resistance, where Table 6 has {greatest} % and {least} %. The \
         former agree with this model.",
        paper::FORCE_AMPLITUDE,
        paper::FORCE,
        percent(100.0 * (law(paper::FORCE - amplitude) / high - 1.0)),
        percent(100.0 * (law(paper::FORCE + amplitude) / low - 1.0)),
    ))
}
