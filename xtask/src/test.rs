//! Every check and test, in the order in which they fail fastest.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::Result;

use crate::commands::{self, cargo};
use crate::{fmu, importers, python, report, valgrind};

/// Folders and files with Python in them.
const PYTHON: [&str; 4] = ["examples/python", "conformance/python", "docs", "report/browser"];

/// Runs all stages; the first that fails ends it.
pub fn run() -> Result<()> {
    stage("format", || commands::run(cargo().args(["fmt", "--all", "--check"])))?;
    stage("lint", || commands::run(&mut clippy(&[])))?;
    stage("Rust tests", || commands::run(cargo().arg("test")))?;
    stage("a million random calls", || {
        commands::run(
            cargo()
                .args([
                    "test",
                    "--package=campaign",
                    "--test=loaded_library",
                    "--",
                    "random_calls",
                    "--nocapture",
                ])
                .env("CAMPAIGN_CALLS", "1000000"),
        )
    })?;
    if valgrind::is_installed() {
        stage("valgrind", valgrind::run)?;
        stage("what is off costs nothing", report::what_is_off)?;
    } else {
        println!("== valgrind, what is off costs nothing: NOT RUN, {}", valgrind::MISSING);
    }
    let mut component = PathBuf::new();
    stage("component", || {
        component = fmu::build()?;
        Ok(())
    })?;
    stage("Python environment", python::prepare)?;
    stage("Python lint", || {
        commands::run(python::python().args(["-m", "ruff", "check"]).args(PYTHON))
    })?;
    stage("Python format", || {
        commands::run(python::python().args(["-m", "ruff", "format", "--check"]).args(PYTHON))
    })?;
    stage("Python types", || {
        commands::run(python::python().args(["-m", "mypy"]).args(PYTHON))
    })?;
    stage("conformance lint", || {
        commands::run(clippy(&["--package=conformance"]).envs(bindings()?))
    })?;
    stage("Python examples", || pytest("examples/python", &component))?;
    importers(&component)?;
    if report::chromium().is_some() {
        stage("report", report::test)?;
    } else {
        println!("== report: NOT RUN, {}", report::CHROMIUM_MISSING);
    }
    Ok(())
}

/// Builds the component and tests it under other people's importers alone.
pub fn importers_alone() -> Result<()> {
    let component = fmu::build()?;
    python::prepare()?;
    importers(&component)
}

/// The component under other people's importers, and the table of what they did.
fn importers(component: &Path) -> Result<()> {
    stage("reference runs", || importers::prepare(component))?;
    stage("Python importers", || pytest("conformance/python", component))?;
    stage("conformance", || {
        commands::run(
            cargo()
                .args(["test", "--package=conformance"])
                .envs(bindings()?)
                .env("RELAY_CONTACT_FMU", component),
        )
    })?;
    stage("importers", importers::table)
}

/// The Python tests of a folder or file, with the component.
pub fn pytest(tests: &str, component: &Path) -> Result<()> {
    commands::run(
        python::python()
            .args(["-m", "pytest", "--quiet", "-rs", tests])
            .env("RELAY_CONTACT_FMU", component),
    )
}

/// What the build of the conformance crate's FMI bindings needs in its environment: libclang, and the C compiler's
/// own headers (`stddef.h`), which do not come with the libclang of `.venv`.
fn bindings() -> Result<[(&'static str, OsString); 2]> {
    let mut include = OsString::new();
    if cfg!(unix) {
        let folder = commands::output(commands::command("cc").arg("-print-file-name=include"))?;
        include.push(format!("-I{}", folder.trim()));
    }
    Ok([
        ("LIBCLANG_PATH", python::libclang()?.into_os_string()),
        ("BINDGEN_EXTRA_CLANG_ARGS", include),
    ])
}

fn stage(name: &str, work: impl FnOnce() -> Result<()>) -> Result<()> {
    println!("== {name}");
    let start = Instant::now();
    work()?;
    println!("== {name}: passed in {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Clippy over the default members, or over `packages`; cargo's arguments come before those of the lints.
fn clippy(packages: &[&str]) -> Command {
    let mut clippy = cargo();
    clippy
        .arg("clippy")
        .args(packages)
        .args(["--all-targets", "--", "-D", "warnings"]);
    clippy
}
