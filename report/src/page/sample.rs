//! Sections with text, a table and a figure of every style, for the tests.

use std::f64::consts::TAU;

use crate::content::{Axis, Block, Curve, Figure, Section, Style, Table};

fn figure() -> Figure {
    let force = |phase: f64| {
        let points = (0..=20).map(|point| f64::from(point) / 20.0);
        points.map(move |t| (3.0 * t, 0.05 + 0.02 * (TAU * (3.0 * t + phase)).sin()))
    };
    Figure {
        id: "history",
        title: "Contact force over three periods".to_owned(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("contact force", "N"),
        curves: vec![
            Curve::new("this component", force(0.0), Style::Line, 0),
            Curve::new("frequency domain", force(0.02), Style::Line, 1),
            Curve::new("linearised", force(0.05), Style::Dashed, 2),
            Curve::new("tolerance band", force(0.06), Style::Area, 3),
            Curve::new("other integrator", force(0.07), Style::LineAndMarkers, 4),
            Curve::new("published", force(0.01), Style::Markers, 0),
        ],
        caption: "The published points lie on the first curve; see [the table](#kinds).".to_owned(),
    }
}

fn table() -> Table {
    let rows = [
        ["15.5", "1397.6", "−0.001 %"],
        ["cell | of row 2", "2120", "**+19.7 %**"],
    ];
    Table::new(
        "First frequency",
        &["length / mm", "published / Hz", "deviation"],
        rows.map(|row| row.map(str::to_owned).to_vec()).to_vec(),
    )
}

/// The first section, and a summary.
pub fn sections() -> [Section; 2] {
    let text = |text: &str| Block::Text(text.to_owned());
    let section = |id, title, blocks| Section {
        id,
        title,
        lead: String::new(),
        blocks,
    };
    let blocks = vec![
        text("The *published* values beside those of **this component**, in `N`."),
        Block::Figure(figure()),
        Block::Table(table()),
    ];
    [
        section("kinds", "Each kind of block", blocks),
        section("summary", "In short", vec![text("See [the figure](#history).")]),
    ]
}
