//! The page: `out/report/index.html`.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;

use super::content::Section;
use crate::commands::root;

/// Writes the page.
pub fn write(sections: &[Section]) -> Result<PathBuf> {
    let path = root().join("out/report/index.html");
    fs::create_dir_all(root().join("out/report"))?;
    fs::write(&path, format!("{sections:#?}"))?;
    Ok(path)
}
