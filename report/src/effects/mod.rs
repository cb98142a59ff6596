//! What each effect costs and changes: `docs/effects.md`, which the report shows too.
//!
//! [`list`]: the effects;   [`cost`]: instructions and time of the minimal scene with each;   [`influence`]: what each changes
//! in the scenes;   [`page`]: all that as a page.

mod callgrind;
mod cost;
mod influence;
mod list;
mod page;
pub mod run_scene;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use commands::root;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

pub use self::callgrind::instructions;
use self::cost::Cost;
use self::influence::{Influence, Runs};
use self::list::{EFFECTS, Effect};
use self::run_scene::RunScene;
use crate::content::{Arguments as Extent, Section};
use crate::markdown;

/// Where to write.
#[derive(clap::Args)]
pub struct Arguments {
    /// The page to write
    #[arg(long, default_value = "docs/effects.md")]
    page: PathBuf,
}

/// Runs of which the shortest is the time.
const RUNS: usize = 15;

/// All that was measured.
pub struct Measurement {
    minimal: Cost,
    effects: Vec<Measured>,
}

/// An effect, measured.
struct Measured {
    effect: &'static Effect,
    cost: Cost,
    /// Of what it is compared with.
    base: Cost,
    influence: Option<Influence>,
}

/// The section of the report: the page as it was last written, so that no time is taken beside other work.
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
    if !callgrind::is_installed() {
        eprintln!(
            "{}, so instructions are not counted: nanoseconds alone",
            callgrind::MISSING
        );
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new(2 * EFFECTS.len() as u64 + 2).with_style(style);
    let measurement = measure(&progress)?;
    progress.finish_and_clear();
    fs::write(&arguments.page, page::page(&measurement))
        .with_context(|| format!("cannot write {}", arguments.page.display()))?;
    println!("{}", arguments.page.display());
    Ok(())
}

/// Measures: first times, one after the other, then what does not depend on what else the machine does.
fn measure(progress: &ProgressBar) -> Result<Measurement> {
    let usual = RunScene::build()?;
    let portable = callgrind::is_installed().then(RunScene::build_portable).transpose()?;
    let runs: Vec<Vec<(String, String)>> = [Vec::new()]
        .into_iter()
        .chain(EFFECTS.iter().map(list::changes))
        .collect();
    let mut times = Vec::new();
    progress.set_message("times");
    for changes in &runs {
        times.push(cost::nanoseconds(&usual, changes, RUNS)?);
        progress.inc(1);
    }
    progress.set_message("instructions and influence");
    let count = |changes: &Vec<_>| {
        let count = portable
            .as_ref()
            .map(|portable| cost::instructions(portable, changes))
            .transpose();
        progress.inc(1);
        count
    };
    let counts: Vec<_> = runs.par_iter().map(count).collect::<Result<_>>()?;
    let costs: Vec<Cost> = times
        .into_iter()
        .zip(counts)
        .map(|(nanoseconds, instructions)| Cost {
            instructions,
            nanoseconds,
        })
        .collect();
    let influences = Runs::compute()?;
    let (minimal, costs) = costs.split_first().context("nothing measured")?;
    let base = |effect: &Effect| match effect.beside {
        Some(name) => {
            let base = EFFECTS.iter().zip(costs).find(|(known, _)| known.name == name);
            base.map(|(_, cost)| *cost)
                .with_context(|| format!("{name}: no such effect"))
        }
        None => Ok(*minimal),
    };
    let measured = |(effect, cost): (&'static Effect, &Cost)| {
        Ok(Measured {
            effect,
            cost: *cost,
            base: base(effect)?,
            influence: influences.influence(effect)?,
        })
    };
    let effects = EFFECTS.iter().zip(costs).map(measured).collect::<Result<_>>()?;
    Ok(Measurement {
        minimal: *minimal,
        effects,
    })
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
