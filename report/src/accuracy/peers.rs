//! Other integrators on the same equations, measured by the package `benches`.

use anyhow::{Context, Result};

use super::curves::{ERROR, TIME};
use super::rows::Row;
use crate::content::{Block, Curve, Figure, Style, Table};
use crate::numbers::{seconds_roughly, two_digits};

/// Errors at which times are compared.
const LEVELS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// Scenes of the package, and the anchors of their figures.
const SCENES: [(&str, &str); 3] = [
    ("paper", "peers-paper"),
    ("chatter", "peers-chatter"),
    ("closing bounce", "peers-bounce"),
];

/// The comparison.
pub fn blocks(rows: &[Row]) -> Result<Vec<Block>> {
    let text = "### Other integrators\n\nAll work on the same modes, in the same scenes. Each cell: processor time per simulated second \
                of the cheapest run whose error is at most that of the column, and in brackets how many times that of \
                relay-contact.";
    let mut blocks = vec![Block::Text(text.to_owned())];
    for (scene, _) in SCENES {
        blocks.push(Block::Table(table(rows, scene)?));
    }
    blocks.extend(SCENES.iter().map(|(scene, id)| Block::Figure(figure(rows, scene, id))));
    Ok(blocks)
}

/// Error and time of the runs of an integrator.
type Runs = Vec<(f64, f64)>;

/// Integrators of a scene in the order in which they come, the component first, with error and time of their runs.
fn integrators<'a>(rows: &'a [Row], scene: &str) -> Vec<(&'a str, Runs)> {
    let mut found: Vec<(&str, Runs)> = Vec::new();
    for row in rows.iter().filter(|row| row.part == "peers" && row.scene == scene) {
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

fn table(rows: &[Row], scene: &str) -> Result<Table> {
    let integrators = integrators(rows, scene);
    let (_, own) = integrators.first().with_context(|| format!("{scene}: not measured"))?;
    let mut columns = vec!["integrator".to_owned()];
    columns.extend(LEVELS.map(|level| format!("error {level:.0e}")));
    let row = |(index, (name, runs)): (usize, &(&str, Runs))| {
        let cell = |level: f64| match (cheapest(runs, level), cheapest(own, level)) {
            (None, _) => "—".to_owned(),
            (Some(time), Some(least)) if index > 0 => {
                format!("{} ({}×)", seconds_roughly(time), two_digits(time / least))
            }
            (Some(time), _) => seconds_roughly(time),
        };
        let mut cells = vec![(*name).to_owned()];
        cells.extend(LEVELS.map(cell));
        cells
    };
    let caption = format!(
        "Scene *{scene}*: computing time per simulated second at equal error of the contact force; —: not reached."
    );
    Ok(Table::new(
        &caption,
        &columns,
        integrators.iter().enumerate().map(row).collect(),
    ))
}

fn figure(rows: &[Row], scene: &str, id: &'static str) -> Figure {
    let curve = |((name, runs), colour): (&(&str, Runs), usize)| {
        let points = runs.iter().map(|(error, time)| (*time, *error));
        Curve::new(name, points, Style::LineAndMarkers, colour)
    };
    Figure {
        id,
        title: format!("Other integrators: scene {scene}"),
        x: TIME,
        y: ERROR,
        curves: integrators(rows, scene).iter().zip(0..).map(curve).collect(),
        caption: "Left and down is better.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measurements_of_the_project_give_every_table() -> Result<()> {
        let (rows, _) = super::super::rows::read("docs")?;
        for (scene, _) in SCENES {
            let table = table(&rows, scene)?;
            let first = table.rows.first().and_then(|row| row.first().cloned());
            assert_eq!(first.as_deref(), Some("relay-contact"), "{scene}");
            assert!(table.rows.len() >= 4 && table.rows.iter().all(|row| row.len() == table.columns.len()));
        }
        Ok(())
    }
}
