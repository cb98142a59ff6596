//! What the report says, before it is a page: sections of text, tables and figures.

/// A section of the page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Its anchor.
    pub id: &'static str,
    pub title: &'static str,
    /// The section in a sentence of Markdown, for the summary of the page; empty: it has no place there.
    pub lead: String,
    pub blocks: Vec<Block>,
}

/// What a section is made of.
#[derive(Clone, Debug)]
pub enum Block {
    /// Paragraphs in Markdown.
    Text(String),
    Table(Table),
    Figure(Figure),
}

/// A table; cells are Markdown, numbers with their digits.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub caption: String,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its anchor, and the name of its picture.
    pub id: &'static str,
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub curves: Vec<Curve>,
    /// What to see in it, in Markdown.
    pub caption: String,
}

/// An axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    pub label: &'static str,
    /// Empty for a pure number.
    pub unit: &'static str,
    pub logarithmic: bool,
}

/// A curve, in the units of the axes.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub style: Style,
    /// Which colour; curves that belong together have the same.
    pub colour: usize,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Line,
    Dashed,
    /// Points alone: what is published or measured.
    Markers,
    LineAndMarkers,
    /// The area below a curve.
    Area,
}
