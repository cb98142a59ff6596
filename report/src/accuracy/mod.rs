//! Computing time against accuracy, as measured by the package `benches`.
//!
//! [`rows`]: its measurements;   [`delivered`]: the component at each tolerance;   [`peers`]: other integrators on the same
//! equations;   [`study`]: starts the measurement.

mod curves;
mod delivered;
mod peers;
mod rows;
pub mod study;

use anyhow::Result;

use crate::content::{Arguments, Block, Section};

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let folder = if arguments.peers { "out/accuracy" } else { "docs" };
    if arguments.peers {
        commands::output(study::measurement().args(["--folder", folder, "--turns", "1"]))?;
    }
    let (rows, machine) = rows::read(folder)?;
    let source = if arguments.peers {
        format!("Measured for this page, each setting once. {machine}")
    } else {
        format!(
            "**Not measured for this page** but by the last `cargo xtask accuracy` (`docs/accuracy.csv`); `cargo xtask report \
             --peers` measures anew. {machine}"
        )
    };
    let verdict = delivered::verdict(&rows);
    let mut blocks = delivered::blocks(&rows, &verdict, &source);
    blocks.extend(peers::blocks(&rows)?);
    Ok(vec![Section {
        id: "accuracy",
        title: "Computing time and accuracy",
        lead: format!("{verdict}."),
        blocks: blocks.into_iter().collect::<Vec<Block>>(),
    }])
}
