//! Starts the program `report`: the report, the costs of the effects, scenes, what accuracy costs. It is a program of its own,
//! so that what it needs is compiled where it is asked for alone.

use std::ffi::{OsStr, OsString};
use std::process::Command;

use anyhow::Result;

use crate::commands::{self, cargo, command};
use crate::{importers, python};

/// Said where Chromium is missing.
pub const CHROMIUM_MISSING: &str = "Chromium is missing (on Debian: apt-get install chromium)";

/// What Chromium is called.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// What is handed on to the program.
#[derive(clap::Args)]
pub struct Arguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

impl Arguments {
    fn has(&self, argument: &str) -> bool {
        self.arguments.iter().any(|known| known == argument)
    }

    fn asks_for_help(&self) -> bool {
        self.has("--help") || self.has("-h")
    }
}

/// Does one of the program's tasks.
pub fn run(task: &str, arguments: &Arguments) -> Result<()> {
    if !arguments.asks_for_help() {
        python::prepare()?;
    }
    start(task, &arguments.arguments)
}

/// The report, for which the component is tried under the importers that are called from Python.
pub fn report(arguments: &Arguments) -> Result<()> {
    if !["--quick", "--docs"].into_iter().any(|short| arguments.has(short)) && !arguments.asks_for_help() {
        importers::run_python()?;
    }
    run("report", arguments)
}

/// The report in its quick form, in a browser.
pub fn test() -> Result<()> {
    start("report", ["--quick"])?;
    commands::run(python::python().args(["-m", "pytest", "--quiet", "report/browser"]))
}

/// Checks that disabled effects cost nothing.
pub fn what_is_off() -> Result<()> {
    start("effects", ["--off"])
}

/// Does a task of the program with its arguments.
pub fn start(task: &str, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Result<()> {
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
