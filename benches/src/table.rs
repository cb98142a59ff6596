//! Measurements as text: a CSV of all, and tables of the fastest run at equal or better error.

use std::fmt::Write as _;

use crate::integrator::Failure;
use crate::study::{Measured, Row};

/// The part of a study in which the component chooses the number of modes automatically.
pub const DELIVERED: &str = "delivered";

/// The part of a study in which all integrators work on the same modes.
pub const PEERS: &str = "peers";

/// Selects an error of a run; none if it has none.
type Error = fn(&Measured) -> Option<f64>;

/// All tables, with machine, date and failed runs.
pub fn report(rows: &[Row]) -> String {
    let mut text = format!(
        "Measured on: {}.\n\nThe component, with modes chosen automatically: error of the contact force relative to the preload and \
         of the opening durations, number of modes, processor time per simulated second:\n\n{}\nCompared with other integrators, \
         on the same modes. Each cell: processor time per simulated second of the fastest run whose error is at most that of the \
         column, and in brackets its ratio to that of the component.\n",
        crate::machine::description(),
        delivered(rows),
    );
    let force: Error = |run| Some(run.force_error);
    let instants: Error = |run| run.event_error;
    let of_force = (
        "contact force relative to the preload",
        [1e-2, 1e-4, 1e-6, 1e-8, 1e-10],
        "",
        force,
    );
    let of_instants = (
        "times of opening and closing",
        [1e-6, 1e-7, 1e-8, 1e-9, 1e-10],
        " s",
        instants,
    );
    let scenes = scenes(rows);
    for (quantity, levels, unit, error) in [of_force, of_instants] {
        let seen = |scene: &&str| rows.iter().any(|row| row.case.problem.name == *scene && row.opens());
        for scene in scenes.iter().filter(|scene| unit.is_empty() || seen(scene)) {
            let _ = write!(text, "\nScene *{scene}*, error of the {quantity}:\n\n");
            text += &ratios(rows, scene, &levels, unit, error);
        }
    }
    text += "\nFailed runs:\n\n";
    let failures = failures(rows);
    text + if failures.is_empty() { "- none\n" } else { &failures }
}

/// The scenes, in the order of their rows.
fn scenes(rows: &[Row]) -> Vec<&'static str> {
    let mut names: Vec<&str> = rows.iter().map(|row| row.case.problem.name).collect();
    names.dedup();
    names
}

/// The component at each tolerance, with modes chosen automatically, compared with a reference of many modes.
fn delivered(rows: &[Row]) -> String {
    let (names, rows) = (scenes(rows), rows.iter().filter(|row| row.case.part == DELIVERED));
    let rows: Vec<&Row> = rows.collect();
    let mut tolerances: Vec<f64> = rows.iter().map(|row| row.case.setting.value()).collect();
    tolerances.sort_by(|a, b| b.total_cmp(a));
    tolerances.dedup();
    let mut text = format!(
        "| tolerance | {} |\n|---|{}\n",
        names.join(" | "),
        "---:|".repeat(names.len())
    );
    for tolerance in tolerances {
        let _ = write!(text, "| {tolerance:.0e} |");
        for name in &names {
            let case = |row: &&&Row| row.case.problem.name == *name && row.case.setting.value() == tolerance;
            let found = rows.iter().find(case);
            let cell = found.and_then(|row| Some((row.modes, row.outcome.as_ref().ok()?)));
            let cell = cell.map_or("failed".to_owned(), |(modes, run)| {
                let error = run.duration_error.filter(|_| run.events > 0);
                let durations = error.map_or(String::new(), |error| format!("{:.0e} µs, ", 1e6 * error));
                let cost = seconds(run.cost);
                format!("{:.0e}, {durations}{modes} modes, {cost}", run.force_error)
            });
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// All rows as CSV.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "part,scene,integrator,setting,value,modes,seconds_per_second,force_error,event_error_us,opening_duration_error_us,\
         events,steps,rejected,iterations,reference_force_error,reference_event_error_us,outcome\n",
    );
    for row in rows {
        let case = &row.case;
        let _ = write!(
            text,
            "{},{},{},{},{:e},{},",
            case.part,
            case.problem.name,
            case.integrator.name(),
            case.setting.kind(),
            case.setting.value(),
            row.modes,
        );
        let micro = |seconds: Option<f64>| seconds.map_or(String::new(), |seconds| format!("{:.4e}", 1e6 * seconds));
        let outcome = match &row.outcome {
            Ok(run) => {
                let _ = write!(
                    text,
                    "{:.4e},{:.4e},{},{},{},{},{},{},",
                    run.cost,
                    run.force_error,
                    micro(run.event_error),
                    micro(run.duration_error),
                    run.events,
                    run.steps,
                    run.rejected,
                    run.iterations,
                );
                "ok".to_owned()
            }
            Err(failure) => {
                text.push_str(",,,,,,,,");
                failure.to_string().replace(['"', ',', '\n'], " ")
            }
        };
        let _ = writeln!(
            text,
            "{:.4e},{},{outcome}",
            case.reference.force_error,
            micro(Some(case.reference.event_error)),
        );
    }
    text
}

/// A table in Markdown: time per simulated second of the fastest run of each integrator that is at least as accurate
/// as each level, and its ratio to that of the component. `error` selects the error.
fn ratios(rows: &[Row], scene: &str, levels: &[f64], unit: &str, error: fn(&Measured) -> Option<f64>) -> String {
    let rows: Vec<&Row> = rows
        .iter()
        .filter(|row| row.case.part == PEERS && row.case.problem.name == scene)
        .filter(|row| !matches!(row.outcome, Err(Failure::Unavailable(_))))
        .collect();
    let cheapest = |integrator: &str, level: f64| {
        rows.iter()
            .filter(|row| row.case.integrator.name() == integrator)
            .filter_map(|row| row.outcome.as_ref().ok())
            .filter(|run| error(run).is_some_and(|error| error <= level))
            .map(|run| run.cost)
            .min_by(f64::total_cmp)
    };
    let mut names: Vec<&str> = rows.iter().map(|row| row.case.integrator.name()).collect();
    let mut seen = std::collections::HashSet::new();
    names.retain(|name| seen.insert(*name));
    let Some(own) = names.first().copied() else {
        return String::new();
    };
    let mut text = String::from("| |");
    for level in levels {
        let _ = write!(text, " {level:.0e}{unit} |");
    }
    text.push_str("\n|---|");
    text.push_str(&"---:|".repeat(levels.len()));
    text.push('\n');
    for name in names {
        let _ = write!(text, "| {name} |");
        for level in levels {
            let _ = match (cheapest(name, *level), cheapest(own, *level)) {
                (Some(cost), _) if name == own => write!(text, " {} |", seconds(cost)),
                (Some(cost), Some(least)) => write!(text, " {} ({}) |", seconds(cost), factor(cost / least)),
                (Some(cost), None) => write!(text, " {} |", seconds(cost)),
                (None, _) => write!(text, " not reached |"),
            };
        }
        text.push('\n');
    }
    text
}

/// The failed runs, a line each; an integrator that is not installed has one line.
fn failures(rows: &[Row]) -> String {
    let mut lines = Vec::new();
    for row in rows {
        let case = &row.case;
        let integrator = case.integrator.name();
        let line = match &row.outcome {
            Ok(_) => continue,
            Err(failure @ Failure::Unavailable(_)) => format!("- {integrator}: {failure}\n"),
            Err(failure) => format!(
                "- {}, {integrator}, {} {:.0e}: {failure}\n",
                case.problem.name,
                case.setting.kind(),
                case.setting.value(),
            ),
        };
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines.concat()
}

/// A time in s or ms.
fn seconds(time: f64) -> String {
    match time {
        t if t >= 1.0 => format!("{} s", digits(t)),
        t => format!("{} ms", digits(1e3 * t)),
    }
}

fn factor(ratio: f64) -> String {
    format!("{}×", digits(ratio))
}

/// Two significant digits, or all digits before the decimal point.
fn digits(x: f64) -> String {
    if x < 9.95 { format!("{x:.1}") } else { format!("{x:.0}") }
}
