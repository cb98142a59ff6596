//! Sections as Markdown, for `docs/`; and pages of `docs/` as blocks of a section.

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

/// A page of `docs/` below its title: its text, its tables, and of `figures` those whose pictures it shows. What stands
/// before a table and ends with a colon becomes its caption.
pub fn blocks(page: &str, figures: &[Figure]) -> Vec<Block> {
    let mut blocks = Vec::new();
    for paragraph in page.split("\n\n").map(|paragraph| paragraph.trim_matches('\n')) {
        if paragraph.starts_with('|') {
            let caption = match blocks.pop() {
                Some(Block::Text(text)) if text.ends_with(':') => text,
                before => {
                    blocks.extend(before);
                    String::new()
                }
            };
            blocks.push(Block::Table(read_table(paragraph, &caption)));
        } else if let Some((_, picture)) = paragraph.split_once("](report/") {
            let shown = figures.iter().filter(|figure| picture.starts_with(figure.id));
            blocks.extend(shown.max_by_key(|figure| figure.id.len()).cloned().map(Block::Figure));
        } else if !paragraph.starts_with("# ") && !paragraph.starts_with("<!--") {
            blocks.push(Block::Text(paragraph.replace("## ", "### ")));
        }
    }
    blocks
}

fn read_table(lines: &str, caption: &str) -> Table {
    let cells = |line: &str| {
        let cells = line.trim().trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_owned()).collect::<Vec<_>>()
    };
    let mut lines = lines
        .lines()
        .filter(|line| !line.starts_with("|---") && !line.starts_with("| ---"));
    let columns = lines.next().map(cells).unwrap_or_default();
    Table::new(caption, &columns, lines.map(cells).collect())
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

    #[test]
    fn a_page_is_read_with_its_tables_and_figures() {
        let sections = sample::sections();
        let figures: Vec<_> = sections.iter().flat_map(Section::figures).cloned().collect();
        let page = "# Title\n\n<!-- written -->\n\n## Head\n\nText.\n\nAll:\n\n| a | b |\n|---|---:|\n| c | 1 |\n\n\
                    ![shown](report/history.png)\n\n![other](report/unknown.png)\n";
        let found = blocks(page, &figures);
        let [
            Block::Text(head),
            Block::Text(text),
            Block::Table(table),
            Block::Figure(figure),
        ] = found.as_slice()
        else {
            panic!("{found:?}");
        };
        assert_eq!(
            [head.as_str(), text.as_str(), figure.id],
            ["### Head", "Text.", "history"]
        );
        assert_eq!(table.caption, "All:");
        assert_eq!(
            (&table.columns, &table.rows),
            (&vec!["a".into(), "b".into()], &vec![vec!["c".into(), "1".into()]])
        );
    }
}
