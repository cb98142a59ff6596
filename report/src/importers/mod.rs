//! The packaged component in importers of others.

pub mod reference;
mod rows;

use std::fmt::Write;

use anyhow::{Result, bail};

use self::rows::Row;
use crate::content::{Arguments, Block, Section, Table};
use crate::markdown;

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let (rows, missing) = rows::rows()?;
    let mut text = String::from(
        "`RelayContact.fmu` in simulation programs of others. *run*: 500 steps with an opening contact and forces up to newtons; *two \
         coupled* and *SSP*: the tip of one contact moves the fixed contact of a second; *scenes*: all files of `scenes/`. The \
         difference is the largest from the same run by the Rust library. `docs/importers.md` says what each importer needs.",
    );
    let when = if rows.is_empty() {
        "**Not run**: `cargo xtask importers` runs them all.".to_owned()
    } else if arguments.quick {
        let age = rows::prepared()?.elapsed().unwrap_or_default().as_secs() / 60;
        format!(
            "Not run for this page: the rows are those of the last `cargo xtask importers`, `test` or `report`, {} h {} min \
             earlier.",
            age / 60,
            age % 60
        )
    } else {
        "Run for this page.".to_owned()
    };
    text = format!("{text}\n\n{when}");
    if !rows.is_empty() && !missing.is_empty() {
        let _ = write!(
            text,
            " Not among them: {} (`cargo xtask importers`).",
            missing.join(", ")
        );
    }
    let passed = rows.iter().filter(|row| row.result == "passed").count();
    let worst = rows.iter().filter_map(|row| row.difference).fold(0.0, f64::max);
    let lead = if rows.is_empty() {
        String::new()
    } else {
        format!(
            "{passed} of {} tasks in other people's importers passed; their contact force differs from that of the Rust library by {worst} N at \
             most.",
            rows.len()
        )
    };
    let mut blocks = vec![Block::Text(text)];
    if !rows.is_empty() {
        blocks.push(Block::Table(table(&rows)));
    }
    Ok(vec![Section {
        id: "importers",
        title: "Importers",
        lead,
        blocks,
    }])
}

fn table(rows: &[Row]) -> Table {
    let columns = [
        "importer",
        "version",
        "task",
        "result",
        "largest difference in contact force",
    ];
    let row = |row: &Row| {
        let difference = match row.difference {
            Some(0.0) => "0 N".to_owned(),
            Some(force) => format!("{force:.1e} N"),
            None => "–".to_owned(),
        };
        let texts = [&row.importer, &row.version, &row.task, &row.result, &difference];
        texts.map(Clone::clone).to_vec()
    };
    let caption = "The versions are those of the Python packages or the crate.";
    Table::new(caption, &columns, rows.iter().map(row).collect())
}

/// Prints the table. An error where a row is missing; a warning below the table where an importer did not run.
pub fn print() -> Result<()> {
    let (rows, missing) = rows::rows()?;
    println!("{}", markdown::table(&table(&rows)));
    for row in rows.iter().filter(|row| row.result != "passed") {
        println!("WARNING: {}, {}: {}", row.importer, row.task, row.result);
    }
    if !missing.is_empty() {
        bail!("no result of {}", missing.join(", "));
    }
    Ok(())
}
