//! Contents of the report: sections of text, tables and figures.

/// How much is run.
#[derive(clap::Args, Clone, Copy, Default)]
#[expect(clippy::struct_excessive_bools, reason = "options of a command line")]
pub struct Arguments {
    /// Fewer points and runs, to see that everything works
    #[arg(long)]
    pub quick: bool,
    /// Also draw each figure small, as docs/report/FIGURE.png (needs Chromium)
    #[arg(long)]
    pub pictures: bool,
    /// Measure the accuracy and cost of this and other integrators anew, instead of showing docs/accuracy.csv (their build
    /// takes many minutes)
    #[arg(long)]
    pub peers: bool,
    /// Only rewrite docs/validation.md
    #[arg(long)]
    pub docs: bool,
}

/// A section of the page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Its anchor.
    pub id: &'static str,
    pub title: &'static str,
    /// Summary in a sentence of Markdown, for the head of the page; empty: none.
    pub lead: String,
    pub blocks: Vec<Block>,
}

impl Section {
    /// Its figures, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Figure(figure) => Some(figure),
            Block::Text(_) | Block::Table(_) => None,
        })
    }
}

/// A part of a section.
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

impl Table {
    /// A table of these columns.
    pub fn new(caption: &str, columns: &[impl AsRef<str>], rows: Vec<Vec<String>>) -> Self {
        let columns = columns.iter().map(|column| column.as_ref().trim_end().to_owned());
        Self {
            caption: caption.to_owned(),
            columns: columns.collect(),
            rows,
        }
    }

    /// Which columns hold numbers, for their alignment: most of their cells that are not empty start like one.
    pub fn numeric(&self) -> Vec<bool> {
        let number = |cell: &&String| {
            let digits = cell.trim_start_matches(['*', '+', '-', '−', '±', '<', '>', '≤', '≥', '≈', '–', '—', ' ']);
            digits.is_empty() || digits.starts_with(|letter: char| letter.is_ascii_digit())
        };
        let columns = 0..self.columns.len();
        columns
            .map(|column| {
                let cells = self.rows.iter().filter_map(|row| row.get(column));
                let cells: Vec<_> = cells.filter(|cell| !cell.is_empty()).collect();
                2 * cells.iter().copied().filter(number).count() > cells.len()
            })
            .collect()
    }
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
    /// Explanation in Markdown.
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

impl Axis {
    /// A linear axis; an empty unit is that of a pure number.
    pub const fn linear(label: &'static str, unit: &'static str) -> Self {
        Self {
            label,
            unit,
            logarithmic: false,
        }
    }

    /// A logarithmic axis.
    pub const fn logarithmic(label: &'static str, unit: &'static str) -> Self {
        Self {
            label,
            unit,
            logarithmic: true,
        }
    }
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

impl Curve {
    /// A curve through points.
    pub fn new(name: &str, points: impl IntoIterator<Item = (f64, f64)>, style: Style, colour: usize) -> Self {
        let (x, y) = points.into_iter().unzip();
        Self {
            name: name.to_owned(),
            x,
            y,
            style,
            colour,
        }
    }
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
