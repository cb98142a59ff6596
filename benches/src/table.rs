//! Measurements as text: a CSV of all, and tables of the fastest run at equal or better error.

use std::fmt::Write as _;

use crate::integrator::Failure;
use crate::study::{Measured, PEERS, Row};

/// The part of a study in which the component runs as it is used: it chooses the number of modes.
pub const DELIVERED: &str = "delivered";

/// Selects an error of a run; none if it has none.
type Error = fn(&Measured) -> Option<f64>;

/// All tables, with machine, date and failed runs.
pub fn report(rows: &[Row]) -> String {
    let force: (_, _, Error) = ("contact force, relative to the preload", "", |run| {
        Some(run.force_error)
    });
    let instants: (_, _, Error) = ("instants of opening and closing", " s", |run| run.event_error);
    let fine = [1e-6, 1e-7, 1e-8, 1e-9];
    let coarse = [1e-2, 1e-4, 1e-6, 1e-8];
    // What is asked most comes first: when the contact opens, and the force of a closed one.
    let mut tables = String::new();
    for (scene, (quantity, unit, error), levels) in [
        ("chatter", instants, fine),
        ("paper", force, [1e-2, 1e-4, 1e-6, 1e-10]),
        ("chatter 3 %", instants, fine),
        ("chatter 3 %", force, coarse),
        ("chatter", force, coarse),
        ("closing bounce", instants, fine),
    ] {
        let _ = write!(tables, "Scene *{scene}*, error of the {quantity}:\n\n");
        tables += &envelope(rows, scene, &levels, unit, error);
        tables.push('\n');
    }
    format!(
        "Each cell is the cheapest run whose error is at most that of the row: its processor time per simulated second and its \
         tolerance (or step); for the others also its number of modes and, in front, how many times the component's it is. \
         With the least of all rounds instead of their medians the ratios differ by at most {:.0} %.\n\n{tables}\
         The component: error of the contact force relative to the preload and of the opening durations, number of modes, \
         processor time per simulated second:\n\n{}\n{}\n\nMeasured on: {}. Failed runs:\n\n{}",
        100.0 * spread(rows),
        delivered(rows),
        growth(rows),
        crate::machine::description(),
        match failures(rows) {
            none if none.is_empty() => "- none\n".to_owned(),
            some => some,
        },
    )
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

/// How much the component's computing time grows from the tolerance of 1e-2 to that of 1e-10.
fn growth(rows: &[Row]) -> String {
    let cost = |scene: &str, tolerance: f64| {
        let is = |row: &&Row| {
            let case = &row.case;
            case.part == DELIVERED
                && case.problem.name == scene
                && (case.setting.value() / tolerance - 1.0).abs() < 1e-9
        };
        Some(rows.iter().find(is)?.outcome.as_ref().ok()?.cost)
    };
    let ratios: Vec<f64> = scenes(rows)
        .iter()
        .filter_map(|scene| Some(cost(scene, 1e-10)? / cost(scene, 1e-2)?))
        .collect();
    let [least, most] = [f64::min, f64::max].map(|of| ratios.iter().copied().reduce(of).unwrap_or(f64::NAN));
    format!("From 1e-2 to 1e-10 its computing time grows {least:.1} to {most:.1} times.")
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

/// A table in Markdown: of each integrator the cheapest run at each level of the error that `error` selects.
fn envelope(rows: &[Row], scene: &str, levels: &[f64], unit: &str, error: Error) -> String {
    let of_scene = |row: &&Row| row.case.problem.name == scene && [DELIVERED, PEERS].contains(&row.case.part);
    let installed = |row: &&Row| !matches!(row.outcome, Err(Failure::Unavailable(_)));
    let rows: Vec<&Row> = rows.iter().filter(of_scene).filter(installed).collect();
    let mut names: Vec<&str> = rows.iter().map(|row| row.case.integrator.name()).collect();
    names.dedup();
    let cheapest = |name: &str, level: f64| {
        let own = rows.iter().filter(|row| row.case.integrator.name() == name);
        let runs = own.filter_map(|row| Some((*row, row.outcome.as_ref().ok()?)));
        let good = runs.filter(|(_, run)| error(run).is_some_and(|error| error <= level));
        good.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))
    };
    let mut text = format!(
        "| allowed | {} |\n|---:|{}\n",
        names.join(" | "),
        "---|".repeat(names.len())
    );
    for level in levels {
        let _ = write!(text, "| {level:.0e}{unit} |");
        let own = names.first().and_then(|name| cheapest(name, *level));
        for name in &names {
            let Some((row, run)) = cheapest(name, *level) else {
                text.push_str(" not reached |");
                continue;
            };
            let (time, setting) = (seconds(run.cost), row.case.setting);
            let _ = match own {
                Some((_, least)) if row.case.part == PEERS => {
                    write!(
                        text,
                        " **{}** {time}, {} modes, {setting} |",
                        factor(run.cost / least.cost),
                        row.modes
                    )
                }
                _ => write!(
                    text,
                    " {time}, {setting}, delivers {:.0e}{unit} |",
                    error(run).unwrap_or(f64::NAN)
                ),
            };
        }
        text.push('\n');
    }
    text
}

/// How far the ratio of any two runs' costs differs between the medians and the minima of their rounds, relative.
fn spread(rows: &[Row]) -> f64 {
    let runs = rows
        .iter()
        .filter(|row| row.case.part != "modes")
        .filter_map(|row| row.outcome.as_ref().ok());
    let parts = runs
        .map(|run| run.cost / run.least_cost)
        .filter(|part| part.is_finite());
    let ends = parts.fold((f64::INFINITY, 0.0_f64), |(least, most), part| {
        (least.min(part), most.max(part))
    });
    ends.1 / ends.0 - 1.0
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
