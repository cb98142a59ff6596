//! The displacement of the contact, and where on the spring the published one may have been read.

use anyhow::{Context, Result};
use relay_contact::reference;

use super::published as paper;
use super::results::Results;
use super::runs::{self, elastic_force, excitation};
use super::spring::displacement;
use super::table::{cells, table};
use crate::content::Block;
use crate::numbers::{deviation, number, signed};

/// The blocks.
pub fn blocks(results: &Results) -> Result<Vec<Block>> {
    let base = 1e6 * excitation(1000.0);
    let stiffness = results.specimen.preload().contact_stiffness;
    let mut rows = Vec::new();
    for (ratio, published) in paper::RATIOS.into_iter().zip(paper::DISPLACEMENTS) {
        let run = results.at(ratio, 1000.0)?;
        let ours = 1e6 * run.displacement;
        let relative = elastic_force(&runs::model(&runs::specimen(ratio))?, 1000.0) / stiffness;
        rows.push(cells(&[
            &format!("{ratio}"),
            &format!("{published} µm"),
            &format!("{} µm", number(ours, 3)),
            &deviation(ours, published),
            &format!("{} µm", number(published - base, 3)),
            &format!("{} nm", number(1e7 * relative, 1)),
        ]));
    }
    let run = results.at(paper::BEST, 1000.0)?;
    let indentation = results.specimen.preload().indentation;
    let text = format!(
        "### The displacement of the contact\n\n\
         The base moves by {} µm at 1000 Hz and 98 m/s². A closed contact moves with it: a force amplitude of {} cN over a contact stiffness of \
         {} N/µm is at most {} nm of motion between the two, and the whole indentation at rest is {} nm. Published is up to {} µm more than the \
         base. No contact of the published stiffness can do that with the published force, so the published displacement must have been read \
         at another place: somewhere on the spring, or on a contact that turns or slides in the three-dimensional model. Where is not \
         published. The same holds for the measured {} µm: where the laser pointed is not published. The phase of 90° between \
         force and displacement belongs to that place too.",
        number(base, 3),
        number(run.amplitude(), 2),
        number(1e-6 * stiffness, 2),
        number(1e7 * run.amplitude() / stiffness, 1),
        number(1e9 * indentation, 1),
        number(paper::DISPLACEMENTS[0] - base, 1),
        paper::MEASURED_DISPLACEMENT,
    );
    let columns = [
        "ratio",
        "published",
        "ours",
        "deviation",
        "published above that of the base",
        "ours relative to the base",
    ];
    let mut blocks = vec![
        Block::Text(text),
        table(
            "Displacement amplitude at 1000 Hz, base included (Table 4)",
            &columns,
            rows,
        ),
    ];
    blocks.extend(elsewhere()?);
    Ok(blocks)
}

/// Points of the spring whose displacement is compared with the published one, in parts of the length.
const POINTS: [f64; 4] = [0.8, 0.85, 0.9, 0.95];

/// The displacement of other points of the spring.
fn elsewhere() -> Result<Vec<Block>> {
    let specimen = runs::model(&runs::specimen(paper::BEST))?;
    let excess = |part: f64| displacement(&specimen, 1000.0, part).map_or(f64::NAN, |d| 1e6 * d - paper::DISPLACEMENT);
    let fitted = reference::bracketed(excess, 0.7, 1.0).context("no point of the spring moves as published")?;
    let mut rows = Vec::new();
    for (ratio, published) in paper::RATIOS.into_iter().zip(paper::DISPLACEMENTS) {
        let model = runs::model(&runs::specimen(ratio))?;
        let mut row = vec![format!("1000 Hz, ratio {ratio}"), format!("{published} µm")];
        for part in POINTS.into_iter().chain([fitted]) {
            row.push(format!("{} µm", number(1e6 * displacement(&model, 1000.0, part)?, 3)));
        }
        rows.push(row);
    }
    for (ratio, published) in paper::DISPLACEMENT_DEVIATIONS {
        let model = runs::model(&runs::specimen(ratio))?;
        let mut row = vec![
            format!("1250 Hz, ratio {ratio}, above the base"),
            format!("{} %", signed(published, 1)),
        ];
        for part in POINTS.into_iter().chain([fitted]) {
            let above = 100.0 * (displacement(&model, 1250.0, part)? / excitation(1250.0) - 1.0);
            row.push(format!("{} %", signed(above, 1)));
        }
        rows.push(row);
    }
    let damped = paper::RATIOS
        .into_iter()
        .zip(paper::DISPLACEMENTS)
        .filter(|point| point.0 >= 5.0);
    let mut furthest = 0.0_f64;
    for (ratio, published) in damped {
        let ours = 1e6 * displacement(&runs::model(&runs::specimen(ratio))?, 1000.0, fitted)?;
        furthest = furthest.max(100.0 * (ours / published - 1.0).abs());
    }
    let text = format!(
        "A place on the spring would explain much of it. At {} of the length from the clamp, {} mm before the contact, our spring has the \
         published amplitude for ratio 10 at 1000 Hz, and those for the ratios from 5 to 30 within {} %. The weakly damped ones and \
         those at 1250 Hz are not found at that point.",
        number(fitted, 3),
        number(1e3 * (1.0 - fitted) * specimen.section().length, 2),
        number(furthest, 1),
    );
    let heads = ["run".to_owned(), "published".to_owned()].into_iter();
    let points = POINTS.iter().map(|part| format!("ours, at {part} L"));
    let columns: Vec<String> = heads
        .chain(points)
        .chain([format!("ours, at {} L", number(fitted, 3))])
        .collect();
    let columns: Vec<_> = columns.iter().map(String::as_str).collect();
    let caption = "Displacement amplitude of points of our spring, base included, linear";
    Ok(vec![Block::Text(text), table(caption, &columns, rows)])
}
