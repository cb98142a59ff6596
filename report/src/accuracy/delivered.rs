//! The component at each tolerance, with the number of modes it chooses itself.

use super::curves::{ERROR, TIME};
use super::rows::Row;
use crate::content::{Axis, Block, Curve, Figure, Style, Table};
use crate::numbers::seconds_roughly;

const SCENES: [&str; 3] = ["paper", "chatter", "closing bounce"];

/// Smaller tolerances are not judged: rounding shows.
const SMALLEST: f64 = 0.99e-10;

/// Rows of a scene, from the largest tolerance to the smallest.
fn scene<'a>(rows: &'a [Row], name: &'a str) -> impl Iterator<Item = &'a Row> {
    let is_one = move |row: &&Row| row.part == "delivered" && row.scene == name && row.value > SMALLEST;
    rows.iter().filter(is_one)
}

/// Whether the errors stay below the tolerances, as far as the reference can tell.
pub fn verdict(rows: &[Row]) -> String {
    let all = SCENES.into_iter().flat_map(|name| scene(rows, name));
    let judged = all.filter(|row| row.value > 5.0 * row.reference_force_error);
    let parts = judged.map(|row| row.force_error.unwrap_or(f64::INFINITY) / row.value);
    let worst = parts.fold(0.0, f64::max);
    if worst <= 1.0 {
        format!(
            "The error of the contact force stays below `solver.tolerance`; it is {:.1} % of it at most",
            100.0 * worst
        )
    } else {
        format!("The error of the contact force exceeds `solver.tolerance`, by up to {worst:.1} times")
    }
}

/// Text, figures and tables.
pub fn blocks(rows: &[Row], verdict: &str, source: &str) -> Vec<Block> {
    let text = format!(
        "`solver.tolerance` is the error allowed in the contact force, relative to the preload force. **{verdict}**, in the three \
         scenes below and from 1e-1 to 1e-10, except for tolerances of less than five times the reference's own error. The error \
         is the largest at a communication point, against an independent integrator, Radau IIA of order 9, with more modes. \
         Times are processor times of one core. `docs/accuracy.md` describes the scenes. {source}"
    );
    vec![
        Block::Text(text),
        Block::Figure(asked(rows)),
        Block::Figure(cost(rows)),
        Block::Table(table(rows)),
        Block::Table(questions(rows)),
    ]
}

fn curves(rows: &[Row], x: fn(&Row) -> Option<f64>) -> Vec<Curve> {
    let curve = |(name, colour): (&'static str, usize)| {
        let points = scene(rows, name).filter_map(|row| Some((x(row)?, row.force_error?)));
        Curve::new(name, points, Style::LineAndMarkers, colour)
    };
    SCENES.into_iter().zip(0..).map(curve).collect()
}

fn asked(rows: &[Row]) -> Figure {
    let mut curves = curves(rows, |row| Some(row.value));
    let tolerances = scene(rows, SCENES[0]).map(|row| (row.value, row.value));
    curves.push(Curve::new("error = tolerance", tolerances, Style::Dashed, curves.len()));
    Figure {
        id: "accuracy-asked",
        title: "Error against tolerance".to_owned(),
        x: Axis::logarithmic("solver.tolerance", ""),
        y: ERROR,
        curves,
        caption: "Below the dashed line the error is smaller than the tolerance.".to_owned(),
    }
}

fn cost(rows: &[Row]) -> Figure {
    Figure {
        id: "accuracy-cost",
        title: "Error over computing time".to_owned(),
        x: TIME,
        y: ERROR,
        curves: curves(rows, |row| row.seconds_per_second),
        caption: "Left and down is better. Each point is a tolerance.".to_owned(),
    }
}

fn error(error: Option<f64>) -> String {
    error.map_or("failed".to_owned(), |error| format!("{error:.0e}"))
}

fn time(row: &Row) -> String {
    row.seconds_per_second.map_or(String::new(), seconds_roughly)
}

fn table(rows: &[Row]) -> Table {
    let mut columns = vec!["tolerance".to_owned(), "modes".to_owned()];
    for name in SCENES {
        columns.extend([format!("*{name}*: error"), "time per simulated second".to_owned()]);
    }
    let row = |first: &Row| {
        let mut cells = vec![format!("{:.0e}", first.value), first.modes.to_string()];
        for name in SCENES {
            let found = scene(rows, name).find(|row| row.value == first.value);
            cells.extend(found.map_or([String::new(), String::new()], |row| {
                [error(row.force_error), time(row)]
            }));
        }
        cells
    };
    let rows = scene(rows, SCENES[0]).map(row).collect();
    Table::new(
        "Error of the contact force relative to the preload, and computing time, at each tolerance.",
        &columns,
        rows,
    )
}

/// A question, where it is asked, and what has to be small for it.
struct Question {
    text: &'static str,
    scene: &'static str,
    error: fn(&Row) -> Option<f64>,
    /// What the error is, and its unit.
    quantity: (&'static str, &'static str),
    allowed: f64,
}

const FORCE: (&str, &str) = ("force, relative to the preload", "");
const INSTANTS: (&str, &str) = ("instants", "µs");

const QUESTIONS: [Question; 4] = [
    Question {
        // The resistance goes with the force to the power -0.95, and the force falls to two thirds of the preload.
        text: "Is the contact resistance right within 1 %?",
        scene: "paper",
        error: |row| row.force_error,
        quantity: FORCE,
        allowed: 7e-3,
    },
    Question {
        text: "Does the contact open, and when, within 1 µs?",
        scene: "chatter",
        error: |row| row.event_error_us,
        quantity: INSTANTS,
        allowed: 1.0,
    },
    Question {
        text: "What is the force of the impact at closing, within 1 % of the preload?",
        scene: "closing bounce",
        error: |row| row.force_error,
        quantity: FORCE,
        allowed: 0.01,
    },
    Question {
        text: "Openings and closings within 1 ns, as a reference for other programs?",
        scene: "chatter",
        error: |row| row.event_error_us,
        quantity: INSTANTS,
        allowed: 1e-3,
    },
];

/// The largest tolerance from which on a question is answered.
fn questions(rows: &[Row]) -> Table {
    let row = |question: &Question| {
        let mut rows: Vec<&Row> = scene(rows, question.scene).collect();
        rows.reverse();
        // From the smallest tolerance up, as long as it is answered.
        let answered = rows
            .into_iter()
            .take_while(|row| (question.error)(row).is_some_and(|error| error <= question.allowed));
        let (quantity, unit) = question.quantity;
        let answer = answered.last().map_or_else(
            || ["none of those measured".to_owned(), String::new(), String::new()],
            |row| {
                let error = format!("{} {unit}", error((question.error)(row)));
                [
                    format!("{:.0e}", row.value),
                    format!("{quantity}: {}", error.trim_end()),
                    time(row),
                ]
            },
        );
        let head = [question.text.to_owned(), question.scene.to_owned()];
        head.into_iter().chain(answer).collect()
    };
    Table::new(
        "Which tolerance for which question: the largest of those measured that answers it.",
        &[
            "question",
            "scene",
            "tolerance",
            "error at that tolerance",
            "time per simulated second",
        ],
        QUESTIONS.iter().map(row).collect(),
    )
}

#[cfg(test)]
mod tests {
    use anyhow::Result;

    use super::super::rows::read;
    use super::*;

    #[test]
    fn the_measurements_of_the_project_answer_every_question() -> Result<()> {
        let (rows, _) = read("docs")?;
        assert!(SCENES.iter().all(|name| scene(&rows, name).count() == 10));
        let answers = questions(&rows).rows;
        let tolerances = answers.iter().filter_map(|row| row.get(2)?.parse::<f64>().ok());
        assert_eq!(tolerances.count(), QUESTIONS.len(), "{answers:?}");
        Ok(())
    }
}
