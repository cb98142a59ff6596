//! What each effect costs and changes, by the same measurement as `docs/effects.md`.

use anyhow::Result;
use indicatif::ProgressBar;

use super::{Extent, measure, page};
use crate::content::{Arguments, Block, Section};

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let extent = Extent {
        runs: if arguments.quick { 3 } else { 9 },
        instructions: !arguments.quick,
        influence: !arguments.quick,
    };
    let measurement = measure(extent, &ProgressBar::hidden())?;
    let text = format!(
        "Each effect is switched on by a parameter of the scene. {} `cargo xtask effects` writes these tables to `docs/effects.md`.",
        page::how(&measurement)
    );
    let mut blocks = vec![Block::Text(text), Block::Table(page::costs(&measurement))];
    blocks.extend(page::influences(&measurement).map(Block::Table));
    blocks.push(Block::Text(page::when(&measurement)));
    Ok(vec![Section {
        id: "effects",
        title: "Cost and influence of each effect",
        lead: String::new(),
        blocks,
    }])
}
