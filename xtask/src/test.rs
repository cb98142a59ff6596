//! Every check and test, in the order in which they fail fastest.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use anyhow::Result;

use crate::commands::{self, cargo};
use crate::{fmu, python, valgrind};

/// Folders and files with Python in them.
const PYTHON: [&str; 3] = ["examples/python", "conformance/fmpy", "docs"];

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
    } else {
        println!("== valgrind: NOT RUN, it is not installed (on Debian: apt-get install valgrind)");
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
    stage("FMPy", || {
        commands::run(
            python::python()
                .args(["-m", "pytest", "--quiet", "conformance/fmpy"])
                .env("RELAY_CONTACT_FMU", &component),
        )
    })?;
    let bindings = bindings()?;
    stage("conformance lint", || {
        commands::run(clippy(&["--package=conformance"]).envs(bindings.clone()))
    })?;
    stage("conformance", || {
        commands::run(
            cargo()
                .args(["test", "--package=conformance"])
                .envs(bindings.clone())
                .env("RELAY_CONTACT_FMU", &component),
        )
    })
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
