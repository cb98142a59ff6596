//! The publication compared with this model.
//!
//! [`published`]: its numbers;   [`runs`], [`results`]: those of this model;   the crate `identify`: the identification.
//! Sections, of blocks by [`comparison`], [`coverage`], [`resistance`], [`figures`], [`responses`]; [`contact`]: the
//! contact that the numbers belong to;   [`not_reproduced`] with [`elastic`]; [`findings`]; [`identification`].   [`table`], [`curves`]: what these are made with;   [`spring`]: the motion
//! between clamp and contact;   [`validation`]: the same as `docs/validation.md`.

mod comparison;
mod contact;
mod coverage;
mod curves;
mod elastic;
mod figures;
mod findings;
mod identification;
mod not_reproduced;
mod published;
mod resistance;
mod responses;
mod results;
mod runs;
mod spring;
mod table;
#[cfg(test)]
mod tests;
pub mod validation;

use anyhow::Result;

use self::results::Results;
use crate::content::{Arguments, Block, Section};

/// The sections.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let results = Results::compute(arguments.quick)?;
    let section = |id, title, lead, blocks| Section {
        id,
        title,
        lead,
        blocks,
    };
    let none = String::new;
    Ok(vec![
        section(
            "paper",
            "The publication reproduced",
            lead(&results)?,
            paper(&results, arguments.quick)?,
        ),
        section(
            "published-contact",
            "What the published contact is",
            contact::lead()?,
            contact::blocks(arguments)?,
        ),
        section(
            "not-reproduced",
            "Not reproduced",
            "the shift of the first frequency by prestress, the phase between force and displacement, and weak damping, \
             with the reasons."
                .to_owned(),
            not_reproduced::blocks(&results)?,
        ),
        section("findings", "Findings", none(), findings::blocks(&results)?),
        section("identification", "Identification", none(), identification::blocks()?),
    ])
}

/// What was fitted, what follows from it, and what is predicted.
fn lead(results: &Results) -> Result<String> {
    let (low, high) = published::MEASURED_RESISTANCE;
    let (ratio, frequency, peak) = published::PEAKS[0];
    let at_1000 = results.at(published::BEST, 1000.0)?;
    Ok(format!(
        "fitted to the published static force, stiffness, first frequency and one force amplitude, the model predicts a maximum force \
         amplitude of {:.2} cN at {frequency} Hz (published: {peak} cN). The resistance of {:.1} to {:.1} mΩ under 98 m/s² at 1000 Hz \
         (measured: {low} to {high} mΩ) follows from the fit by the published power law.",
        results.at(ratio, frequency)?.amplitude(),
        runs::resistance(at_1000.greatest),
        runs::resistance(at_1000.least),
    ))
}

/// How far the preload over the maximum of the force amplitude is uncertain, relative: by the difference of the published maximum
/// from this model's, and by half a unit in the last digit of the published preload.
pub fn uncertainties() -> Result<[f64; 2]> {
    let (ratio, frequency, peak) = published::PEAKS[0];
    let found = runs::linear_force(&runs::model(&runs::specimen(ratio))?, frequency);
    Ok([(found / peak - 1.0).abs(), 0.0005 / published::FORCE])
}

/// The publication's tables and figures compared with those of this model.
fn paper(results: &Results, quick: bool) -> Result<Vec<Block>> {
    let [resistances, consistency] = resistance::resistances(results)?;
    let [force, displacement] = figures::courses(results)?;
    let [time, frequency] = figures::deviations(results)?;
    Ok(vec![
        comparison::introduction(),
        comparison::statics(results)?,
        Block::Figure(figures::frequencies(quick)?),
        comparison::time_domain(results)?,
        Block::Figure(force),
        Block::Figure(displacement),
        Block::Figure(responses::time_domain(results)),
        comparison::grid(results)?,
        comparison::displacements(results)?,
        Block::Figure(responses::displacement(results)?),
        comparison::frequency_domain(results)?,
        Block::Figure(responses::frequency_domain(results)?),
        comparison::domains(results)?,
        Block::Figure(responses::domains(results)?),
        resistances,
        consistency,
        Block::Figure(figures::laws()?),
        Block::Figure(figures::resistance_course(results)?),
        Block::Figure(time),
        Block::Figure(frequency),
        coverage::blocks(results)?,
    ])
}
