//! The sections as Markdown, for `docs/`.

use crate::content::{Block, Figure, Section, Table};

/// The sections; their pictures are looked for in the folder `report/` beside.
pub fn markdown(sections: &[Section]) -> String {
    let sections = sections.iter().map(|section| {
        let blocks = section.blocks.iter().map(|block| match block {
            Block::Text(text) => text.trim().to_owned(),
            Block::Table(table) => format!("**{}**\n\n{}", table.caption.trim(), self::table(table)),
            Block::Figure(figure) => self::figure(figure),
        });
        let blocks: Vec<_> = blocks.collect();
        format!("## {}\n\n{}\n", section.title, blocks.join("\n\n"))
    });
    sections.collect::<Vec<_>>().join("\n")
}

fn figure(figure: &Figure) -> String {
    let Figure { id, title, caption, .. } = figure;
    format!("### {title}\n\n![{title}](report/{id}.png)\n\n{}", caption.trim())
}

/// A table without its caption.
pub fn table(table: &Table) -> String {
    let line = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    let cells = |cells: &[String]| line(cells.iter().map(|cell| cell.replace('|', "\\|")).collect());
    let rule = table
        .numeric()
        .into_iter()
        .map(|numeric| if numeric { "---:" } else { "---" });
    let mut lines = vec![cells(&table.columns), line(rule.map(str::to_owned).collect())];
    lines.extend(table.rows.iter().map(|row| cells(row)));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::sample;

    #[test]
    fn sections_figures_and_tables_are_in_the_markdown() {
        let text = markdown(&sample::sections());
        assert!(text.starts_with("## Each kind of block\n\nThe *published* values"));
        let figure =
            "### Contact force over three periods\n\n![Contact force over three periods](report/history.png)\n";
        assert!(text.contains(figure), "{text}");
        let table =
            "| length / mm | published / Hz | deviation |\n| --- | ---: | ---: |\n| 15.5 | 1397.6 | −0.001 % |\n";
        assert!(text.contains(table), "{text}");
        assert!(text.contains("cell \\| of row 2"), "{text}");
    }
}
