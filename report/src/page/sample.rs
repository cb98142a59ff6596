//! Sections with text, tables and figures of every style, for the tests.

use std::f64::consts::TAU;

use crate::content::{Axis, Block, Curve, Figure, Section, Style, Table};

const fn axis(label: &'static str, unit: &'static str, logarithmic: bool) -> Axis {
    Axis {
        label,
        unit,
        logarithmic,
    }
}

fn curve(name: &str, colour: usize, style: Style, points: impl Iterator<Item = (f64, f64)>) -> Curve {
    let (x, y) = points.unzip();
    Curve {
        name: name.to_owned(),
        x,
        y,
        style,
        colour,
    }
}

fn range(points: u32) -> impl Iterator<Item = f64> {
    (0..=points).map(move |point| f64::from(point) / f64::from(points))
}

fn history() -> Figure {
    let force = |phase: f64| move |t: f64| (3.0 * t, 0.05 + 0.02 * (TAU * (3.0 * t + phase)).sin());
    Figure {
        id: "history",
        title: "Contact force over three periods, 98 m/s² at 1 kHz".to_owned(),
        x: axis("time", "ms", false),
        y: axis("contact force", "N", false),
        curves: vec![
            curve("ours", 0, Style::Line, range(1000).map(force(0.0))),
            curve("frequency domain", 1, Style::Line, range(1000).map(force(0.02))),
            curve("linearised", 2, Style::Dashed, range(1000).map(force(0.05))),
            curve("published (Fig. 6)", 0, Style::Markers, range(20).map(force(0.01))),
        ],
        caption: "The published points lie on ours; see [the table](#kinds).".to_owned(),
    }
}

fn precision() -> Figure {
    let names = [
        "relay-contact",
        "CVODE BDF",
        "diffsol BDF",
        "diffsol ESDIRK34",
        "Newmark",
        "generalised-alpha",
    ];
    let cost = |index: usize| {
        move |t: f64| {
            (
                10.0_f64.powf(-12.0 * t),
                10.0_f64.powf(-2.0 + t * (1.0 + 0.3 * index as f64)),
            )
        }
    };
    let curves = names.iter().enumerate();
    Figure {
        id: "precision",
        title: "Work and precision: chatter at 400 m/s², 1 kHz".to_owned(),
        x: axis("largest error of the contact force / preload", "", true),
        y: axis("processor time per simulated second", "s", true),
        curves: curves
            .map(|(index, name)| curve(name, index, Style::LineAndMarkers, range(8).map(cost(index))))
            .collect(),
        caption: "Lower and further left is better.".to_owned(),
    }
}

fn map() -> Figure {
    let limit = |factor: f64| {
        move |t: f64| {
            (
                10.0 + 1990.0 * t,
                factor * (5.0 + 60.0 * (t - 0.6).powi(2) + 1.0 / (t + 0.05)),
            )
        }
    };
    Figure {
        id: "map",
        title: "Where the contact opens for longer than 10 µs".to_owned(),
        x: axis("frequency of the excitation", "Hz", false),
        y: axis("amplitude of the excitation", "g", false),
        curves: vec![
            curve("stays closed", 2, Style::Area, range(60).map(limit(1.0))),
            curve("opens for 10 µs", 1, Style::Line, range(60).map(limit(1.2))),
            curve(
                "all of the standard's classes",
                6,
                Style::Dashed,
                range(1).map(|t| (2000.0 * t, 20.0)),
            ),
        ],
        caption: "Below the area nothing opens.".to_owned(),
    }
}

fn resistance() -> Figure {
    let law = |force: f64| (force, 7.4118 / force.powf(0.9515));
    Figure {
        id: "resistance",
        title: "Resistance against force".to_owned(),
        x: axis("contact force", "N", true),
        y: axis("contact resistance", "mΩ", true),
        curves: vec![curve(
            "law",
            0,
            Style::Line,
            range(50).map(|t| law(0.05 * 10.0_f64.powf(0.8 * t))),
        )],
        caption: String::new(),
    }
}

fn frequencies() -> Table {
    let row = |cells: [&str; 5]| cells.map(str::to_owned).to_vec();
    Table {
        caption: "First frequency against length and overtravel (Table 3)".to_owned(),
        columns: row([
            "length / mm",
            "overtravel / mm",
            "published / Hz",
            "ours / Hz",
            "deviation",
        ]),
        rows: vec![
            row(["15.5", "0.2", "1397.6", "1397.58", "−0.001 %"]),
            row(["11.5", "0.2", "2120", "2538.11", "**+19.7 %**"]),
        ],
    }
}

fn wide() -> Table {
    let cells = |text: &str| (1..=12).map(|number| format!("{text} {number}")).collect();
    Table {
        caption: "Wider than a phone".to_owned(),
        columns: cells("a column whose name is long"),
        rows: vec![cells("`cell` of row 1,"), cells("cell | of row 2,")],
    }
}

/// The sections.
pub fn sections() -> Vec<Section> {
    let text = |text: &str| Block::Text(text.to_owned());
    vec![
        Section {
            id: "kinds",
            title: "Each kind of block",
            lead: String::new(),
            blocks: vec![
                text("The *published* values beside **ours**, in `N`.\n\n- see [many](#many)\n- second item"),
                Block::Figure(history()),
                Block::Table(frequencies()),
            ],
        },
        Section {
            id: "many",
            title: "Many curves, wide tables",
            lead: String::new(),
            blocks: vec![
                Block::Figure(precision()),
                Block::Figure(map()),
                Block::Figure(resistance()),
                Block::Table(wide()),
            ],
        },
        Section {
            id: "summary",
            title: "In five minutes",
            lead: String::new(),
            blocks: vec![text(
                "1. The first finding: see [the figure](#history).\n2. The second.",
            )],
        },
    ]
}
