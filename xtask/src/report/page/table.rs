//! Tables.

use maud::{Markup, html};

use crate::html::{inline_markdown, markdown};
use crate::report::content::Table;

/// A table as HTML.
pub fn table(table: &Table) -> Markup {
    let numeric = numeric(table);
    let class = |column: usize| numeric.get(column).is_some_and(|numeric| *numeric).then_some("number");
    html! {
        figure {
            figcaption { (markdown(&table.caption)) }
            div.scroll role="region" tabindex="0" aria-label=(table.caption) {
                table {
                    thead { tr { @for (column, name) in table.columns.iter().enumerate() {
                        th scope="col" class=[class(column)] { (inline_markdown(name)) }
                    } } }
                    tbody { @for row in &table.rows { tr { @for (column, cell) in row.iter().enumerate() {
                        td class=[class(column)] { (inline_markdown(cell)) }
                    } } } }
                }
            }
        }
    }
}

/// Which columns hold numbers, for their alignment: every cell starts like one, or is empty or a dash.
pub fn numeric(table: &Table) -> Vec<bool> {
    let number = |cell: &String| {
        let digits = cell.trim_start_matches(['*', '+', '-', '−', '±', '<', '>', '≤', '≥', '≈', ' ']);
        digits.is_empty()
            || digits == "–"
            || digits == "—"
            || digits.starts_with(|letter: char| letter.is_ascii_digit())
    };
    let columns = 0..table.columns.len();
    columns
        .map(|column| {
            let mut cells = table.rows.iter().filter_map(|row| row.get(column)).peekable();
            cells.peek().is_some() && cells.all(number)
        })
        .collect()
}
