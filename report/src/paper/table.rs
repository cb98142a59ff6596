//! Cells and rows of the tables.

use crate::content::{Block, Table};

/// A number with digits after the point; never minus zero, whose sign would be that of rounding.
pub fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) {
        text
    } else {
        text.trim_start_matches('-').to_owned()
    }
}

/// The same with four significant digits.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value, 0);
    }
    #[allow(clippy::cast_possible_truncation)] // at most 308
    let magnitude = value.abs().log10().floor() as i32;
    if (-3..6).contains(&magnitude) {
        number(value, usize::try_from(3 - magnitude).unwrap_or_default())
    } else {
        format!("{value:.3e}")
    }
}

/// How far ours is from the published value.
pub fn deviation(ours: f64, published: f64) -> String {
    percent(100.0 * (ours / published - 1.0))
}

/// A signed percentage.
pub fn percent(value: f64) -> String {
    format!("{} %", signed(value, 2))
}

/// A number with its sign, unless it is rounded to zero.
pub fn signed(value: f64, digits: usize) -> String {
    let text = number(value, digits);
    let zero = text.bytes().all(|byte| byte == b'0' || byte == b'.');
    if zero || value < 0.0 { text } else { format!("+{text}") }
}

/// quantity | published | ours | deviation | place
pub fn row(quantity: &str, published: f64, ours: f64, digits: usize, unit: &str, place: &str) -> Vec<String> {
    cells(&[
        quantity,
        &format!("{published} {unit}"),
        &format!("{} {unit}", number(ours, digits)),
        &deviation(ours, published),
        place,
    ])
}

/// The same where a difference says more than a ratio.
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
    let columns = ["quantity", "published", "ours", "deviation", "where in the publication"];
    table(caption, &columns, rows)
}

/// Any table.
pub fn table(caption: &str, columns: &[&str], rows: Vec<Vec<String>>) -> Block {
    Block::Table(Table {
        caption: caption.to_owned(),
        columns: cells(columns),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_with_signs_that_mean_something() {
        assert_eq!(number(-0.004, 2), "0.00");
        assert_eq!(number(-0.006, 2), "-0.01");
        assert_eq!(signed(0.004, 2), "0.00");
        assert_eq!(signed(0.006, 2), "+0.01");
        assert_eq!(significant(1354.515), "1355");
        assert_eq!(significant(0.026_954), "0.02695");
        assert_eq!(significant(3.54e6), "3.540e6");
        assert_eq!(deviation(0.9, 1.0), "-10.00 %");
    }
}
