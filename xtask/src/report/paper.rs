//! To be written.

use anyhow::Result;

use super::Arguments;
use super::content::Section;

/// The sections.
pub fn sections(_arguments: Arguments) -> Result<Vec<Section>> {
    Ok(Vec::new())
}
