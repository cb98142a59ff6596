//! What each effect costs and changes: `docs/effects.md`, and a section of the report.
//!
//! [`list`]: the effects;   [`cost`]: instructions and time of the minimal scene with each;   [`influence`]: what each changes
//! in the scenes;   [`page`]: all that as tables.

mod callgrind;
mod cost;
mod influence;
mod list;
mod page;
pub mod run_scene;
pub mod section;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

pub use self::callgrind::instructions;
use self::cost::{Cost, Counter};
use self::influence::{Influence, Runs};
use self::list::{EFFECTS, Effect};
use self::run_scene::RunScene;
use crate::markdown::table as markdown_table;

/// Where to write.
#[derive(clap::Args)]
pub struct Arguments {
    /// The page to write
    #[arg(long, default_value = "docs/effects.md")]
    page: PathBuf,
}

/// How much is measured.
#[derive(Clone, Copy)]
pub struct Extent {
    /// Runs of which the shortest is the time.
    pub runs: usize,
    /// Whether instructions are counted, where valgrind is there.
    pub instructions: bool,
    /// Whether the scenes are compared with and without each effect.
    pub influence: bool,
}

/// All that was measured.
pub struct Measurement {
    extent: Extent,
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

/// Measures and writes the page.
pub fn run(arguments: &Arguments) -> Result<()> {
    if !callgrind::is_installed() {
        eprintln!(
            "{}, so instructions are not counted: nanoseconds alone",
            callgrind::MISSING
        );
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::no_length().with_style(style);
    let extent = Extent {
        runs: 15,
        instructions: true,
        influence: true,
    };
    let measurement = measure(extent, &progress)?;
    progress.finish_and_clear();
    fs::write(&arguments.page, page::page(&measurement))
        .with_context(|| format!("cannot write {}", arguments.page.display()))?;
    println!("{}", markdown_table(&page::costs(&measurement)));
    println!("{}", arguments.page.display());
    Ok(())
}

/// Measures: first times, one after the other, then what does not depend on what else the machine does.
pub fn measure(extent: Extent, progress: &ProgressBar) -> Result<Measurement> {
    let usual = RunScene::build()?;
    let counter = (extent.instructions && callgrind::is_installed())
        .then(Counter::build)
        .transpose()?;
    progress.set_length(2 * EFFECTS.len() as u64 + 2);
    let runs: Vec<Vec<(String, String)>> = [Vec::new()]
        .into_iter()
        .chain(EFFECTS.iter().map(list::changes))
        .collect();
    let mut times = Vec::new();
    progress.set_message("times");
    for changes in &runs {
        times.push(cost::nanoseconds(&usual, changes, extent.runs)?);
        progress.inc(1);
    }
    progress.set_message("instructions and influence");
    let count = |changes: &Vec<_>| {
        let count = counter.as_ref().map(|counter| counter.count(changes)).transpose();
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
    let influences = extent.influence.then(Runs::compute).transpose()?;
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
        let influence = influences.as_ref().map(|runs| runs.influence(effect)).transpose()?;
        Ok(Measured {
            effect,
            cost: *cost,
            base: base(effect)?,
            influence: influence.flatten(),
        })
    };
    let effects = EFFECTS.iter().zip(costs).map(measured).collect::<Result<_>>()?;
    Ok(Measurement {
        extent,
        minimal: *minimal,
        effects,
    })
}
