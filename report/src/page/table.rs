//! Tables.

use maud::{Markup, html};

use super::html::{inline_markdown, markdown};
use crate::content::Table;

/// A table as HTML.
pub fn table(table: &Table) -> Markup {
    let numeric = table.numeric();
    let class = |column: usize| numeric.get(column).is_some_and(|numeric| *numeric).then_some("number");
    html! {
        figure {
            @if !table.caption.is_empty() { figcaption { (markdown(&table.caption)) } }
            div.scroll role="region" tabindex="0" aria-label={ "Table. " (table.caption) } {
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
