//! Checks of a built library by its bytes: that it loads where it shall, and holds nothing that does not belong there.

mod elf;
mod macho;
mod pe;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tiny;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fmt};

use anyhow::{Result, bail};
use cargo_metadata::Metadata;
use goblin::mach::MultiArch;
use relay_contact::{C_HEADER, variables};

pub use pe::without_time;

use super::platform::Platform;
use crate::commands::sysroot;

/// Every library is smaller, in bytes; each one of a universal library.
const SIZE: usize = 1_000_000;

/// What one check found.
pub struct Finding {
    /// The library's, as rustc calls it; all of them in what concerns a universal library as a whole.
    pub target: String,
    /// What was checked.
    pub check: &'static str,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
    /// Whether the one is within the other.
    pub passed: bool,
}

/// One line, for a table.
impl fmt::Display for Finding {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let verdict = if self.passed { "ok" } else { "FAILED" };
        write!(
            out,
            "{:<26} {:<18} {verdict:<7} {}",
            self.target, self.check, self.found
        )?;
        if !self.passed {
            write!(out, " (allowed: {})", self.allowed)?;
        }
        Ok(())
    }
}

/// An error that names each check that was not passed; `library` says of what.
pub fn demand(library: &str, findings: &[Finding]) -> Result<()> {
    let failures: Vec<_> = findings
        .iter()
        .filter(|finding| !finding.passed)
        .map(|failure| {
            format!(
                "{library}, {}: {}: found {}; allowed {}",
                failure.target, failure.check, failure.found, failure.allowed
            )
        })
        .collect();
    if !failures.is_empty() {
        bail!("{}", failures.join("\n"));
    }
    Ok(())
}

/// Checks the library of a platform. `private` are folders of this machine whose paths may not be inside, see
/// [`private_folders`]. An error where the file is not of the platform's format.
pub fn library(platform: &Platform, bytes: &[u8], private: &[PathBuf]) -> Result<Vec<Finding>> {
    let [target] = platform.targets else {
        return universal(platform.targets, bytes, private);
    };
    single(target, bytes, private)
}

/// Folders that differ from machine to machine: of the project, of its build, of the compiler `rustc`, of cargo and of the
/// user.
pub fn private_folders(metadata: &Metadata, rustc: &Path) -> Result<Vec<PathBuf>> {
    let compiler = sysroot(rustc)?.join("lib").join("rustlib");
    let project = [&metadata.workspace_root, &metadata.target_directory].map(Into::into);
    let user = ["HOME", "USERPROFILE", "CARGO_HOME", "RUSTUP_HOME"]
        .into_iter()
        .filter_map(env::var_os);
    let folders = project.into_iter().chain([compiler]).chain(user.map(PathBuf::from));
    // The root of all folders would be found everywhere.
    Ok(folders.filter(|folder| folder.parent().is_some()).collect())
}

/// A universal library has the libraries of all its targets, each on a boundary of the largest memory page.
fn universal(targets: &[&'static str], bytes: &[u8], private: &[PathBuf]) -> Result<Vec<Finding>> {
    const PAGE: u32 = 0x4000;
    let parts = MultiArch::new(bytes)?.arches()?;
    let found: Vec<_> = parts
        .iter()
        .map(|part| format!("{} at {:#x}", macho::processor(part.cputype), part.offset))
        .collect();
    let processors: BTreeSet<_> = parts.iter().map(|part| macho::processor(part.cputype)).collect();
    let wanted: BTreeSet<_> = targets.iter().map(|target| processor(target)).collect();
    let aligned = parts.iter().all(|part| part.offset.is_multiple_of(PAGE));
    let wanted_text = wanted.iter().copied().collect::<Vec<_>>().join(" and ");
    let mut findings = vec![Finding {
        target: "universal".to_owned(),
        check: "libraries",
        found: found.join(", "),
        allowed: format!("{wanted_text}, each at a multiple of {PAGE:#x}"),
        passed: processors == wanted && parts.len() == targets.len() && aligned,
    }];
    for target in targets {
        let part = parts
            .iter()
            .find(|part| macho::processor(part.cputype) == processor(target));
        let range = part.map(|part| part.offset as usize..part.offset as usize + part.size as usize);
        if let Some(library) = range.and_then(|range| bytes.get(range)) {
            findings.extend(single(target, library, private)?);
        }
    }
    Ok(findings)
}

/// Checks the library of one target.
fn single(target: &str, bytes: &[u8], private: &[PathBuf]) -> Result<Vec<Finding>> {
    let mut report = Report {
        target,
        findings: Vec::new(),
    };
    if target.contains("linux") {
        elf::check(&mut report, bytes)?;
    } else if target.contains("windows") {
        pe::check(&mut report, bytes)?;
    } else {
        macho::check(&mut report, bytes)?;
    }
    report.add(
        "size",
        format!("{} bytes", bytes.len()),
        format!("under {SIZE} bytes"),
        bytes.len() < SIZE,
    );
    let (guid, served) = (variables::GUID, position(bytes, variables::GUID).is_some());
    report.add("GUID", if served { guid } else { "another" }, guid, served);
    let paths: Vec<_> = private.iter().filter_map(|folder| path_within(bytes, folder)).collect();
    report.add("paths", listed(&paths), "none of this machine", paths.is_empty());
    Ok(report.findings)
}

/// The findings on one library while they are made.
struct Report<'a> {
    target: &'a str,
    findings: Vec<Finding>,
}

impl Report<'_> {
    fn add(&mut self, check: &'static str, found: impl Into<String>, allowed: impl Into<String>, passed: bool) {
        self.findings.push(Finding {
            target: self.target.to_owned(),
            check,
            found: found.into(),
            allowed: allowed.into(),
            passed,
        });
    }

    /// The format, and the processor that goes with the target.
    fn kind(&mut self, format: &str, is_library: bool, found: &str) {
        let wanted = processor(self.target);
        let kind = if is_library { "library" } else { "no library" };
        self.add(
            "kind",
            format!("{format} {kind}, {found}"),
            format!("{format} library, {wanted}"),
            is_library && found == wanted,
        );
    }

    /// Exported are the functions of the C header, and nothing else.
    fn exports(&mut self, exported: &BTreeSet<String>) {
        let declared = declared();
        let stray: Vec<_> = exported.difference(&declared).collect();
        let missing: Vec<_> = declared.difference(exported).collect();
        let some = |what, names: &[&String]| match names {
            [] => String::new(),
            [name] => format!(", {what} {name}"),
            [first, others @ ..] => format!(", {what} {first} and {} more", others.len()),
        };
        let [strays, gaps] = [some("not declared", &stray), some("missing", &missing)];
        let found = format!("{} symbols{strays}{gaps}", exported.len());
        let allowed = format!("the {} functions of the C header", declared.len());
        self.add(
            "exported symbols",
            found,
            allowed,
            stray.is_empty() && missing.is_empty(),
        );
    }

    /// Every name is one of those allowed; a final `*` stands for any ending.
    fn only(&mut self, check: &'static str, found: &[impl AsRef<str>], allowed: &[&str]) {
        let fits = |name: &str| {
            allowed.iter().any(|pattern| match pattern.strip_suffix('*') {
                Some(start) => name.starts_with(start),
                None => name == *pattern,
            })
        };
        let passed = found.iter().all(|name| fits(name.as_ref()));
        self.add(check, listed(found), listed(allowed), passed);
    }
}

fn listed(names: &[impl AsRef<str>]) -> String {
    let names: Vec<_> = names.iter().map(AsRef::as_ref).collect();
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

/// The processor in a target's name.
fn processor(target: &str) -> &str {
    target.split('-').next().unwrap_or(target)
}

/// The functions that the C header declares.
pub fn declared() -> BTreeSet<String> {
    let code = C_HEADER.lines().filter(|line| !line.trim_start().starts_with('*'));
    code.filter_map(|line| {
        let (before, _) = line.split_once('(')?;
        let name = before.rsplit([' ', '*']).next()?;
        name.starts_with("fmi2").then(|| name.to_owned())
    })
    .collect()
}

fn position(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
}

/// The first path within `folder` that the bytes hold, if any.
fn path_within(bytes: &[u8], folder: &Path) -> Option<String> {
    let folder = folder.to_string_lossy();
    let starts = ['/', '\\'].map(|separator| format!("{folder}{separator}"));
    let at = starts.iter().find_map(|start| position(bytes, start))?;
    let text = bytes
        .get(at..)?
        .iter()
        .take(100)
        .take_while(|byte| byte.is_ascii_graphic());
    Some(text.map(|byte| char::from(*byte)).collect())
}
