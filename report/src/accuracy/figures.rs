//! The figures of `docs/accuracy.md`.

use super::rows::{Relay, Row, of};
use crate::content::{Axis, Curve, Figure, Style};

/// The scenes.
pub const SCENES: [&str; 6] = [
    "paper",
    "linear",
    "chatter",
    "chatter 3 %",
    "chatter 0.3 %",
    "closing bounce",
];

/// Figures of all integrators: anchor, scene, and whether of the instants or of the force.
const COMPARED: [(&str, &str, bool); 6] = [
    ("accuracy-instants", "chatter", true),
    ("accuracy-paper", "paper", false),
    ("accuracy-instants-3", "chatter 3 %", true),
    ("accuracy-chatter-3", "chatter 3 %", false),
    ("accuracy-chatter", "chatter", false),
    ("accuracy-instants-bounce", "closing bounce", true),
];

const TIME: Axis = Axis::logarithmic("computing time per simulated second", "s");
const FORCE: Axis = Axis::logarithmic("error of the contact force, relative to the preload", "");
const INSTANTS: Axis = Axis::logarithmic("error of the instants of opening and closing", "µs");

/// Larger errors are not drawn: such a run is of no use. Relative to the preload, and in us.
const USELESS: (f64, f64) = (1.0, 10.0);

/// All of them.
pub fn figures(rows: &[Row], relays: &[Relay]) -> Vec<Figure> {
    let mut figures = COMPARED.map(|compared| integrators(rows, compared)).to_vec();
    figures.extend([tolerances(rows), promise(relays), modes(rows)]);
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
    let curve = |(scene, colour): (&'static str, usize)| {
        let points = of(rows, part, scene).filter_map(|row| Some((x(row), row.force_error?)));
        Curve::new(scene, points, Style::LineAndMarkers, colour)
    };
    SCENES.into_iter().zip(0..).map(curve).collect()
}

fn tolerances(rows: &[Row]) -> Figure {
    let mut curves = scenes(rows, "delivered", |row| row.value);
    let tolerances = of(rows, "delivered", SCENES[0]).map(|row| (row.value, row.value));
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

/// Error over computing time: of each integrator the runs that none of its cheaper ones equals.
fn integrators(rows: &[Row], (id, scene, instants): (&'static str, &str, bool)) -> Figure {
    let error = |row: &Row| {
        let (error, useless) = if instants {
            (row.event_error_us?, USELESS.1)
        } else {
            (row.force_error?, USELESS.0)
        };
        (error <= useless).then_some(error)
    };
    let runs = || of(rows, "delivered", scene).chain(of(rows, "peers", scene));
    let mut names: Vec<&str> = runs().map(|row| row.integrator.as_str()).collect();
    names.dedup();
    let mut ends = (f64::INFINITY, 0.0_f64);
    let mut curves = Vec::new();
    for (colour, name) in names.into_iter().enumerate() {
        let own = runs().filter(|row| row.integrator == name);
        let mut points: Vec<_> = own
            .filter_map(|row| Some((row.seconds_per_second?, error(row)?)))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        points.retain(|point| {
            let better = point.1 < least;
            least = least.min(point.1);
            better
        });
        ends = points
            .iter()
            .fold(ends, |(low, high), point| (low.min(point.0), high.max(point.0)));
        if !points.is_empty() {
            curves.push(Curve::new(name, points, Style::LineAndMarkers, colour));
        }
    }
    let known = runs().map(|row| {
        if instants {
            row.reference_event_error_us
        } else {
            row.reference_force_error
        }
    });
    let known = known.fold(0.0, f64::max);
    let line = [(ends.0, known), (ends.1, known)];
    curves.push(Curve::new("error of the reference", line, Style::Dashed, 6));
    let axis = if instants { INSTANTS } else { FORCE };
    figure(
        id,
        format!("{} over computing time: {scene}", axis.label),
        [TIME, axis],
        curves,
    )
}
