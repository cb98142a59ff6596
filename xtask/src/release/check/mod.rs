//! Checks of the bytes of a built library: that it loads on its platform, and contains no private or unexpected data.

mod elf;
mod macho;
mod pe;
mod report;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::env;
use std::path::{Path, PathBuf};

use crate::commands::sysroot;
use anyhow::Result;
use cargo_metadata::Metadata;
use goblin::mach::MultiArch;
use relay_contact::variables;

pub use self::macho::join;
pub use self::pe::without_time;
pub use self::report::declared;
use self::report::{Report, processor};
use super::platform::Platform;

/// Size limit of a library, in bytes; of each part of a universal library. The step is compiled for each number of stages, on x86
/// for two instruction sets.
const SIZE: usize = 3_000_000;

/// Checks the library of a platform. `private` are folders of this machine whose paths must not be inside, see
/// [`private_folders`]. An error if the file is not of the platform's format.
pub fn library(platform: &Platform, bytes: &[u8], private: &[PathBuf]) -> Result<Report> {
    let mut report = Report::default();
    match platform.targets {
        [target] => single(&mut report, target, bytes, private)?,
        targets => universal(&mut report, targets, bytes, private)?,
    }
    Ok(report)
}

/// Folders that differ between machines: of the project, its build, the compiler `rustc`, cargo and the user.
pub fn private_folders(metadata: &Metadata, rustc: &Path) -> Result<Vec<PathBuf>> {
    let compiler = sysroot(rustc)?.join("lib").join("rustlib");
    let project = [&metadata.workspace_root, &metadata.target_directory].map(Into::into);
    let user = ["HOME", "USERPROFILE", "CARGO_HOME", "RUSTUP_HOME"].into_iter().filter_map(env::var_os);
    let folders = project.into_iter().chain([compiler]).chain(user.map(PathBuf::from));
    // `/` would be found everywhere.
    Ok(folders.filter(|folder| folder.parent().is_some()).collect())
}

/// A universal library has the libraries of all its targets, each on a boundary of the largest memory page.
fn universal(report: &mut Report, targets: &[&'static str], bytes: &[u8], private: &[PathBuf]) -> Result<()> {
    const PAGE: u32 = 0x4000;
    let parts = MultiArch::new(bytes)?.arches()?;
    let found: Vec<_> =
        parts.iter().map(|part| format!("{} at {:#x}", macho::processor(part.cputype), part.offset)).collect();
    let processors: BTreeSet<_> = parts.iter().map(|part| macho::processor(part.cputype)).collect();
    let expected: BTreeSet<_> = targets.iter().map(|target| processor(target)).collect();
    let aligned = parts.iter().all(|part| part.offset.is_multiple_of(PAGE));
    let names = expected.iter().copied().collect::<Vec<_>>().join(" and ");
    report.target = "universal";
    report.add(
        "libraries",
        found.join(", "),
        format!("{names}, each at a multiple of {PAGE:#x}"),
        processors == expected && parts.len() == targets.len() && aligned,
    );
    for target in targets {
        let part = parts.iter().find(|part| macho::processor(part.cputype) == processor(target));
        let range = part.map(|part| part.offset as usize..part.offset as usize + part.size as usize);
        if let Some(library) = range.and_then(|range| bytes.get(range)) {
            single(report, target, library, private)?;
        }
    }
    Ok(())
}

/// Checks the library of one target.
fn single(report: &mut Report, target: &'static str, bytes: &[u8], private: &[PathBuf]) -> Result<()> {
    report.target = target;
    if target.contains("linux") {
        elf::check(report, bytes)?;
    } else if target.contains("windows") {
        pe::check(report, bytes)?;
    } else {
        macho::check(report, bytes)?;
    }
    report.add("size", format!("{} bytes", bytes.len()), format!("under {SIZE} bytes"), bytes.len() < SIZE);
    let (guid, found) = (variables::GUID, position(bytes, variables::GUID).is_some());
    report.add("GUID", if found { guid } else { "another" }, guid, found);
    let paths: Vec<_> = private.iter().filter_map(|folder| path_within(bytes, folder)).collect();
    report.only("paths", &paths, &[]);
    Ok(())
}

fn position(bytes: &[u8], text: &str) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text.as_bytes())
}

/// The first path within `folder` that the bytes contain, if any.
fn path_within(bytes: &[u8], folder: &Path) -> Option<String> {
    let folder = folder.to_string_lossy();
    let starts = ['/', '\\'].map(|separator| format!("{folder}{separator}"));
    let at = starts.iter().find_map(|start| position(bytes, start))?;
    let text = bytes.get(at..)?.iter().take(100).take_while(|byte| byte.is_ascii_graphic());
    Some(text.map(|byte| char::from(*byte)).collect())
}
