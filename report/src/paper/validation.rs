//! `docs/validation.md`: the sections of the publication as Markdown, checked to be current.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use commands::root;

use super::sections;
use crate::content::Arguments;
use crate::markdown::markdown;

fn path() -> PathBuf {
    root().join("docs/validation.md")
}

/// Writes the page.
pub fn write() -> Result<PathBuf> {
    fs::write(path(), text()?).with_context(|| format!("cannot write {}", path().display()))?;
    Ok(path())
}

/// The page. It does not contain the curves, so they may be coarse; its numbers are rounded so that they are the same on
/// every machine.
fn text() -> Result<String> {
    let sections = sections(Arguments {
        quick: true,
        docs: true,
        ..Arguments::default()
    })?;
    Ok(format!(
        "<!-- Written by cargo xtask report --docs. -->\n# Validation\n\n    cargo xtask report --docs\n\nruns the \
         model and writes this page: published values of the model's source compared with those of this component.\n\n{}{}",
        markdown(&sections),
        include_str!("preloaded.md")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_current() {
        let text = text().unwrap();
        let written = fs::read_to_string(path()).unwrap();
        let different = text.lines().zip(written.lines()).find(|(now, then)| now != then);
        assert_eq!(
            different, None,
            "now and in docs/validation.md: run cargo xtask report --docs"
        );
        assert_eq!(text.len(), written.len(), "run cargo xtask report --docs");
    }
}
