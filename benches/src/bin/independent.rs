//! Solves random opening relays a second time by finite elements and SUNDIALS ARKODE, and writes the deviations of the
//! contact force into `independent.csv`, and their table into `accuracy.md` between its two markers.

use std::fs;
use std::path::PathBuf;

use anyhow::{Result, anyhow};
use benches::independent::comparison::compare_all;
use benches::independent::table;
use benches::page;
use clap::Parser;

const BEGIN: &str = "<!-- independent: written by cargo run --release --package benches --bin independent -->";
const END: &str = "<!-- end of independent -->";

#[derive(Parser)]
#[command(about = "Compares the component with finite elements and SUNDIALS ARKODE on random opening relays")]
struct Arguments {
    /// Folder of independent.csv and accuracy.md
    #[arg(long, default_value = "docs")]
    folder: PathBuf,
    /// Number of the first relay
    #[arg(long, default_value_t = 10_000)]
    first: u64,
    /// Relays to compare: those that do not open or are ill-conditioned are not counted
    #[arg(long, default_value_t = 50)]
    count: usize,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let comparison = compare_all(arguments.first, arguments.count).map_err(|failure| anyhow!("{failure}"))?;
    fs::create_dir_all(&arguments.folder)?;
    page::write(&arguments.folder.join("independent.csv"), &table::csv(&comparison.rows))?;
    let table = table::report(&comparison);
    println!("{table}");
    page::update(&arguments.folder.join("accuracy.md"), [BEGIN, END], &table)
}
