//! The publication beside the model.
//!
//! [`published`]: its numbers;   [`runs`], [`results`]: ours;   [`calculation`]: the identification, shared with its example.
//! Sections, of blocks by [`comparison`], [`resistance`], [`figures`], [`responses`]; [`not_reproduced`] with [`displacement`],
//! [`elastic`]; [`findings`]; [`identification`].   [`table`], [`curves`]: what these are made with;   [`spring`]: the motion
//! between clamp and contact;   [`validation`]: the same as `docs/validation.md`.

#[path = "../../../../examples/identify/identification.rs"]
mod calculation;
mod comparison;
mod curves;
mod displacement;
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
use super::Arguments;
use super::content::{Block, Section};

/// The sections.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let results = Results::compute(arguments.quick)?;
    let section = |id, title, blocks| Section { id, title, blocks };
    Ok(vec![
        section("paper", "The publication reproduced", paper(&results, arguments.quick)?),
        section("not-reproduced", "Not reproduced", not_reproduced::blocks(&results)?),
        section("findings", "Findings", findings::blocks(&results)?),
        section("identification", "Identification", identification::blocks()?),
    ])
}

/// The publication's tables and figures beside ours.
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
        Block::Figure(responses::displacement(results)),
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
    ])
}
