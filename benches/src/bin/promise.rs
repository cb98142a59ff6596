//! Judges random relays by the promise of `solver.tolerance` and writes `promise.csv`; `python -m report promise` makes tables and a
//! figure of it.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Parser;
use testing::kinds::{self, KINDS};
use testing::promise::{Judged, Outcome, compare_all, judge_each};
use testing::relays::Relay;

#[derive(Parser)]
#[command(about = "Judges random relays by the promise of solver.tolerance")]
struct Arguments {
    /// Folder of promise.csv
    #[arg(long, default_value = "out/accuracy")]
    folder: PathBuf,
    /// Number of the first relay
    #[arg(long, default_value_t = 3_000_000)]
    first: u64,
    /// Number of relays
    #[arg(long, default_value_t = 2_000)]
    count: u64,
    /// Which relays; of one kind only those above their tolerance are printed, and nothing is written
    #[arg(long, value_parser = of_kind)]
    kind: Option<fn(u64) -> Relay>,
    /// Compare references with themselves in communication steps of a quarter, and print those that disagree without a word
    #[arg(long)]
    quarters: bool,
}

/// Draws relays of the kind of a name.
fn of_kind(name: &str) -> Result<fn(u64) -> Relay> {
    let found = KINDS.iter().find(|(kind, ..)| *kind == name);
    let allowed = || KINDS.map(|(kind, ..)| kind).join(", ");
    Ok(found.with_context(|| format!("no such kind, allowed are {}", allowed()))?.2)
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let draw = arguments.kind.unwrap_or(kinds::any);
    if arguments.quarters {
        let compared = compare_all(arguments.first, arguments.count, draw);
        let silent = compared.iter().filter(|compared| compared.is_silent());
        silent.for_each(|compared| println!("{compared:?}"));
        return Ok(());
    }
    if arguments.kind.is_some() {
        let (mut run, mut alarms) = (0, 0);
        judge_each(arguments.first, arguments.count, draw, 0.0, |judged| {
            run += u64::from(judged.outcome != Outcome::NotRun);
            alarms += u64::from(judged.outcome == Outcome::Kept && judged.estimate > judged.tolerance);
            if judged.error > judged.tolerance {
                println!("{judged:?}");
            }
        });
        println!("{run} run; of those that keep their tolerance {alarms} are announced as above it");
        return Ok(());
    }
    let path = arguments.folder.join("promise.csv");
    let mut table = fs::create_dir_all(&arguments.folder)
        .and_then(|()| File::create(&path))
        .with_context(|| format!("cannot write {}", path.display()))?;
    writeln!(table, "relay,kind,damping,opens,tolerance,error,instants,estimate,outcome")?;
    let mut written = Ok(());
    judge_each(arguments.first, arguments.count, draw, 0.0, |judged| {
        if written.is_ok() {
            written = writeln!(table, "{}", row(&judged));
        }
    });
    Ok(written?)
}

fn row(judged: &Judged) -> String {
    let Judged { number, kind, damping, opens, tolerance, error, instants, estimate, outcome } = judged;
    let instants = instants.map_or(String::new(), |instants| format!("{instants:e}"));
    format!("{number},{kind},{damping:e},{opens},{tolerance:e},{error:e},{instants},{estimate:e},{outcome:?}")
}
