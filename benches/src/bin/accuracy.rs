//! Measures the cost of accuracy and writes `accuracy.csv`, and the tables of `accuracy.md` between its two markers.
//! `cargo xtask accuracy` calls this and draws the figures.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use benches::{plan, study, table};
use clap::Parser;

const BEGIN: &str = "<!-- tables: written by cargo xtask accuracy -->";
const END: &str = "<!-- end of tables -->";

#[derive(Parser)]
#[command(about = "Measures the cost of accuracy")]
struct Arguments {
    /// Folder of accuracy.csv and accuracy.md
    #[arg(long, default_value = "docs")]
    folder: PathBuf,
    /// Few settings and one round
    #[arg(long)]
    quick: bool,
    /// How often each run is timed; the median counts
    #[arg(long, default_value_t = 7)]
    turns: usize,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let rows = study::run(
        &plan::all(arguments.quick)?,
        if arguments.quick { 1 } else { arguments.turns },
    );
    fs::create_dir_all(&arguments.folder)?;
    write(&arguments.folder.join("accuracy.csv"), &table::csv(&rows))?;
    update(&arguments.folder.join("accuracy.md"), &table::report(&rows))
}

/// Replaces the text between the markers of a page; a page without them is replaced by the tables.
fn update(path: &Path, tables: &str) -> Result<()> {
    let page = fs::read_to_string(path).unwrap_or_default();
    let parts = page
        .split_once(BEGIN)
        .and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.unwrap_or_default();
    write(path, &format!("{before}{BEGIN}\n\n{tables}\n{END}{after}"))
}

fn write(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
