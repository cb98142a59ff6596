//! The sections as Markdown, for `docs/validation.md`.

use std::fmt::Write;

use super::super::content::{Block, Section, Table};

/// The sections, figures as links to their pictures in `report/`.
pub fn markdown(sections: &[Section]) -> String {
    let mut text = String::new();
    for section in sections {
        let _ = write!(text, "\n## {}\n", section.title);
        for block in &section.blocks {
            text.push('\n');
            match block {
                Block::Text(paragraphs) => text.push_str(paragraphs),
                Block::Table(table) => table_text(&mut text, table),
                Block::Figure(figure) => {
                    let _ = write!(
                        text,
                        "![{}](report/{}.png)\n\n{}",
                        figure.title, figure.id, figure.caption
                    );
                }
            }
            text.push('\n');
        }
    }
    text
}

fn table_text(text: &mut String, table: &Table) {
    let _ = write!(
        text,
        "**{}**\n\n| {} |\n|{}",
        table.caption,
        table.columns.join(" | "),
        "---|".repeat(table.columns.len())
    );
    for row in &table.rows {
        let _ = write!(text, "\n| {} |", row.join(" | "));
    }
}
