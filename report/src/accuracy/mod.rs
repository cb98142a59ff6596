//! What accuracy costs.
//!
//! [`delivered`]: the component at each tolerance;   [`peers`]: other integrators on the same equations.

mod delivered;
mod peers;
pub mod study;

use anyhow::Result;

use self::delivered::{Delivered, Errors, Scene, measure};
use crate::content::Arguments;
use crate::content::{Axis, Block, Curve, Figure, Section, Style, Table};

/// The section.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let digits: &[i32] = if arguments.quick {
        &[2, 6, 10]
    } else {
        &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]
    };
    let tolerances: Vec<f64> = digits
        .iter()
        .map(|digits| format!("1e-{digits}").parse())
        .collect::<Result<_, _>>()?;
    let scenes = measure(&tolerances, if arguments.quick { 3 } else { 9 })?;
    let verdict = verdict(&scenes);
    let mut blocks = vec![
        Block::Text(text(&scenes, &verdict)),
        Block::Figure(asked(&scenes)),
        Block::Figure(cost(&scenes)),
        Block::Table(table(&scenes)),
        Block::Table(questions(&scenes)),
    ];
    blocks.extend(peers::blocks(arguments.quick)?);
    Ok(vec![Section {
        id: "accuracy",
        title: "What accuracy costs",
        lead: format!("{verdict}, in the scenes and at the tolerances that can be judged."),
        blocks,
    }])
}

/// Whether the errors are what was asked for, and what the default costs.
fn verdict(scenes: &[Scene]) -> String {
    let judged = scenes.iter().flat_map(Scene::judged);
    let worst = judged
        .map(|delivered| delivered.errors.force / delivered.tolerance)
        .fold(0.0, f64::max);
    if worst <= 1.0 {
        format!(
            "The error never exceeds the tolerance asked; it is {} of it at most",
            percent(worst)
        )
    } else {
        format!("The error exceeds the tolerance asked, by up to {worst:.1} times it")
    }
}

fn text(scenes: &[Scene], verdict: &str) -> String {
    let own: Vec<String> = scenes
        .iter()
        .map(|scene| format!("{:.0e} in *{}*", scene.own_error, scene.name))
        .collect();
    format!(
        "`solver.tolerance` is the error allowed in the contact force, relative to the preload force. **{verdict}**, in all scenes \
         below and at all tolerances that the reference can judge.\n\nThe error is the largest at a communication point (10 µs), \
         against a run of the component itself at tolerance 1e-11 with 34 modes. How far that is off itself shows in another one \
         with 30 modes and steps of 0.5 µs at most: {}; tolerances of less than five times that are not judged. (Within a \
         microsecond after a blow the force changes by newtons: there rounding shows first.) Errors against an independent \
         integrator are in `docs/accuracy.md`. Times are those of one core of this machine in the build for release, the shortest \
         of some runs.",
        own.join(", "),
    )
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn error_axis() -> Axis {
    Axis {
        label: "error of the contact force, of the preload force",
        unit: "",
        logarithmic: true,
    }
}

fn curves(scenes: &[Scene], x: fn(&Delivered) -> f64) -> Vec<Curve> {
    let curve = |(scene, colour): (&Scene, usize)| Curve {
        name: scene.name.to_owned(),
        x: scene.delivered.iter().map(x).collect(),
        y: scene.delivered.iter().map(|delivered| delivered.errors.force).collect(),
        style: Style::LineAndMarkers,
        colour,
    };
    scenes.iter().zip(0..).map(curve).collect()
}

fn asked(scenes: &[Scene]) -> Figure {
    let mut curves = curves(scenes, |delivered| delivered.tolerance);
    if let Some(scene) = scenes.first() {
        let tolerances: Vec<f64> = scene.delivered.iter().map(|delivered| delivered.tolerance).collect();
        curves.push(Curve {
            name: "error = tolerance".to_owned(),
            x: tolerances.clone(),
            y: tolerances,
            style: Style::Dashed,
            colour: curves.len(),
        });
    }
    Figure {
        id: "accuracy-asked",
        title: "Tolerance asked, error delivered".to_owned(),
        x: Axis {
            label: "solver.tolerance",
            unit: "",
            logarithmic: true,
        },
        y: error_axis(),
        curves,
        caption: "Below the dashed line the component is better than asked.".to_owned(),
    }
}

fn cost(scenes: &[Scene]) -> Figure {
    Figure {
        id: "accuracy-cost",
        title: "Error over computing time".to_owned(),
        x: Axis {
            label: "time per simulated second",
            unit: "s",
            logarithmic: true,
        },
        y: error_axis(),
        curves: curves(scenes, |delivered| delivered.time),
        caption: "Left and down is better. Each point is a tolerance.".to_owned(),
    }
}

fn table(scenes: &[Scene]) -> Table {
    let mut columns = vec!["tolerance".to_owned(), "modes".to_owned()];
    for scene in scenes {
        columns.push(format!("*{}*: force error", scene.name));
        columns.push("time per simulated second".to_owned());
    }
    let tolerances = scenes.first().map_or(0, |scene| scene.delivered.len());
    let row = |index: usize| {
        let row = || scenes.iter().filter_map(|scene| scene.delivered.get(index));
        let mut cells = Vec::new();
        if let Some(delivered) = row().next() {
            cells.extend([format!("{:.0e}", delivered.tolerance), delivered.modes.to_string()]);
        }
        for delivered in row() {
            cells.push(format!("{:.0e}", delivered.errors.force));
            cells.push(seconds(delivered.time));
        }
        cells
    };
    Table {
        caption: "What the component delivers, with the number of modes it chooses itself.".to_owned(),
        columns,
        rows: (0..tolerances).map(row).collect(),
    }
}

/// A time in a unit that fits.
fn seconds(time: f64) -> String {
    if time < 0.995 {
        format!("{} ms", digits(1e3 * time))
    } else {
        format!("{} s", digits(time))
    }
}

/// Two digits, or all before the point.
fn digits(x: f64) -> String {
    if x < 9.95 { format!("{x:.1}") } else { format!("{x:.0}") }
}

/// A question, where it is asked, what has to be small for it, how small, and in which words.
struct Question {
    text: &'static str,
    scene: &'static str,
    error: fn(&Errors) -> f64,
    allowed: f64,
    told: fn(f64) -> String,
}

const QUESTIONS: [Question; 4] = [
    Question {
        text: "Is the contact resistance right within 1 %?",
        scene: "paper-1khz",
        error: |errors| errors.resistance,
        allowed: 0.01,
        told: |error| format!("{:.0e} %", 100.0 * error),
    },
    Question {
        text: "Does it open, and when, within 1 µs?",
        scene: "chatter-41g",
        error: |errors| errors.instants,
        allowed: 1e-6,
        told: |error| format!("{:.0e} µs", 1e6 * error),
    },
    Question {
        text: "How hard is the blow of re-closing, within 1 %?",
        scene: "closing-bounce",
        error: |errors| errors.blow,
        allowed: 0.01,
        told: |error| format!("{:.0e} %", 100.0 * error),
    },
    Question {
        text: "Openings and closings to 1 ns, as a reference for other programs?",
        scene: "chatter-41g",
        error: |errors| errors.instants,
        allowed: 1e-9,
        told: |error| format!("{:.0e} ns", 1e9 * error),
    },
];

/// The coarsest tolerance from which on a question is answered.
fn questions(scenes: &[Scene]) -> Table {
    let row = |question: &Question| {
        let delivered = scenes.iter().find(|scene| scene.name == question.scene);
        let delivered = delivered.map_or(&[] as &[Delivered], |scene| &scene.delivered);
        let error = |delivered: &Delivered| (question.error)(&delivered.errors);
        // From the finest up, as long as it is answered.
        let answered = delivered
            .iter()
            .rev()
            .take_while(|delivered| error(delivered) <= question.allowed);
        let [tolerance, error, time] = answered.last().map_or_else(
            || ["none of those measured".to_owned(), String::new(), String::new()],
            |delivered| {
                [
                    format!("{:.0e}", delivered.tolerance),
                    (question.told)(error(delivered)),
                    seconds(delivered.time),
                ]
            },
        );
        vec![
            question.text.to_owned(),
            question.scene.to_owned(),
            tolerance,
            error,
            time,
        ]
    };
    Table {
        caption: "Which tolerance for which question: the coarsest of those measured that answers it.".to_owned(),
        columns: [
            "question",
            "scene",
            "tolerance",
            "error there",
            "time per simulated second",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: QUESTIONS.iter().map(row).collect(),
    }
}
