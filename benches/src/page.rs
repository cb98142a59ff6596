//! Files of `docs/`, and what is written between two markers of a page.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// Replaces the text between the markers of a page; a page without them is replaced by the text.
///
/// # Errors
/// If the page cannot be written.
pub fn update(path: &Path, [begin, end]: [&str; 2], text: &str) -> Result<()> {
    let page = fs::read_to_string(path).unwrap_or_default();
    let parts = page
        .split_once(begin)
        .and_then(|(before, rest)| Some((before, rest.split_once(end)?.1)));
    let (before, after) = parts.unwrap_or_default();
    write(path, &format!("{before}{begin}\n\n{text}\n{end}{after}"))
}

/// Writes a file.
///
/// # Errors
/// If it cannot be written, with its name.
pub fn write(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
