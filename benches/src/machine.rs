//! The machine and the date of the measurements.

use crate::cvode::Cvode;

/// Date, processor, compiler and library versions, in one line.
pub fn description() -> String {
    let sundials = Cvode::new()
        .version()
        .map_or("without SUNDIALS".to_owned(), |version| format!("SUNDIALS {version}"));
    let diffsol = locked_version("diffsol").unwrap_or_default();
    let own = env!("CARGO_PKG_VERSION");
    format!(
        "{}; relay-contact {own}, diffsol {diffsol}, {sundials}",
        commands::machine()
    )
}

/// The version of a package in Cargo.lock.
fn locked_version(package: &str) -> Option<String> {
    let mut lines = include_str!("../../Cargo.lock").lines();
    lines.find(|line| *line == format!("name = \"{package}\""))?;
    Some(lines.next()?.split('"').nth(1)?.to_owned())
}
