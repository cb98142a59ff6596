//! Starts the program `report`: the report, the cost of effects and of accuracy, and scenes. A separate program, so
//! that its dependencies are compiled only when needed.

use std::ffi::{OsStr, OsString};
use std::process::Command;

use anyhow::Result;
use commands::{cargo, command};

use crate::python;

/// The message where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// Names of Chromium.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Arguments passed on to the program.
#[derive(clap::Args)]
pub struct Arguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

impl Arguments {
    /// Whether one of these is among them.
    pub fn has(&self, names: &[&str]) -> bool {
        self.arguments
            .iter()
            .any(|known| names.iter().any(|name| known == name))
    }
}

/// Prepares Python and runs a task of the program.
pub fn run(task: &str, arguments: &Arguments) -> Result<()> {
    if !arguments.has(&["--help", "-h"]) {
        python::prepare()?;
    }
    start(task, &arguments.arguments)
}

/// The report in its quick form, in a browser.
pub fn test() -> Result<()> {
    start("report", &["--quick"])?;
    commands::run(commands::python().args(["-m", "pytest", "--quiet", "report/browser"]))
}

/// Runs a task of the program with its arguments.
pub fn start(task: &str, arguments: &[impl AsRef<OsStr>]) -> Result<()> {
    commands::run(program().arg(task).args(arguments))
}

fn program() -> Command {
    let mut program = cargo();
    // Not `--package`, for the reason in `.cargo/config.toml`.
    program.args(["run", "--quiet", "--bin=report", "--"]);
    program
}

/// The command name of Chromium, if installed.
pub fn chromium() -> Option<&'static str> {
    let there = |name: &&str| commands::output(command(name).arg("--version")).is_ok();
    CHROMIUM.into_iter().find(there)
}
