//! The machine and the date of the measurements.

use std::fs;
use std::process::Command;
use std::thread::available_parallelism;

use crate::cvode::Cvode;

/// Date, processor, compiler and library versions, in one line.
pub fn description() -> String {
    let processor = fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?.to_owned();
            Some(line.split_once(": ")?.1.to_owned())
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let cores = available_parallelism().map_or(1, usize::from);
    let rustc = printed("rustc", "--version").unwrap_or_else(|| "rustc".to_owned());
    let date = printed("date", "+%Y-%m-%d").unwrap_or_else(|| "unknown date".to_owned());
    let sundials =
        Cvode::default().version().map_or("without SUNDIALS".to_owned(), |version| format!("SUNDIALS {version}"));
    let diffsol = locked_version("diffsol").unwrap_or_default();
    let own = env!("CARGO_PKG_VERSION");
    format!("{date}, {processor}, {cores} cores, one used; {rustc}; relay-contact {own}, diffsol {diffsol}, {sundials}")
}

/// The output of a program.
fn printed(program: &str, argument: &str) -> Option<String> {
    let output = Command::new(program).arg(argument).output().ok()?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

/// The version of a package in Cargo.lock.
fn locked_version(package: &str) -> Option<String> {
    let mut lines = include_str!("../../Cargo.lock").lines();
    lines.find(|line| *line == format!("name = \"{package}\""))?;
    Some(lines.next()?.split('"').nth(1)?.to_owned())
}
