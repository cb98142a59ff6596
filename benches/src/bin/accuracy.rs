//! Measures the cost of accuracy and writes `accuracy.csv`, and the machine beside it. `cargo xtask accuracy` calls this, and
//! writes tables and figures of `docs/accuracy.md`.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;
use benches::{instances, machine, study};
use clap::Parser;

#[derive(Parser)]
#[command(about = "Measures the cost of accuracy")]
struct Arguments {
    /// Folder of what is written
    #[arg(long, default_value = "out/accuracy")]
    folder: PathBuf,
    /// Few settings and one round
    #[arg(long)]
    quick: bool,
    /// How often each run is timed; the shortest counts
    #[arg(long, default_value_t = 7)]
    turns: usize,
}

fn main() -> Result<()> {
    let Arguments { folder, quick, turns } = Arguments::parse();
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("instances.csv"), instances::costs(quick)?)?;
    fs::write(folder.join("many.csv"), instances::rates(quick)?)?;
    let rows = study::measure(quick, if quick { 1 } else { turns })?;
    fs::write(folder.join("accuracy.csv"), rows)?;
    Ok(fs::write(folder.join("machine.txt"), machine::description())?)
}
