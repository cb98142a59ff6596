//! Judges random relays by the promise of `solver.tolerance` and writes `promise.csv`, and their table into `accuracy.md`
//! between its two markers.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result};
use benches::page;
use clap::Parser;
use testing::kinds::{self, KINDS};
use testing::promise::{Judged, Outcome, judge_all};

const BEGIN: &str = "<!-- promise: written by cargo run --release --package benches --bin promise -->";
const END: &str = "<!-- end of promise -->";

/// Damping of the first mode, %: bounds of the lines of the table.
const CLASSES: [(f64, f64); 4] = [(0.1, 0.4), (0.4, 2.0), (2.0, 10.0), (10.0, 34.0)];

#[derive(Parser)]
#[command(about = "Judges random relays by the promise of solver.tolerance")]
struct Arguments {
    /// Folder of promise.csv and accuracy.md
    #[arg(long, default_value = "docs")]
    folder: PathBuf,
    /// Number of the first relay
    #[arg(long, default_value_t = 10_000)]
    first: u64,
    /// Number of relays
    #[arg(long, default_value_t = 2_000)]
    count: u64,
    /// Which relays; those of one kind only are printed, and written to no file
    #[arg(long)]
    kind: Option<String>,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let draw = match &arguments.kind {
        None => kinds::any,
        Some(kind) => KINDS.iter().find(|(name, ..)| name == kind).context("no such kind")?.2,
    };
    let judged = judge_all(arguments.first, arguments.count, draw);
    let text = report(&judged);
    println!("{text}");
    if arguments.kind.is_some() {
        let above = judged.iter().filter(|judged| judged.error > judged.tolerance);
        above.for_each(|judged| println!("{judged:?}"));
        return Ok(());
    }
    page::write(&arguments.folder.join("promise.csv"), &csv(&judged))?;
    page::update(&arguments.folder.join("accuracy.md"), [BEGIN, END], &text)
}

fn csv(judged: &[Judged]) -> String {
    let mut text = "relay,kind,damping,opens,tolerance,error,instants,estimate,outcome\n".to_owned();
    for Judged {
        number,
        kind,
        damping,
        opens,
        tolerance,
        error,
        instants,
        estimate,
        outcome,
    } in judged
    {
        let instants = instants.map_or(String::new(), |instants| format!("{instants:.3e}"));
        let _ = writeln!(
            text,
            "{number},{kind},{damping:.3e},{opens},{tolerance:.3e},{error:.3e},{instants},{estimate:.3e},{outcome:?}"
        );
    }
    text
}

/// The table, and what the instants and `solver.forceError` are worth.
fn report(judged: &[Judged]) -> String {
    let run: Vec<_> = judged
        .iter()
        .filter(|judged| judged.outcome != Outcome::NotRun)
        .collect();
    let mut text = table(&run);
    text.push_str(&table_of_kinds(&run));
    let kept = |judged: &&&Judged| judged.opens && judged.outcome == Outcome::Kept;
    let instants: Vec<_> = run.iter().filter(kept).filter_map(|judged| judged.instants).collect();
    let _ = write!(
        text,
        "\nOpening relays that keep their tolerance: {} of {} have the right number of openings and closings. The largest error \
         of an instant is {:.0e} ns in the median, below {:.0e} ns for 95 %.\n",
        instants.len(),
        run.iter().filter(kept).count(),
        1e9 * percentile(instants.iter().copied(), 0.5),
        1e9 * percentile(instants.iter().copied(), 0.95),
    );
    let share =
        |is: fn(&Judged) -> bool| 100.0 * run.iter().filter(|judged| is(judged)).count() as f64 / run.len() as f64;
    let _ = write!(
        text,
        "\n`solver.forceError` is above the error for {:.1} % of the relays, and less than 30 times it for {:.0} %. For {:.0} % \
         it announces an error above the tolerance that they do not have. {} of {} relays did not run: they are refused for a \
         physical reason, or need more work at the tightest tolerance than a communication step may take.\n",
        share(|judged| judged.error <= judged.estimate),
        // Errors below 1e-7 of the tolerance are rounding.
        share(|judged| judged.estimate <= 30.0 * judged.error.max(1e-7 * judged.tolerance)),
        share(|judged| judged.error <= judged.tolerance && judged.estimate > judged.tolerance),
        judged.len() - run.len(),
        judged.len(),
    );
    text
}

fn table(run: &[&Judged]) -> String {
    let mut text = "| damping of the first mode | relays | error / tolerance, median | 95 % | above | of these ill-conditioned | above, \
                    not announced |\n|---|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for opens in [false, true] {
        for (least, most) in CLASSES {
            let of_class =
                |judged: &&&Judged| judged.opens == opens && (least..most).contains(&(100.0 * judged.damping));
            let class: Vec<_> = run.iter().filter(of_class).collect();
            let parts = || class.iter().map(|judged| judged.error / judged.tolerance);
            let count = |is: fn(&Judged) -> bool| class.iter().filter(|judged| is(judged)).count();
            let _ = writeln!(
                text,
                "| {}, {least} to {most} % | {} | {:.0e} | {:.0e} | {} | {} | {} |",
                if opens { "opening" } else { "closed" },
                class.len(),
                percentile(parts(), 0.5),
                percentile(parts(), 0.95),
                count(|judged| judged.outcome != Outcome::Kept),
                count(|judged| judged.outcome == Outcome::IllConditioned),
                count(|judged| judged.error > judged.tolerance && judged.estimate <= judged.tolerance),
            );
        }
    }
    text
}

/// Of each kind, how many keep their tolerance, and whether the others say that they do not.
fn table_of_kinds(run: &[&Judged]) -> String {
    let mut text = "\n| kind | relays | kept | above, announced | above, not announced | kept, announced as above |\n\
                    |---|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for (kind, ..) in KINDS {
        let count = |is: fn(&Judged) -> bool| run.iter().filter(|judged| judged.kind == kind && is(judged)).count();
        let _ = writeln!(
            text,
            "| {kind} | {} | {} | {} | {} | {} |",
            count(|_| true),
            count(|judged| judged.error <= judged.tolerance),
            count(|judged| judged.error > judged.tolerance && judged.estimate > judged.tolerance),
            count(|judged| judged.error > judged.tolerance && judged.estimate <= judged.tolerance),
            count(|judged| judged.error <= judged.tolerance && judged.estimate > judged.tolerance),
        );
    }
    text
}

/// The value below which this share of the values lies; NaN if there are none.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an index, saturating"
)]
fn percentile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<_> = values.collect();
    values.sort_by(f64::total_cmp);
    values
        .get((share * values.len() as f64) as usize)
        .copied()
        .unwrap_or(f64::NAN)
}
