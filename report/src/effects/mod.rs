//! What each effect costs and changes: `docs/effects.md`, which the report shows too.
//!
//! [`list`]: the effects;   [`cost`]: instructions of the minimal scene with each;   [`influence`]: what each changes
//! in the scenes;   [`page`]: all that as a page.   [`ratios`]: instructions of scenes compared.

mod callgrind;
mod cost;
mod influence;
mod list;
mod page;
mod ratios;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use commands::root;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use self::cost::RunScene;
use self::influence::{Influence, Runs};
use self::list::{EFFECTS, Effect};
use crate::content::{Arguments as Extent, Section};
use crate::markdown;

/// Where to write.
#[derive(clap::Args)]
pub struct Arguments {
    /// The page to write
    #[arg(long, default_value = "docs/effects.md")]
    page: PathBuf,
}

/// Prints the instructions of communication steps.
pub fn instructions() -> Result<()> {
    callgrind::print_steps()?;
    ratios::print()
}

/// All that was measured.
pub struct Measurement {
    /// Instructions of the minimal scene per simulated millisecond.
    minimal: f64,
    effects: Vec<Measured>,
}

/// An effect, measured.
struct Measured {
    effect: &'static Effect,
    /// Instructions with it, and with what it is compared with.
    cost: f64,
    base: f64,
    influence: Option<Influence>,
}

/// The section of the report: the page as it was last written.
pub fn sections(_: Extent) -> Result<Vec<Section>> {
    let path = root().join("docs/effects.md");
    let page = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    Ok(vec![Section {
        id: "effects",
        title: "Cost and influence of each effect",
        lead: String::new(),
        blocks: markdown::blocks(&page, &[]),
    }])
}

/// Measures and writes the page.
pub fn run(arguments: &Arguments) -> Result<()> {
    let measurement = measure()?;
    fs::write(&arguments.page, page::page(&measurement))
        .with_context(|| format!("cannot write {}", arguments.page.display()))?;
    println!("{}", arguments.page.display());
    Ok(())
}

/// Counts the instructions of each effect, and runs the scenes with and without it.
fn measure() -> Result<Measurement> {
    let run_scene = RunScene::build()?;
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} instructions")?;
    let progress = ProgressBar::new(EFFECTS.len() as u64 + 1).with_style(style);
    let count = |changes: Vec<_>| {
        let count = run_scene.instructions(&changes);
        progress.inc(1);
        count
    };
    let minimal = count(Vec::new())?;
    let costs: Vec<_> = EFFECTS
        .par_iter()
        .map(|effect| count(list::changes(effect)))
        .collect::<Result<_>>()?;
    progress.finish_and_clear();
    let influences = Runs::compute()?;
    let base = |effect: &Effect| match effect.beside {
        Some(name) => {
            let base = EFFECTS.iter().zip(&costs).find(|(known, _)| known.name == name);
            base.map(|(_, cost)| *cost)
                .with_context(|| format!("{name}: no such effect"))
        }
        None => Ok(minimal),
    };
    let measured = |(effect, cost): (&'static Effect, &f64)| {
        Ok(Measured {
            effect,
            cost: *cost,
            base: base(effect)?,
            influence: influences.influence(effect)?,
        })
    };
    let effects = EFFECTS.iter().zip(&costs).map(measured).collect::<Result<_>>()?;
    Ok(Measurement { minimal, effects })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::content::Block;

    #[test]
    fn the_page_has_every_effect() -> Result<()> {
        let sections = sections(Extent::default())?;
        let tables = sections
            .iter()
            .flat_map(|section| &section.blocks)
            .filter_map(|block| match block {
                Block::Table(table) => Some(table),
                Block::Text(_) | Block::Figure(_) => None,
            });
        let heads = tables.flat_map(|table| &table.rows).filter_map(|row| row.first());
        let heads: Vec<_> = heads.collect();
        for effect in EFFECTS {
            let names = heads.iter().filter(|head| head.split(" (").next() == Some(effect.name));
            let tables = if effect.off.is_empty() { 1 } else { 2 };
            assert_eq!(names.count(), tables, "{}: cargo xtask effects", effect.name);
        }
        Ok(())
    }
}
