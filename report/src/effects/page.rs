//! What was measured, as tables, and `docs/effects.md` made of them.

use std::fmt::Write;

use super::cost::{Cost, LENGTH};
use super::influence::{CLOSED, Influence, OPENING};
use super::list::{self, MINIMAL};
use super::{Measured, Measurement};
use crate::content::Table;
use crate::markdown::table as markdown_table;
use crate::numbers::two_digits;

/// What each effect costs.
pub fn costs(measurement: &Measurement) -> Table {
    let Measurement { minimal, effects, .. } = measurement;
    let mut rows = vec![vec![
        MINIMAL.to_owned(),
        String::new(),
        instructions(minimal),
        String::new(),
        format!("{:.0}", minimal.nanoseconds),
        String::new(),
    ]];
    rows.extend(effects.iter().map(cost));
    let columns = [
        "effect",
        "setting",
        "instructions per ms",
        "added",
        "nanoseconds per ms",
        "added",
    ];
    Table {
        caption: format!(
            "Per simulated millisecond of a run of {} ms in communication steps of 10 µs, each effect added alone to the minimal \
             scene, in which every effect is off that can be.",
            LENGTH * 1e3
        ),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
    }
}

fn cost(measured: &Measured) -> Vec<String> {
    let Measured { effect, cost, base, .. } = measured;
    let added = |now: f64, before: f64| format!("{:+.1} %", 100.0 * (now / before - 1.0));
    let counted = match (cost.instructions, base.instructions) {
        (Some(now), Some(before)) => added(now, before),
        _ => String::new(),
    };
    let beside = effect
        .beside
        .map_or(String::new(), |name| format!(" (compared with {name})"));
    vec![
        format!("{}{beside}", effect.name),
        list::code(effect.setting),
        instructions(cost),
        counted,
        format!("{:.0}", cost.nanoseconds),
        added(cost.nanoseconds, base.nanoseconds),
    ]
}

fn instructions(cost: &Cost) -> String {
    cost.instructions
        .map_or("not counted".to_owned(), |count| format!("{count:.0}"))
}

/// What each effect changes in the scenes; none where that was not looked at.
pub fn influences(measurement: &Measurement) -> Option<Table> {
    let mut columns = vec!["effect".to_owned(), "compared with".to_owned()];
    for name in CLOSED {
        columns.push(format!("*{name}*: change of force, mN"));
        columns.push("change of resistance, mΩ".to_owned());
    }
    columns.push(format!("*{OPENING}*: time open without the effect, ms"));
    columns.push("with the effect, ms".to_owned());
    let row = |measured: &Measured| {
        let Influence { closed, open } = measured.influence.as_ref()?;
        let mut row = vec![measured.effect.name.to_owned(), list::code(measured.effect.off)];
        row.extend(closed.iter().flatten().map(|difference| two_digits(1e3 * difference)));
        row.extend(open.iter().map(|time| format!("{:.3}", 1e3 * time)));
        Some(row)
    };
    let rows: Vec<_> = measurement.effects.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| Table {
        caption: "Each effect on and off in three scenes: the largest difference of contact force and resistance at a communication \
                  point; in the scene in which the contact opens, the time without contact force."
            .to_owned(),
        columns,
        rows,
    })
}

/// When each matters, a list.
pub fn when(measurement: &Measurement) -> String {
    measurement.effects.iter().fold(String::new(), |mut list, measured| {
        let _ = writeln!(list, "- **{}**: {}", measured.effect.name, measured.effect.matters);
        list
    })
}

/// What instructions and times are, as a sentence.
pub fn how(measurement: &Measurement) -> String {
    let counted = if measurement.minimal.instructions.is_some() {
        "Instructions are counted by valgrind in a build for any processor"
    } else {
        "Instructions were not counted in this run (the quick report leaves them out; they need valgrind)"
    };
    format!(
        "{counted}; nanoseconds are those of this machine, the shortest of {} runs.",
        runs(measurement)
    )
}

/// How often each was timed.
fn runs(measurement: &Measurement) -> usize {
    measurement.extent.runs
}

/// `docs/effects.md`.
pub fn page(measurement: &Measurement) -> String {
    let (table, sentences) = (markdown_table(&costs(measurement)), when(measurement));
    let changes = influences(measurement);
    let caption = changes.as_ref().map_or("", |table| &table.caption);
    let changed = changes.as_ref().map_or(String::new(), markdown_table);
    format!(
        "<!-- Written by cargo xtask effects. -->\n# Cost and influence of each effect\n\n    cargo xtask effects\n\n\
         runs [`scenes/minimal.toml`](../scenes/minimal.toml), in which every effect is off that can be, and adds each effect \
         alone. The run is {} ms long in communication steps of 10 µs; after each, the contact force and the outputs \
         of the effect are read. Instructions are counted by valgrind's callgrind in a build for any processor, nanoseconds taken on \
         this machine in the usual build, the shortest of {} runs.\n\n{table}\n\n\
         ## When each matters\n\n{sentences}\n\
         {caption}\n\n{changed}\n",
        LENGTH * 1e3,
        runs(measurement),
    )
}
