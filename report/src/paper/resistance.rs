//! Published contact resistances compared with those of this model.

use anyhow::Result;

use super::published as paper;
use super::results::Results;
use super::runs::{linear_force, resistance};
use super::table::Comparison;
use crate::content::Block;
use crate::numbers::{percent, signed};

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
    let mut rows = Comparison::at("section 4.2, Fig. 16");
    let (least, greatest) = (resistance(run.greatest), resistance(run.least));
    rows.row("minimum resistance, 1000 Hz, measured", low, least, 2, "mΩ");
    rows.row("maximum resistance, 1000 Hz, measured", high, greatest, 2, "mΩ");
    let mut points = |place, what: &str, damping: &str, published: f64, value: f64| {
        rows.then_at(place);
        let name = format!("deviation of {what} resistance from measurement, {damping}");
        let texts = [format!("{published} %"), percent(value)];
        rows.texts(&name, texts, &format!("{} points", signed(value.abs() - published, 2)));
    };
    for (ratio, least, greatest) in paper::RESISTANCE_DEVIATIONS {
        let run = results.at(ratio, 1000.0)?;
        let (found_least, found_greatest) = resistance_deviations(run.least, run.greatest);
        let damping = format!("ratio {ratio}");
        points("Table 6", "maximum", &damping, greatest, found_greatest);
        points("Table 6", "minimum", &damping, least, found_least);
    }
    let amplitude = linear_force(results.alpha(5125.0)?, 1000.0) / 100.0;
    let found = 100.0 * (resistance(results.specimen.preload().force - amplitude) / high - 1.0);
    let (damping, published) = ("alpha = 5125 1/s, 1000 Hz", paper::FREQUENCY_DOMAIN_DEVIATION);
    points("section 4.2, Fig. 18", "maximum", damping, published, found);
    let table = rows.table(
        "Contact resistance, 98 m/s²; published deviations have no sign, so absolute values are compared, in \
         percentage points. Table 6 states no frequency; 1000 Hz is assumed",
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
