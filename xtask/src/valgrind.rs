//! The calls of importers under valgrind: no error, no leak.
//!
//! Valgrind does not know every instruction of the compilation for AVX2, so the library is built with the feature
//! `portable`, in a target folder of its own: no other build can mistake its library for one of theirs.

use std::io::BufReader;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use cargo_metadata::Message;

use crate::commands::{self, cargo, command};

/// Random calls made under valgrind, fifty times slower there.
const CALLS: &str = "5000";

/// Said where valgrind is missing.
pub const MISSING: &str = "valgrind is missing (on Debian: apt-get install valgrind)";

/// Whether valgrind is there.
pub fn is_installed() -> bool {
    commands::output(command("valgrind").arg("--version")).is_ok()
}

/// Runs the campaign and the C program under valgrind.
pub fn run() -> Result<()> {
    if !is_installed() {
        bail!(MISSING);
    }
    let campaign = built(&["test", "--no-run", "--package=campaign", "--test=loaded_library"])?;
    commands::run(
        memcheck()
            .arg(campaign)
            // Instances by the thousand, and every call in every state, show nothing new here and take minutes.
            .args([
                "--test-threads=1",
                "--skip=thousands",
                "--skip=every_call_in_every_state",
            ])
            .env("CAMPAIGN_CALLS", CALLS),
    )?;
    let life_cycle = built(&["test", "--no-run", "--package=relay-contact", "--test=c"])?;
    commands::run(
        memcheck()
            // The C program is started by the test, and so is its compiler, which is not looked at.
            .args([
                "--trace-children=yes",
                "--trace-children-skip=*/cc,*/gcc,*/collect2,*/ld,*/as,*/cc1",
            ])
            .args([life_cycle.as_os_str(), "life_cycle".as_ref()]),
    )
}

fn memcheck() -> Command {
    let mut valgrind = command("valgrind");
    valgrind.args([
        "--quiet",
        "--leak-check=full",
        // What Rust's runtime holds of its main thread to the end is "possibly lost" to valgrind.
        "--show-leak-kinds=definite,indirect",
        "--errors-for-leak-kinds=definite,indirect",
        "--error-exitcode=1",
    ]);
    valgrind
}

/// Builds with the feature and gives the program.
fn built(arguments: &[&str]) -> Result<PathBuf> {
    let (subcommand, rest) = arguments.split_first().context("no arguments")?;
    let mut build = cargo();
    build
        .arg(subcommand)
        .args([
            "--features=portable",
            "--target-dir=target/portable",
            "--message-format=json-render-diagnostics",
        ])
        .args(rest)
        .stdout(Stdio::piped());
    let mut child = build.spawn()?;
    let messages = child.stdout.take().context("cargo says nothing")?;
    let mut program = None;
    for message in Message::parse_stream(BufReader::new(messages)) {
        if let Message::CompilerArtifact(artifact) = message?
            && let Some(executable) = artifact.executable
        {
            program = Some(executable.into_std_path_buf());
        }
    }
    if !child.wait()?.success() {
        bail!("the build with the feature portable failed");
    }
    program.context("cargo built no program")
}
