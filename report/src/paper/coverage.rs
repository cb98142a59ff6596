//! What the publication contains, and what of it is compared here.

use anyhow::Result;

use super::published as paper;
use super::results::Results;
use super::runs::{self, excitation};
use super::spring::motion;
use super::table::{cells, table};
use crate::content::Block;
use crate::numbers::{number, percent, significant};

/// Frequencies of the measurements whose results are not published, Hz.
const OTHERS: &str = "500, 1500 and 2000 Hz";

/// A row for each figure, table and stated number.
pub fn blocks(results: &Results) -> Result<Block> {
    // Weakly damped, so that at its frequency the first mode is seen.
    let model = &runs::model(&runs::specimen(paper::RATIOS[0]))?;
    // The shape of the first mode: without the base, at its frequency.
    let shape = |part: f64| {
        let base = -excitation(model.frequency());
        Ok::<_, anyhow::Error>((motion(model, model.frequency(), part)? - base).norm())
    };
    let parts = (0..=100).map(|k| Ok((f64::from(k) / 100.0, shape(f64::from(k) / 100.0)?)));
    let parts = parts.collect::<Result<Vec<_>>>()?;
    let most = parts
        .iter()
        .fold((0.0, 0.0), |most, point| if point.1 > most.1 { *point } else { most });
    let shift = results.at(paper::BEST, 1000.0)?.displacement / excitation(1000.0) - 1.0;
    let period = 1e6 / paper::RESISTANCE_SAMPLING;
    let rows = [
        ("Figs. 1 to 3, 12, 13", "drawings and photographs", "no numbers".to_owned()),
        (
            "Fig. 4",
            "shape of the first mode, 1354.5 Hz",
            format!(
                "frequency compared; shape not: a picture without scale. The text has the contact oscillate along y; in this model it moves by \
                 {} of the largest deflection, which is at {} L",
                significant(shape(1.0)? / most.1),
                number(most.0, 2)
            ),
        ),
        ("Fig. 5", "first frequency, three lengths", "four points of the text; the curves have no numbers".to_owned()),
        ("Figs. 6 to 9, Table 4", "force and displacement", "what text and table state; the curves have no numbers".to_owned()),
        (
            "Fig. 10, section 3.3",
            "roughness 12.84 µm, slope 0.5342, hardness 0.785 GPa",
            "hardness: in Holm's law; roughness: an objection to the Hertz law; slope: no law here takes one".to_owned(),
        ),
        ("Fig. 11, eq. 29", "resistance over force", "eq. 29 is the component's power law; the curve has no numbers".to_owned()),
        ("Fig. 14", "measured displacement, 1000 Hz", "compared; resolution of the sensor 0.03 µm".to_owned()),
        (
            "Fig. 15",
            "deviation of displacements from measurements",
            format!(
                "not compared: the measured values at {OTHERS} are not published, only that ratio 10 deviates by at most 10 % and ratio 30 by \
                 at most 16.54 %. This model moves with the base ({} at 1000 Hz) at each of them",
                percent(100.0 * shift)
            ),
        ),
        ("Fig. 16", "measured resistance, 1000 Hz", "compared".to_owned()),
        (
            "Fig. 17",
            "deviation of resistances, time domain, over frequency",
            format!(
                "not compared: the measured values at {OTHERS} are not published, only that ratio 10 deviates by less than 8 % (maximum) and \
                 40 % (minimum)"
            ),
        ),
        ("Table 6", "the same, by ratio", "compared; the text calls it Table 5 once".to_owned()),
        (
            "Fig. 18, section 4.2",
            "deviation of the maximum resistance, frequency domain",
            "1.21 % at 1000 Hz compared; 5.25, 3.14, 7.13 % at 500, 1500, 2000 Hz (alpha = 5125 1/s) and 2.23 % at 1500 Hz (5000 1/s) not: the \
             measured values there are not published"
                .to_owned(),
        ),
        ("Fig. 19, eqs. 31 to 33", "time and frequency domain", "compared".to_owned()),
        (
            "Table 1",
            "materials",
            "used, except the density of the contact (9800 kg/m³: the rivet's mass is fitted) and what belongs to the support block".to_owned(),
        ),
        ("Tables 2, 3", "conditions", "those of the runs here".to_owned()),
        (
            "Table 5",
            "6 V, 100 mA, 25 °C, 55 % humidity; 15.625 kS/s",
            format!(
                "not in a run here. A sample each {period} µs can miss an interruption of 10 µs; {} samples in a period of 1000 Hz find its \
                 extremes within ten seconds",
                number(1e3 / period, 1)
            ),
        ),
        (
            "section 3.1",
            "mesh: tetrahedra of 0.1 mm at the contact, 0.2 mm in the spring, two layers",
            format!(
                "no finite elements here. Two layers of 0.2 mm are a spring of up to 0.4 mm; the equivalent section is {} mm thick",
                number(1e3 * model.scene().beam.thickness, 3)
            ),
        ),
        (
            "section 3.1",
            "support block of copper, friction 0.2",
            "the block is rigid here but for its surface, whose modulus is in the Hertz law; friction: docs/friction.md".to_owned(),
        ),
    ];
    let rows = rows
        .iter()
        .map(|(place, what, here)| cells(&[place, what, here]))
        .collect();
    let columns = ["in the publication", "what", "here"];
    Ok(table(
        "What the publication contains, and what of it is compared",
        &columns,
        rows,
    ))
}
