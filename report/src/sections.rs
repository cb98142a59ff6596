//! What stands in the report, in order.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

use crate::content::{Arguments, Block, Section};
use crate::{accuracy, effects, importers, opening, page, paper, stability};

/// Runs what sections are made of.
type Part = fn(Arguments) -> Result<Vec<Section>>;

/// Runs everything and writes `out/report/index.html`.
pub fn run(arguments: Arguments) -> Result<()> {
    if arguments.docs {
        println!("{}", paper::validation::write()?.display());
        return Ok(());
    }
    let parts: [Part; 6] = [
        opening::sections,
        paper::sections,
        accuracy::sections,
        stability::sections,
        effects::section::sections,
        importers::sections,
    ];
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new(parts.len() as u64).with_style(style);
    let mut sections = Vec::new();
    for part in parts {
        sections.extend(part(arguments)?);
        progress.inc(1);
    }
    progress.finish_and_clear();
    sections.insert(0, summary(&sections));
    let path = page::write(&sections, arguments.quick)?;
    if arguments.pictures {
        commands::run(commands::python().arg("report/browser/pictures.py"))?;
    }
    println!("{}", path.display());
    Ok(())
}

/// What the sections come to, in a sentence each.
fn summary(sections: &[Section]) -> Section {
    let told = sections.iter().filter(|section| !section.lead.is_empty());
    let lines: Vec<_> = told
        .map(|section| format!("- [{}](#{}): {}", section.title, section.id, section.lead))
        .collect();
    Section {
        id: "summary",
        title: "In short",
        lead: String::new(),
        blocks: vec![Block::Text(lines.join("\n"))],
    }
}
