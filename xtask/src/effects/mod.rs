//! What each effect costs and changes: `docs/effects.md`.
//!
//! [`list`]: the effects;   [`cost`]: instructions and time of the minimal scene with each;   [`influence`]: what each changes
//! in the scenes.

mod cost;
mod influence;
mod list;

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};

use self::cost::{Cost, Counter, Runner};
use self::influence::{CLOSED, OPENING, influence};
use self::list::{EFFECTS, Effect, MINIMAL};
use crate::valgrind;

/// Instructions that everything that is off may cost, of those of a build that does not have it.
const ALLOWED: f64 = 0.01;

/// Where to write.
#[derive(clap::Args)]
pub struct Arguments {
    /// The page to write
    #[arg(long, default_value = "docs/effects.md")]
    page: PathBuf,
    /// Only check that what is off costs nothing
    #[arg(long)]
    off: bool,
}

/// Measures and writes the page.
pub fn run(arguments: &Arguments) -> Result<()> {
    if arguments.off {
        return what_is_off();
    }
    let counter = if valgrind::is_installed() {
        Some(Counter::build()?)
    } else {
        eprintln!(
            "{}, so instructions are not counted: nanoseconds alone",
            valgrind::MISSING
        );
        None
    };
    let runner = Runner::build(counter.as_ref())?;
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new(EFFECTS.len() as u64 + 1).with_style(style);
    let minimal = runner.cost(&[])?;
    progress.inc(1);
    let mut table = String::from(
        "| effect | setting | instructions per ms | added | ns per ms | added |\n|---|---|---:|---:|---:|---:|\n",
    );
    let _ = writeln!(
        table,
        "| {MINIMAL} | | {} | | {:.0} | |",
        instructions(minimal.instructions),
        minimal.nanoseconds
    );
    let mut changed = changes_head();
    let mut sentences = String::new();
    let mut costs: Vec<(&Effect, Cost)> = Vec::new();
    for effect in EFFECTS {
        progress.set_message(effect.name);
        let cost = runner.cost(&list::changes(effect))?;
        let base = match effect.beside {
            Some(name) => {
                let base = costs.iter().find(|(known, _)| known.name == name);
                base.context("an effect beside one that comes later")?.1
            }
            None => minimal,
        };
        let _ = writeln!(table, "{}", row(effect, &cost, &base));
        let _ = writeln!(sentences, "- **{}**: {}", effect.name, effect.matters);
        if !effect.off.is_empty() {
            let cells = influence(effect)?;
            let _ = writeln!(changed, "| {} | {} | {cells} |", effect.name, list::code(effect.off));
        }
        costs.push((effect, cost));
        progress.inc(1);
    }
    progress.finish_and_clear();
    let off = counter.as_ref().map_or(Ok("Not measured.".to_owned()), off)?;
    fs::write(&arguments.page, page(&table, &sentences, &changed, &off))
        .with_context(|| format!("cannot write {}", arguments.page.display()))?;
    print!("{table}\n{off}\n");
    println!("{}", arguments.page.display());
    Ok(())
}

/// Checks what the effects that are off cost, and tells.
pub fn what_is_off() -> Result<()> {
    if !valgrind::is_installed() {
        bail!(valgrind::MISSING);
    }
    println!("{}", off(&Counter::build()?)?);
    Ok(())
}

/// What the effects that are off cost, as a sentence; an error where it is too much.
fn off(counter: &Counter) -> Result<String> {
    let mut text = String::from(
        "The component can be built without contact damping, chatter, extremes, energy balance, the axial force from the \
         deflection and all excitations but the sine (feature `bare`). Instructions per millisecond of the minimal scene in \
         the usual build, and in that one; `cargo xtask test` fails where it is more than 1 %:\n",
    );
    for (name, amplitude) in [("closed contact, 98 m/s²", "98"), ("opening contact, 400 m/s²", "400")] {
        let changes = [("excitation.amplitude".to_owned(), amplitude.to_owned())];
        let (with, without) = counter.both(&changes)?;
        let more = with / without - 1.0;
        let _ = write!(text, "\n- {name}: {with:.0} and {without:.0}, {:+.2} %", 100.0 * more);
        if more > ALLOWED {
            bail!("effects that are off cost more than {} %\n{text}", 100.0 * ALLOWED);
        }
    }
    Ok(text)
}

fn row(effect: &Effect, cost: &Cost, base: &Cost) -> String {
    let added = |now: f64, before: f64| format!("{:+.1} %", 100.0 * (now / before - 1.0));
    let counted = match (cost.instructions, base.instructions) {
        (Some(now), Some(before)) => added(now, before),
        _ => String::new(),
    };
    let beside = effect.beside.map_or(String::new(), |name| format!(", beside {name}"));
    format!(
        "| {}{beside} | {} | {} | {counted} | {:.0} | {} |",
        effect.name,
        list::code(effect.setting),
        instructions(cost.instructions),
        cost.nanoseconds,
        added(cost.nanoseconds, base.nanoseconds),
    )
}

fn instructions(count: Option<f64>) -> String {
    count.map_or("not counted".to_owned(), |count| format!("{count:.0}"))
}

/// Head of the table of what the effects change in the scenes.
fn changes_head() -> String {
    let mut head = String::from("| effect | against |");
    for name in CLOSED {
        let _ = write!(head, " *{name}*: force, mN | resistance, mΩ |");
    }
    let _ = write!(head, " *{OPENING}*: open without it, ms | with it |");
    head.push_str("\n|---|---|");
    head.push_str(&"---:|".repeat(2 * CLOSED.len() + 2));
    head.push('\n');
    head
}

fn page(table: &str, sentences: &str, changed: &str, off: &str) -> String {
    format!(
        "<!-- Written by cargo xtask effects. -->\n# What each effect costs and changes\n\n    cargo xtask effects\n\n\
         runs [`scenes/minimal.toml`](../scenes/minimal.toml), in which everything is off that can be, and adds each effect \
         alone. The run is {} ms long in communication steps of 10 µs; after each, the contact force is read, and what the \
         effect is for. Instructions are counted by valgrind's callgrind in a build for any processor, nanoseconds taken on \
         this machine in the usual build, the shortest of {} runs.\n\n{table}\n\
         ## When each matters\n\n{sentences}\n\
         Each on against off in three scenes: the largest difference of contact force and resistance at a communication \
         point, and where the contact opens, the time without force.\n\n{changed}\n\
         ## What is off costs nothing\n\n{off}\n",
        cost::LENGTH * 1e3,
        cost::RUNS,
    )
}
