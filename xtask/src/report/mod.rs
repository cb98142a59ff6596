//! The report: what the component reproduces, what accuracy costs, what stays stable, on one page.
//!
//! [`content`]: sections, tables, figures;   [`page`]: the page made of them.   Sections:   [`opening`]: whether the contact
//! opens;   [`paper`]: the published results beside ours;   [`accuracy`], [`effects`]: what accuracy and effects cost;
//! [`stability`]: hard cases and the property each keeps;   [`importers`]: other people's importers.

mod accuracy;
pub mod content;
mod effects;
mod importers;
mod opening;
mod page;
mod paper;
mod stability;

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

use self::content::{Block, Section};
pub use self::page::{CHROMIUM_MISSING, chromium, markdown_table};

/// How much is run.
#[derive(clap::Args, Clone, Copy, Default)]
pub struct Arguments {
    /// Fewer points and runs, to see that everything works
    #[arg(long)]
    pub quick: bool,
    /// Also draw each figure small, as docs/report/FIGURE.png (needs Chromium)
    #[arg(long)]
    pub pictures: bool,
    /// Only rewrite docs/validation.md
    #[arg(long)]
    pub docs: bool,
}

/// Runs what sections are made of.
type Part = fn(Arguments) -> Result<Vec<Section>>;

/// The report in its quick form, in a browser.
pub fn test() -> Result<()> {
    run(Arguments {
        quick: true,
        ..Arguments::default()
    })?;
    page::test()
}

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
        effects::sections,
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
        page::draw_pictures()?;
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
