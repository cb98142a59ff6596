//! The sections of the report, in order.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

use crate::content::{Arguments, Block, Section};
use crate::{accuracy, effects, importers, opening, page, paper, stability};

/// Computes sections.
type Part = fn(Arguments) -> Result<Vec<Section>>;

/// Results first, then the comparison and checks behind them.
const MAIN: [Part; 4] = [
    opening::sections,
    accuracy::sections,
    effects::sections,
    importers::sections,
];
const APPENDIX: [Part; 2] = [paper::sections, stability::sections];

/// Runs everything and writes `out/report/index.html`.
pub fn run(arguments: Arguments) -> Result<()> {
    if arguments.docs {
        println!("{}", paper::validation::write()?.display());
        return Ok(());
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?;
    let progress = ProgressBar::new((MAIN.len() + APPENDIX.len()) as u64).with_style(style);
    let run = |parts: &[Part]| {
        let mut sections = Vec::new();
        for part in parts {
            sections.extend(part(arguments)?);
            progress.inc(1);
        }
        Ok::<_, anyhow::Error>(sections)
    };
    let (main, appendix) = (run(&MAIN)?, run(&APPENDIX)?);
    progress.finish_and_clear();
    let path = page::write(
        &summary(main.iter().chain(&appendix)),
        &main,
        &appendix,
        arguments.quick,
    )?;
    if arguments.pictures {
        commands::run(commands::python().arg("report/browser/pictures.py"))?;
    }
    println!("{}", path.display());
    Ok(())
}

/// The sections summarised in a sentence each.
fn summary<'a>(sections: impl Iterator<Item = &'a Section>) -> Section {
    let lines: Vec<_> = sections
        .filter(|section| !section.lead.is_empty())
        .map(|section| format!("- [{}](#{}): {}", section.title, section.id, section.lead))
        .collect();
    Section {
        id: "summary",
        title: "In short",
        lead: String::new(),
        blocks: vec![Block::Text(lines.join("\n"))],
    }
}
