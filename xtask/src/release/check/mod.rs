//! Checks of the bytes of a built library: that it loads on its platform, and contains no private or unexpected data.

mod elf;
mod macho;
mod pe;
mod report;
#[cfg(test)]
mod tests;

use std::env;
use std::path::{Path, PathBuf};

use crate::commands::sysroot;
use crate::linked::metadata;
use anyhow::Result;
use relay_contact::variables;

pub use self::macho::join;
pub use self::pe::without_time;
use self::report::Report;
pub use self::report::{declared, processor};

/// Size limit of a library, in bytes. The step is compiled for each number of stages, on x86 for two instruction sets.
const SIZE: usize = 3_000_000;

/// Checks the library of a target. `private` are folders of this machine whose paths must not be inside, see
/// [`private_folders`]. An error if the file is not of the target's format.
pub fn library(target: &'static str, bytes: &[u8], private: &[PathBuf]) -> Result<Report> {
    let mut report = Report { target, text: String::new(), failed: Vec::new() };
    if target.contains("linux") {
        elf::check(&mut report, bytes)?;
    } else if target.contains("windows") {
        pe::check(&mut report, bytes)?;
    } else {
        macho::check(&mut report, bytes)?;
    }
    report.add("size", format!("{} bytes", bytes.len()), format!("under {SIZE} bytes"), bytes.len() < SIZE);
    let (guid, found) = (variables::GUID, position(bytes, variables::GUID).is_some());
    report.add("GUID", if found { guid } else { "another" }, guid, found);
    let paths: Vec<_> = private.iter().filter_map(|folder| path_within(bytes, folder)).collect();
    report.only("paths", &paths, &[]);
    Ok(report)
}

/// Folders that differ between machines: of the project, its build, the compiler `rustc`, cargo and the user.
pub fn private_folders(rustc: &Path) -> Result<Vec<PathBuf>> {
    let metadata = metadata()?;
    let compiler = sysroot(rustc)?.join("lib").join("rustlib");
    let project = [&metadata.workspace_root, &metadata.target_directory].map(Into::into);
    let user = ["HOME", "USERPROFILE", "CARGO_HOME", "RUSTUP_HOME"].into_iter().filter_map(env::var_os);
    let folders = project.into_iter().chain([compiler]).chain(user.map(PathBuf::from));
    // `/` would be found everywhere.
    Ok(folders.filter(|folder| folder.parent().is_some()).collect())
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
