//! Universal libraries of macOS: one file with a library for each processor.

use anyhow::{Context, Result};
use fat_macho::FatWriter;

/// Joins libraries for different processors into one.
pub fn join(libraries: &[Vec<u8>]) -> Result<Vec<u8>> {
    let mut writer = FatWriter::new();
    for library in libraries {
        writer.add(library.as_slice()).context("cannot join the libraries")?;
    }
    let mut joined = Vec::new();
    writer.write_to(&mut joined).context("cannot join the libraries")?;
    Ok(joined)
}
