//! Independent runs, side by side.

use anyhow::Result;
use rayon::prelude::*;

/// The results of `work` in the order of the items, or an error.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> Result<R> + Send + Sync) -> Result<Vec<R>> {
    items.par_iter().map(work).collect()
}
