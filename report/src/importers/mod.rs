//! What other people's importers did with the packaged component.

pub mod reference;
mod rows;

use std::fmt::Write;

use anyhow::Result;

use self::rows::Row;
pub use self::rows::table as print;
use crate::content::{Arguments, Block, Section, Table};

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
            "{passed} of {} tasks in importers of others pass; their contact force differs from that of the Rust library by {worst} N at \
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
        title: "Other people's importers",
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
        vec![
            row.importer.clone(),
            row.version.clone(),
            row.task.clone(),
            row.result.clone(),
            row.difference(),
        ]
    };
    Table {
        caption: "The versions are those of the Python packages or the crate.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: rows.iter().map(row).collect(),
    }
}
