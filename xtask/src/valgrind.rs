//! Calls as from importers under valgrind: no error, no leak.
//!
//! The library is that of the Rust tests, with its compilation for AVX2 (tried with valgrind 3.19, Debian 12).

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use crate::commands::{cargo, is_there, run as run_command};
use anyhow::{Result, ensure};

use crate::linked;
use crate::release::trial::{Runner, Trial};

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

/// Runs the campaign and the C program under valgrind.
pub fn run() -> Result<()> {
    ensure!(is_there("valgrind"), MISSING);
    let mut campaign = cargo();
    campaign
        .args(["test", "--test=loaded_library"])
        .arg(format!("--config=target.'cfg(unix)'.runner={VALGRIND:?}"))
        // Thousands of instances, and every call in every state, take minutes and add nothing here.
        .args(["--", "--test-threads=1", "--skip=thousands", "--skip=every_call_in_every_state"])
        // Random calls are fifty times slower here.
        .env("CAMPAIGN_CALLS", "2000");
    run_command(&mut campaign)?;
    let runner = Runner { compiler: vec!["cc".into()], start: VALGRIND.map(Into::into).to_vec() };
    // Cargo builds the library beside the test.
    let built = linked::metadata()?.target_directory.as_std_path().join("debug/deps");
    let library = built.join(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"));
    let trial = Trial::prepare(runner, "valgrind", &library)?;
    print!("{}", trial.embedded()?);
    Ok(())
}
