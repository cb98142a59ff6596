//! Tables of published values compared with those of this model.

use crate::content::{Block, Table};
use crate::numbers::{deviation, number, signed};

/// A table under construction: quantity | published | this model | deviation | location.
pub struct Comparison {
    rows: Vec<Vec<String>>,
    place: &'static str,
}

impl Comparison {
    /// The location in the publication of the rows that follow.
    pub fn at(place: &'static str) -> Self {
        Self {
            rows: Vec::new(),
            place,
        }
    }

    /// Changes it.
    pub fn then_at(&mut self, place: &'static str) {
        self.place = place;
    }

    /// A row with the relative deviation.
    pub fn row(&mut self, quantity: &str, published: f64, value: f64, digits: usize, unit: &str) {
        let texts = [
            format!("{published} {unit}"),
            format!("{} {unit}", number(value, digits)),
        ];
        self.texts(quantity, texts, &deviation(value, published));
    }

    /// A row with the difference.
    pub fn difference(&mut self, quantity: &str, published: f64, value: f64, digits: usize, unit: &str) {
        let texts = [
            format!("{published} {unit}"),
            format!("{} {unit}", number(value, digits)),
        ];
        self.texts(
            quantity,
            texts,
            &format!("{} {unit}", signed(value - published, digits)),
        );
    }

    /// A row of which the published and this model's value are texts.
    pub fn texts(&mut self, quantity: &str, [published, value]: [String; 2], deviation: &str) {
        self.rows
            .push(cells(&[quantity, &published, &value, deviation, self.place]));
    }

    /// The table.
    pub fn table(self, caption: &str) -> Block {
        let columns = [
            "quantity",
            "published",
            "this model",
            "deviation",
            "location in the publication",
        ];
        table(caption, &columns, self.rows)
    }
}

/// A row of texts.
pub fn cells(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).trim_end().to_owned()).collect()
}

/// Any table.
pub fn table(caption: &str, columns: &[impl AsRef<str>], rows: Vec<Vec<String>>) -> Block {
    Block::Table(Table::new(caption, columns, rows))
}
