//! Other integrators on the same equations, measured by the package `benches`.

use anyhow::{Context, Result};
use serde::Deserialize;

use super::study::measurement;
use crate::programs::{self, root};

use super::{digits, seconds};
use crate::content::{Axis, Block, Curve, Figure, Style, Table};

/// Errors at which times are compared.
const LEVELS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// Scenes of the package, and the anchors of their figures.
const SCENES: [(&str, &str); 3] = [
    ("paper", "peers-paper"),
    ("chatter", "peers-chatter"),
    ("closing bounce", "peers-bounce"),
];

/// A line of `accuracy.csv`.
#[derive(Deserialize)]
struct Row {
    part: String,
    scene: String,
    integrator: String,
    seconds_per_second: Option<f64>,
    force_error: Option<f64>,
}

/// The comparison: run now, or, quickly, what was measured before.
pub fn blocks(quick: bool) -> Result<Vec<Block>> {
    let folder = if quick { "docs" } else { "out/accuracy" };
    if !quick {
        programs::output(measurement().args(["--folder", folder, "--turns", "1"]))?;
    }
    let rows = read(folder)?;
    let source = if quick {
        "**These figures were not measured in this run** but by `cargo xtask accuracy` at another time (`docs/accuracy.csv`)."
    } else {
        "Measured in this run, each setting once."
    };
    let mut blocks = vec![Block::Text(format!(
        "### Beside other integrators\n\n{source} All work on the same modes, and on the same scenes as above but for details in \
         `docs/accuracy.md`; errors are against Radau IIA of order 9. Each cell: processor time per simulated second of the \
         cheapest run whose error is at most that of the column, and how many times the component's."
    ))];
    blocks.extend(SCENES.iter().map(|(scene, _)| Block::Table(table(&rows, scene))));
    blocks.extend(SCENES.iter().map(|(scene, id)| Block::Figure(figure(&rows, scene, id))));
    Ok(blocks)
}

fn read(folder: &str) -> Result<Vec<Row>> {
    let path = root().join(folder).join("accuracy.csv");
    let mut reader = csv::Reader::from_path(&path).with_context(|| path.display().to_string())?;
    let rows: Vec<Row> = reader.deserialize().collect::<Result<_, _>>()?;
    Ok(rows.into_iter().filter(|row| row.part == "peers").collect())
}

/// Error and time of the runs of an integrator.
type Runs = Vec<(f64, f64)>;

/// Integrators of a scene in the order in which they come, the component first, with error and time of their runs.
fn integrators<'a>(rows: &'a [Row], scene: &str) -> Vec<(&'a str, Runs)> {
    let mut found: Vec<(&str, Runs)> = Vec::new();
    for row in rows.iter().filter(|row| row.scene == scene) {
        let (Some(error), Some(time)) = (row.force_error, row.seconds_per_second) else {
            continue;
        };
        match found.iter_mut().find(|(name, _)| *name == row.integrator) {
            Some((_, runs)) => runs.push((error, time)),
            None => found.push((&row.integrator, vec![(error, time)])),
        }
    }
    found
}

fn cheapest(runs: &[(f64, f64)], level: f64) -> Option<f64> {
    let enough = runs.iter().filter(|(error, _)| *error <= level);
    enough.map(|(_, time)| *time).min_by(f64::total_cmp)
}

fn table(rows: &[Row], scene: &str) -> Table {
    let integrators = integrators(rows, scene);
    let own = integrators.first().map(|(_, runs)| runs.clone()).unwrap_or_default();
    let mut columns = vec!["integrator".to_owned()];
    columns.extend(LEVELS.map(|level| format!("error {level:.0e}")));
    let row = |(index, (name, runs)): (usize, &(&str, Runs))| {
        let cell = |level: f64| match (cheapest(runs, level), cheapest(&own, level)) {
            (None, _) => "—".to_owned(),
            (Some(time), Some(least)) if index > 0 => format!("{} ({}×)", seconds(time), digits(time / least)),
            (Some(time), _) => seconds(time),
        };
        let mut cells = vec![(*name).to_owned()];
        cells.extend(LEVELS.map(cell));
        cells
    };
    Table {
        caption: format!(
            "Scene *{scene}*: time per simulated second at equal error of the contact force, of the preload force; —: not reached."
        ),
        columns,
        rows: integrators.iter().enumerate().map(row).collect(),
    }
}

fn figure(rows: &[Row], scene: &str, id: &'static str) -> Figure {
    let curve = |((name, runs), colour): (&(&str, Runs), usize)| Curve {
        name: (*name).to_owned(),
        x: runs.iter().map(|(_, time)| *time).collect(),
        y: runs.iter().map(|(error, _)| *error).collect(),
        style: Style::LineAndMarkers,
        colour,
    };
    Figure {
        id,
        title: format!("Beside others: {scene}"),
        x: Axis {
            label: "time per simulated second",
            unit: "s",
            logarithmic: true,
        },
        y: super::error_axis(),
        curves: integrators(rows, scene).iter().zip(0..).map(curve).collect(),
        caption: "Left and down is better.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measurements_of_the_project_give_every_table() -> Result<()> {
        let rows = read("docs")?;
        for (scene, _) in SCENES {
            let table = table(&rows, scene);
            let first = table.rows.first().and_then(|row| row.first().cloned());
            assert_eq!(first.as_deref(), Some("relay-contact"), "{scene}");
            assert!(table.rows.len() >= 4 && table.rows.iter().all(|row| row.len() == table.columns.len()));
        }
        Ok(())
    }
}
