//! Calls as from importers under valgrind: no error, no leak.
//!
//! The library is that of the Rust tests, with its compilation for AVX2 (tried with valgrind 3.19, Debian 12).

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;

use crate::commands::{cargo, command, output, run as run_command};
use anyhow::{Result, bail};
use cargo_metadata::Message;

use crate::release::trial::{Runner, Trial};

/// The test that makes the calls.
const CAMPAIGN: &str = "loaded_library";

/// Random calls made under valgrind, fifty times slower there.
const CALLS: &str = "2000";

/// The message where valgrind is missing.
pub const MISSING: &str = "valgrind is missing (on Debian: apt-get install valgrind)";

const VALGRIND: [&str; 6] = [
    "valgrind",
    "--quiet",
    "--leak-check=full",
    // Data of the main thread kept by Rust's runtime are "possibly lost" to valgrind.
    "--show-leak-kinds=definite,indirect",
    "--errors-for-leak-kinds=definite,indirect",
    "--error-exitcode=1",
];

/// Whether valgrind is installed.
pub fn is_installed() -> bool {
    output(command("valgrind").arg("--version")).is_ok()
}

/// Runs the campaign and the C program under valgrind.
pub fn run() -> Result<()> {
    if !is_installed() {
        bail!(MISSING);
    }
    let campaign = build_campaign()?;
    let [valgrind, options @ ..] = VALGRIND;
    run_command(
        command(valgrind)
            .args(options)
            .arg(&campaign)
            // Thousands of instances, and every call in every state, take minutes and add nothing here.
            .args([
                "--test-threads=1",
                "--skip=thousands",
                "--skip=every_call_in_every_state",
            ])
            .env("CAMPAIGN_CALLS", CALLS),
    )?;
    let runner = Runner {
        compiler: vec!["cc".into()],
        start: VALGRIND.map(Into::into).to_vec(),
    };
    // Cargo builds the library beside the test.
    let library = campaign.with_file_name(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"));
    let trial = Trial::prepare(runner, "valgrind", &library)?;
    print!("{}", trial.embedded()?);
    Ok(())
}

/// Builds the campaign as the Rust tests do, so that nothing is compiled again, and returns its program.
fn build_campaign() -> Result<PathBuf> {
    let mut build = cargo();
    build.args(["test", "--no-run", "--test", CAMPAIGN]);
    build.arg("--message-format=json-render-diagnostics");
    for message in Message::parse_stream(output(&mut build)?.as_bytes()) {
        // Cargo also builds the programs of the package.
        if let Message::CompilerArtifact(artifact) = message?
            && artifact.target.name == CAMPAIGN
            && let Some(executable) = artifact.executable
        {
            return Ok(executable.into_std_path_buf());
        }
    }
    bail!("cargo built no campaign")
}
