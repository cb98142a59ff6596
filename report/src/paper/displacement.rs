//! The displacement of the contact, and the points of the spring at which the published one may have been measured.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use relay_contact::reference;

use super::published as paper;
use super::results::Results;
use super::runs::{self, excitation};
use super::spring::{displacement, motion};
use super::table::table;
use crate::content::Block;
use crate::numbers::{number, signed};

/// The blocks.
pub fn blocks(results: &Results) -> Result<Vec<Block>> {
    let base = 1e6 * excitation(1000.0);
    let stiffness = results.specimen.preload().contact_stiffness;
    let run = results.at(paper::BEST, 1000.0)?;
    let indentation = results.specimen.preload().indentation;
    let text = format!(
        "### The displacement of the contact\n\n\
         The base moves by {} µm at 1000 Hz and 98 m/s². A closed contact moves with it: a force amplitude of {} cN \
         at a contact stiffness of {} N/µm is at most {} nm of relative motion, and the whole indentation at rest is \
         {} nm. The published displacement exceeds that of the base by up to {} µm. The published stiffness and force \
         do not allow this of the contact point. Which point of the finite elements was read is not published, nor is \
         that of the laser for the measured {} µm. Another point of the spring, a contact that rotates or slides, or one \
         much softer than the published stiffness would move more; none of these is shown here.",
        number(base, 3),
        number(run.amplitude(), 2),
        number(1e-6 * stiffness, 2),
        number(1e7 * run.amplitude() / stiffness, 1),
        number(1e9 * indentation, 1),
        number(paper::DISPLACEMENTS[0] - base, 1),
        paper::MEASURED_DISPLACEMENT,
    );
    let mut blocks = vec![Block::Text(text)];
    blocks.extend(elsewhere()?);
    Ok(blocks)
}

/// Points of the spring whose displacement is compared with the published one, as fractions of the length.
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
            format!("1250 Hz, ratio {ratio}, in excess of the base"),
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
        let found = 1e6 * displacement(&runs::model(&runs::specimen(ratio))?, 1000.0, fitted)?;
        furthest = furthest.max(100.0 * (found / published - 1.0).abs());
    }
    let force = reference::response(&specimen, TAU * 1000.0).force;
    let phase = (force / motion(&specimen, 1000.0, fitted)?).arg().to_degrees().abs();
    let text = format!(
        "A point on the spring would explain much of the difference. At {} of the length from the clamp, {} mm before \
         the contact, the spring of this model has the published amplitude for ratio 10 at 1000 Hz, and those for \
         ratios of 5 to 30 within {} %. At that point it reproduces neither the amplitudes of weak damping nor those at 1250 Hz, \
         and the phase between force and displacement is {}° there, not the published {}°.",
        number(fitted, 3),
        number(1e3 * (1.0 - fitted) * specimen.section().length, 2),
        number(furthest, 1),
        number(phase, 0),
        paper::PHASE,
    );
    let heads = ["run".to_owned(), "published".to_owned()].into_iter();
    let points = POINTS.iter().map(|part| format!("this model, at {part} L"));
    let columns: Vec<String> = heads
        .chain(points)
        .chain([format!("this model, at {} L", number(fitted, 3))])
        .collect();
    let caption = "Displacement amplitude at points of the spring of this model, base included, linear response";
    Ok(vec![Block::Text(text), table(caption, &columns, rows)])
}
