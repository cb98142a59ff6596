//! The page in headless Chromium.

use std::process::Command;

use anyhow::{Context, Result};

use crate::commands::{self, command};
use crate::python;

/// Said where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// What Chromium is called.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Chromium, by the name under which it is there.
pub fn chromium() -> Option<&'static str> {
    let there = |name: &&str| commands::output(command(name).arg("--version")).is_ok();
    NAMES.into_iter().find(there)
}

/// Draws the page's figures small, into `docs/report/`.
pub fn draw_pictures() -> Result<()> {
    commands::run(with_chromium()?.arg("xtask/browser/pictures.py"))
}

/// Tests the page.
pub fn test() -> Result<()> {
    commands::run(with_chromium()?.args(["-m", "pytest", "--quiet", "xtask/browser"]))
}

/// Python, told which Chromium to use.
fn with_chromium() -> Result<Command> {
    let mut python = python::python();
    python.env("RELAY_CONTACT_CHROMIUM", chromium().context(CHROMIUM_MISSING)?);
    Ok(python)
}
