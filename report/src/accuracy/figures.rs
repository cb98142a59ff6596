//! The figures of `docs/accuracy.md`.

use super::rows::{Relay, Row, of};
use crate::content::{Axis, Curve, Figure, Style};

/// The scenes, with the anchor of the figure of each.
pub const SCENES: [(&str, &str); 6] = [
    ("paper", "accuracy-paper"),
    ("linear", "accuracy-linear"),
    ("chatter", "accuracy-chatter"),
    ("chatter 3 %", "accuracy-chatter-3"),
    ("chatter 0.3 %", "accuracy-chatter-03"),
    ("closing bounce", "accuracy-closing-bounce"),
];

/// Those in which the contact opens.
const OPENING: [(&str, &str); 2] = [
    ("chatter", "accuracy-chatter-durations"),
    ("closing bounce", "accuracy-closing-bounce-durations"),
];

const TIME: Axis = Axis::logarithmic("computing time per simulated second", "s");
const FORCE: Axis = Axis::logarithmic("error of the contact force, relative to the preload", "");
const DURATION: Axis = Axis::logarithmic("error of the opening durations", "µs");

/// Larger errors are not drawn: such a run is of no use. Relative to the preload, and in us.
const USELESS: (f64, f64) = (1.0, 10.0);

/// All of them.
pub fn figures(rows: &[Row], relays: &[Relay]) -> Vec<Figure> {
    let force = |row: &Row| row.force_error.filter(|error| *error <= USELESS.0);
    let duration = |row: &Row| row.opening_duration_error_us.filter(|error| *error <= USELESS.1);
    let forces = SCENES.map(|(scene, id)| {
        let title = format!("Error of the contact force over computing time: {scene}");
        integrators(rows, scene, id, title, FORCE, &force, |row| row.reference_force_error)
    });
    let durations = OPENING.map(|(scene, id)| {
        let title = format!("Error of the opening durations over computing time: {scene}");
        integrators(rows, scene, id, title, DURATION, &duration, |row| {
            row.reference_event_error_us
        })
    });
    let mut figures = vec![tolerances(rows), promise(relays), modes(rows)];
    figures.extend(forces.into_iter().chain(durations));
    figures
}

/// A figure without caption: `docs/accuracy.md` has the words.
fn figure(id: &'static str, title: String, [x, y]: [Axis; 2], curves: Vec<Curve>) -> Figure {
    Figure {
        id,
        title,
        x,
        y,
        curves,
        caption: String::new(),
    }
}

/// A curve for each scene over a quantity of the rows of a part.
fn scenes(rows: &[Row], part: &str, x: impl Fn(&Row) -> f64) -> Vec<Curve> {
    let curve = |((scene, _), colour): ((&'static str, _), usize)| {
        let points = of(rows, part, scene).filter_map(|row| Some((x(row), row.force_error?)));
        Curve::new(scene, points, Style::LineAndMarkers, colour)
    };
    SCENES.into_iter().zip(0..).map(curve).collect()
}

fn tolerances(rows: &[Row]) -> Figure {
    let mut curves = scenes(rows, "delivered", |row| row.value);
    let tolerances = of(rows, "delivered", SCENES[0].0).map(|row| (row.value, row.value));
    curves.push(Curve::new("error = tolerance", tolerances, Style::Dashed, 6));
    let axes = [Axis::logarithmic("solver.tolerance", ""), FORCE];
    figure("accuracy-tolerance", "Error against tolerance".to_owned(), axes, curves)
}

/// Smaller errors, from rounding alone, are drawn at this.
const LEAST: f64 = 1e-14;

/// Delivered over asked.
fn promise(relays: &[Relay]) -> Figure {
    let kind = |name: &str, colour, is: fn(&Relay) -> bool| {
        let points = relays.iter().filter(|relay| relay.outcome != "NotRun" && is(relay));
        let points = points.map(|relay| (relay.tolerance, relay.error.max(LEAST)));
        Curve::new(name, points, Style::Markers, colour)
    };
    let curves = vec![
        kind("closed", 0, |relay| !relay.opens && relay.outcome != "IllConditioned"),
        kind("opening", 1, |relay| relay.opens && relay.outcome != "IllConditioned"),
        kind("ill-conditioned", 3, |relay| relay.outcome == "IllConditioned"),
        Curve::new("error = tolerance", [(1e-8, 1e-8), (1e-2, 1e-2)], Style::Dashed, 6),
    ];
    let error = Axis::logarithmic("error of the contact force, relative as the tolerance", "");
    let axes = [Axis::logarithmic("solver.tolerance", ""), error];
    figure(
        "accuracy-promise",
        "Error against tolerance, random relays".to_owned(),
        axes,
        curves,
    )
}

fn modes(rows: &[Row]) -> Figure {
    let curves = scenes(rows, "modes", |row| f64::from(row.modes));
    let axes = [Axis::linear("number of modes", ""), FORCE];
    figure(
        "accuracy-modes",
        "Error against number of modes".to_owned(),
        axes,
        curves,
    )
}

/// Error over computing time of all integrators, of the component as it is used, and the error of the reference.
fn integrators(
    rows: &[Row],
    scene: &str,
    id: &'static str,
    title: String,
    errors: Axis,
    error: &dyn Fn(&Row) -> Option<f64>,
    reference: fn(&Row) -> f64,
) -> Figure {
    let point = |row: &Row| Some((row.seconds_per_second?, error(row)?));
    let mut names: Vec<&str> = of(rows, "peers", scene).map(|row| row.integrator.as_str()).collect();
    names.dedup();
    let curve = |(name, colour): (&&str, usize)| {
        let runs = of(rows, "peers", scene).filter(|row| row.integrator == *name);
        Curve::new(name, runs.filter_map(point), Style::LineAndMarkers, colour)
    };
    let mut curves: Vec<_> = names.iter().zip(0..).map(curve).collect();
    let times = curves.iter().flat_map(|curve| &curve.x);
    let ends = times.fold((f64::INFINITY, 0.0_f64), |(least, most), time| {
        (least.min(*time), most.max(*time))
    });
    let own = of(rows, "delivered", scene).filter_map(point);
    curves.push(Curve::new("relay-contact, modes chosen by it", own, Style::Dashed, 0));
    let known = of(rows, "peers", scene).map(reference).fold(0.0, f64::max);
    let line = [(ends.0, known), (ends.1, known)];
    curves.push(Curve::new("error of the reference", line, Style::Dashed, 6));
    figure(id, title, [TIME, errors], curves)
}
