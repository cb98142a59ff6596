//! Starts the program `report`: the report, the costs of the effects, scenes, what accuracy costs. It is a program of its own,
//! so that what it needs is compiled where it is asked for alone.

use std::ffi::{OsStr, OsString};
use std::process::Command;

use anyhow::Result;
use commands::{cargo, command};

use crate::python;

/// The message where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// Names of Chromium.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Arguments that are handed on to the program.
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

/// Does one of the program's tasks.
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

/// Does a task of the program with its arguments.
pub fn start(task: &str, arguments: &[impl AsRef<OsStr>]) -> Result<()> {
    commands::run(program().arg(task).args(arguments))
}

fn program() -> Command {
    let mut program = cargo();
    program.args(["run", "--quiet", "--package=report", "--"]);
    program
}

/// Chromium, by the name under which it is there.
pub fn chromium() -> Option<&'static str> {
    let there = |name: &&str| commands::output(command(name).arg("--version")).is_ok();
    CHROMIUM.into_iter().find(there)
}
