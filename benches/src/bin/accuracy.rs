//! Measures the cost of accuracy and writes `accuracy.csv`, and the tables of `accuracy.md` between its two markers.
//! `cargo xtask accuracy` calls this and draws the figures.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;
use benches::{page, plan, study, table};
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
    page::write(&arguments.folder.join("accuracy.csv"), &table::csv(&rows))?;
    page::update(
        &arguments.folder.join("accuracy.md"),
        [BEGIN, END],
        &table::report(&rows),
    )
}
