//! Computing time against accuracy: `docs/accuracy.md` with its figures, of what the package `benches` measured.
//!
//! [`rows`]: the measurements;   [`figures`]: their figures;   [`study`]: starts the measurement.

mod figures;
mod rows;
pub mod study;

use std::fs;

use anyhow::{Context, Result};
use commands::root;

use self::figures::SCENES;
use self::rows::{Row, of};
use crate::content::{Arguments, Block, Section};
use crate::markdown;

/// Between these `benches` writes its tables into the page.
const TABLES: (&str, &str) = (
    "<!-- tables: written by cargo xtask accuracy -->",
    "<!-- end of tables -->",
);

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let folder = if arguments.peers { "out/accuracy" } else { "docs" };
    if arguments.peers {
        commands::output(study::measurement().args(["--folder", folder, "--turns", "1"]))?;
    }
    let rows = rows::read(folder)?;
    let measured = if arguments.peers {
        "Measured for this page, each setting once."
    } else {
        "Not measured for this page but by the last `cargo xtask accuracy` (machine and date are with the tables below); \
         `cargo xtask report --peers` measures anew."
    };
    let verdict = verdict(&rows);
    let mut blocks = vec![Block::Text(format!("**{verdict}.** {measured}"))];
    blocks.extend(markdown::blocks(
        &page(folder)?,
        &figures::figures(&rows, &rows::relays()?),
    ));
    Ok(vec![Section {
        id: "accuracy",
        title: "Accuracy and cost",
        lead: format!("{verdict}."),
        blocks,
    }])
}

/// `docs/accuracy.md` with the tables of a folder.
fn page(folder: &str) -> Result<String> {
    let read = |folder| {
        let path = root().join(folder).join("accuracy.md");
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let parts = text.split_once(TABLES.0).and_then(|(before, rest)| {
            let (tables, after) = rest.split_once(TABLES.1)?;
            Some([before, tables, after].map(str::to_owned))
        });
        parts.with_context(|| format!("{} without tables", path.display()))
    };
    let ([before, _, after], [_, tables, _]) = (read("docs")?, read(folder)?);
    Ok([before.as_str(), TABLES.0, &tables, TABLES.1, &after].concat())
}

/// Down to which tolerance the error of the contact force stays below it, as in the figure.
fn verdict(rows: &[Row]) -> String {
    let all = SCENES.iter().flat_map(|scene| of(rows, "delivered", scene));
    let part = |row: &Row| row.force_error.unwrap_or(f64::INFINITY) / row.value;
    let (kept, above): (Vec<_>, Vec<_>) = all.partition(|row| part(row) <= 1.0);
    // Where one scene is above, that tolerance is not kept.
    let limit = above.iter().map(|row| row.value).fold(0.0, f64::max);
    let kept: Vec<_> = kept.into_iter().filter(|row| row.value > limit).collect();
    let [largest, smallest] = [f64::max, f64::min].map(|of| kept.iter().map(|row| row.value).reduce(of));
    let worst = kept.iter().map(|row| part(row)).fold(0.0, f64::max);
    let kept = format!(
        "From tolerances of {:.0e} to {:.0e} the error of the contact force is at most {:.0} % of `solver.tolerance`",
        largest.unwrap_or(f64::NAN),
        smallest.unwrap_or(f64::NAN),
        100.0 * worst
    );
    if above.is_empty() {
        return kept;
    }
    let highest = above
        .iter()
        .map(|row| row.force_error.unwrap_or(f64::INFINITY))
        .fold(0.0, f64::max);
    format!("{kept}; from {limit:.0e} on rounding shows, and it is up to {highest:.0e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of `docs/accuracy.md`: a question, its tolerance, a scene in which it is asked, and the error it allows.
    type Question = (&'static str, f64, &'static str, fn(&Row) -> Option<f64>, f64);

    #[test]
    fn the_advice_on_the_tolerance_answers_its_questions() -> Result<()> {
        let force = |row: &Row| row.force_error;
        // An opening's length is wrong by at most both of its instants.
        let duration = |row: &Row| row.event_error_us.map(|error| 2.0 * error);
        let questions: [Question; 3] = [
            ("contact resistance", 1e-3, "paper", force, 7e-3),
            ("Does the contact open", 1e-2, "chatter", duration, 1.0),
            ("impact force", 1e-3, "closing bounce", force, 1e-2),
        ];
        let (rows, page) = (rows::read("docs")?, page("docs")?);
        for (words, tolerance, scene, error, allowed) in questions {
            let line = page.lines().find(|line| line.starts_with('|') && line.contains(words));
            let cell = line.and_then(|line| line.split('|').nth(2)).context(words)?;
            assert_eq!(cell.trim().parse::<f64>()?, tolerance, "{words}");
            // Smaller tolerances answer it too.
            for row in of(&rows, "delivered", scene).filter(|row| row.value <= tolerance) {
                assert!(
                    error(row).is_some_and(|error| error <= allowed),
                    "{words}: {}",
                    row.value
                );
            }
        }
        Ok(())
    }

    #[test]
    fn every_figure_is_drawn_and_shown_by_the_page() -> Result<()> {
        let (figures, page) = (figures::figures(&rows::read("docs")?, &rows::relays()?), page("docs")?);
        for figure in &figures {
            assert!(page.contains(&format!("](report/{}.png)", figure.id)), "{}", figure.id);
            assert!(figure.curves.iter().all(|curve| !curve.x.is_empty()), "{}", figure.id);
            let points = figure.curves[0].y.len();
            match figure.id {
                "accuracy-modes" => assert_eq!(points, 27),
                "accuracy-promise" => assert!(points > 500, "{points} closed relays"),
                "accuracy-tolerance" => assert_eq!(points, 11),
                // The component, and what it is compared with.
                id => assert!(points >= 5 && figure.curves.len() >= 4, "{id}"),
            }
        }
        let shown = markdown::blocks(&page, &figures);
        assert_eq!(
            shown.iter().filter(|block| matches!(block, Block::Figure(_))).count(),
            figures.len()
        );
        Ok(())
    }
}
