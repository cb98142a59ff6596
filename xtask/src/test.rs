//! All checks and tests, the fastest first.

use std::process::Command;
use std::{env, thread};

use crate::commands::{LINT, cargo, is_there, output, run as run_command, stage};
use anyhow::{Result, anyhow, bail};

use crate::release::tools::{Rust, lld};
use crate::{fmu, importers, python, report, site, valgrind, wheel};

#[derive(clap::Args, Clone, Copy)]
pub struct Arguments {
    /// For daily work: only format, lint, unit and integration tests
    #[arg(long)]
    quick: bool,
    /// Only the stages with the packed component, which run in parallel with the others
    #[arg(long, hide = true)]
    component: bool,
}

/// Runs all stages up to the first failure, but completes those running in parallel.
pub fn run(arguments: Arguments) -> Result<()> {
    if arguments.component {
        return component();
    }
    stage("cargo xtask test", || {
        stage("format", || run_command(cargo().args(["fmt", "--all", "--check"])))?;
        if arguments.quick {
            stage("lint", || run_command(cargo().arg("clippy").args(LINT)))?;
            return rust();
        }
        // In parallel, as most of the work uses one core; in a program of its own, whose output then stays together.
        let component = thread::spawn(|| output(Command::new(env::current_exe()?).args(["test", "--component"])));
        let library = library();
        if library.is_err() {
            println!("== FAILED, waiting for the stages beside it");
        }
        match (library, component.join().unwrap_or_else(|_| Err(anyhow!("panicked")))) {
            (Err(library), Err(component)) => bail!("{library:#}\n{component:#}"),
            (library, component) => {
                print!("{}", component?);
                library?;
            }
        }
        // Of what both have left.
        if_installed("report", report::has_chromium(), report::CHROMIUM_MISSING, || {
            python::report(&["report", "--quick"])?;
            python::test(&["report"], &fmu::path())
        })
    })
}

/// Unit and integration tests.
fn rust() -> Result<()> {
    stage("Rust tests", || run_command(cargo().arg("test")))
}

/// The stages with the library only. The lint is of all packages at once, which are then checked once, and needs the Python
/// environment: what takes as long to make as the tests to compile.
fn library() -> Result<()> {
    stage("Rust tests compile", || run_command(cargo().args(["test", "--no-run"])))?;
    python::prepare()?;
    stage("lint", || {
        let mut lint = importers::workspace("clippy")?;
        run_command(lint.arg("--features=conformance/types").args(LINT))
    })?;
    rust()?;
    if_installed("valgrind", is_there("valgrind"), valgrind::MISSING, valgrind::run)
}

/// A stage with a program that a machine may lack.
fn if_installed(name: &str, installed: bool, missing: &str, run: impl FnOnce() -> Result<()>) -> Result<()> {
    if installed {
        return stage(name, run);
    }
    println!("== {name}: NOT RUN, {missing}");
    Ok(())
}

/// The stages with the packed component, and Python.
fn component() -> Result<()> {
    stage("Python environment", python::prepare)?;
    let component = stage("component", fmu::build)?;
    let tool = |arguments: &[&str]| run_command(crate::commands::python().arg("-m").args(arguments));
    stage("Python lint", || tool(&["ruff", "check"]))?;
    stage("Python format", || tool(&["ruff", "format", "--check"]))?;
    stage("Python types", || tool(&["mypy"]))?;
    let missing = Rust::find().and_then(|rust| lld(&rust.rustc)).err().map(|error| error.to_string());
    if_installed("simulation in the browser, site", missing.is_none(), &missing.unwrap_or_default(), site::build)?;
    // With the page, if there is one. The Python tests install it into an empty environment.
    stage("wheel", wheel::run)?;
    stage("Python tests and examples", || python::test(&["examples/python", "tests/python", "explore"], &component))?;
    importers::stages(&component)
}
