//! Stages of the tests, each with its time.

use std::time::Instant;

use anyhow::Result;

/// Does the work and prints its duration.
pub fn stage<T>(name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    println!("== {name}");
    let start = Instant::now();
    let result = work()?;
    println!("== {name}: passed in {:.1} s", start.elapsed().as_secs_f64());
    Ok(result)
}
