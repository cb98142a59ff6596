//! Rows of published values compared with those of this model.

use crate::content::{Block, Table};
use crate::numbers::{deviation, number, signed};

/// quantity | published | this model | deviation | location
pub fn row(quantity: &str, published: f64, ours: f64, digits: usize, unit: &str, place: &str) -> Vec<String> {
    cells(&[
        quantity,
        &format!("{published} {unit}"),
        &format!("{} {unit}", number(ours, digits)),
        &deviation(ours, published),
        place,
    ])
}

/// The same with the difference in place of the relative deviation.
pub fn difference(quantity: &str, published: f64, ours: f64, digits: usize, unit: &str, place: &str) -> Vec<String> {
    let mut row = row(quantity, published, ours, digits, unit, place);
    row[3] = format!("{} {unit}", signed(ours - published, digits));
    row
}

/// A row of texts.
pub fn cells(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).trim_end().to_owned()).collect()
}

/// A table of [`row`]s.
pub fn comparison(caption: &str, rows: Vec<Vec<String>>) -> Block {
    let columns = [
        "quantity",
        "published",
        "this model",
        "deviation",
        "location in the publication",
    ];
    table(caption, &columns, rows)
}

/// Any table.
pub fn table(caption: &str, columns: &[&str], rows: Vec<Vec<String>>) -> Block {
    Block::Table(Table::new(caption, columns, rows))
}
