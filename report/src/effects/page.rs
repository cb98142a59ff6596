//! What was measured, as `docs/effects.md`.

use std::fmt::Write;

use super::cost::LENGTH;
use super::influence::{CLOSED, Influence, OPENING};
use super::list::{self, MINIMAL};
use super::{Measured, Measurement};
use crate::content::Table;
use crate::markdown::table as markdown_table;
use crate::numbers::two_digits;

/// What each effect costs.
fn costs(Measurement { minimal, effects, .. }: &Measurement) -> Table {
    let mut rows = vec![vec![
        MINIMAL.to_owned(),
        String::new(),
        format!("{minimal:.0}"),
        String::new(),
    ]];
    rows.extend(effects.iter().map(|measured| {
        let Measured { effect, cost, base, .. } = measured;
        let beside = effect
            .beside
            .map_or(String::new(), |name| format!(" (compared with {name})"));
        vec![
            format!("{}{beside}", effect.name),
            list::code(effect.setting),
            format!("{cost:.0}"),
            format!("{:+.1} %", 100.0 * (cost / base - 1.0)),
        ]
    }));
    Table::new("", &["effect", "setting", "instructions per ms", "added"], rows)
}

/// What each effect changes in the scenes.
fn influences(measurement: &Measurement) -> Table {
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
    Table::new("", &columns, measurement.effects.iter().filter_map(row).collect())
}

/// `docs/effects.md`.
pub fn page(measurement: &Measurement) -> String {
    let matters = measurement.effects.iter().fold(String::new(), |mut list, measured| {
        let _ = writeln!(list, "- **{}**: {}", measured.effect.name, measured.effect.matters);
        list
    });
    let tables = [costs(measurement), influences(measurement)].map(|table| markdown_table(&table));
    format!(
        "<!-- Written by cargo xtask effects. -->\n\n# Cost and influence of each effect\n\n    cargo xtask effects\n\n\
         runs `scenes/minimal.toml`, in which every effect is off that can be, and adds each effect alone. The run is {} ms long in \
         communication steps of 10 µs; after each, the contact force and the outputs of the effect are read. Instructions are counted by \
         valgrind's callgrind, as they do not depend on what else the machine does, in a build for any processor; vector instructions of \
         newer ones save more where many numbers are alike: random excitation then adds half as much.\n\n\
         Instructions per simulated millisecond:\n\n{}\n\n\
         ## When each matters\n\n{matters}\n\
         Each effect on and off in three scenes: the largest difference of contact force and resistance at a communication point; \
         in the scene in which the contact opens, the time without contact force:\n\n{}\n",
        LENGTH * 1e3,
        tables[0],
        tables[1],
    )
}
