//! The licence texts of everything that is linked into the component.

use std::fs;
use std::path::Path;

use crate::commands::{read, sysroot};
use anyhow::{Context, Result, bail};

use crate::linked::{COMPONENT, Crates};
use crate::package::Files;

/// Their folder in the archive.
const FOLDER: &str = "documentation/licenses";

/// The licences of this project, of each crate, of the Rust standard library of the compiler `rustc`, and those given, with
/// a list of all, `license.txt`, where FMI 2.0.3 has importers look.
pub fn texts(crates: &Crates, rustc: &Path, mut files: Files) -> Result<Files> {
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        files.insert(format!("{FOLDER}/{name}"), read(name)?);
    }
    let packages = crates.values().map(|linked| linked.package);
    for package in packages.filter(|package| package.name != COMPONENT) {
        let crate_ = format!("{}-{}", package.name, package.version);
        let source = package.manifest_path.parent().context("a crate without a folder")?;
        let texts = of_crate(source.as_std_path())?;
        if texts.is_empty() {
            bail!("crate {crate_} is linked into the component but comes without a licence text");
        }
        let texts = texts.into_iter();
        files.extend(texts.map(|(text, contents)| (format!("{FOLDER}/{crate_}/{text}"), contents)));
    }
    if let Some((name, text)) = standard_library(rustc)? {
        files.insert(format!("{FOLDER}/rust-standard-library/{name}"), text);
    }
    let names = files.keys().filter_map(|path| path.strip_prefix(FOLDER)?.strip_prefix('/'));
    let list = format!(
        "RelayContact is licensed under MIT OR Apache-2.0, at your choice. Its library contains other people's work; \
         all licences are in this folder:\n\n{}\n",
        names.collect::<Vec<_>>().join("\n")
    );
    files.insert(format!("{FOLDER}/license.txt"), list.into_bytes());
    Ok(files)
}

/// The licence text of the standard library, where rustup or Debian's packages put it.
fn standard_library(rustc: &Path) -> Result<Option<(&'static str, Vec<u8>)>> {
    let documentation = sysroot(rustc)?.join("share/doc");
    for (folder, name) in
        [("rust", "COPYRIGHT-library.html"), ("libstd-rust-web-dev", "copyright"), ("libstd-rust-dev", "copyright")]
    {
        let path = documentation.join(folder).join(name);
        if path.exists() {
            return Ok(Some((name, read(path)?)));
        }
    }
    let documentation = documentation.display();
    eprintln!("WARNING: no licence of the Rust standard library in {documentation}: the archive does not contain it");
    Ok(None)
}

/// The licence files of a crate, by their names.
fn of_crate(folder: &Path) -> Result<Files> {
    let mut files = Files::new();
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let about = ["license", "licence", "copying", "copyright", "notice", "unlicense"];
        let lower = name.to_lowercase();
        if about.iter().any(|word| lower.starts_with(word)) && entry.file_type()?.is_file() {
            files.insert(name, read(entry.path())?);
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Rust of this machine comes with its documentation or with that of the Debian packages.
    #[test]
    fn the_licence_of_the_standard_library_is_found() -> Result<()> {
        let (_, text) = standard_library(Path::new("rustc"))?.context("no licence of the standard library")?;
        assert!(String::from_utf8(text)?.contains("Apache"));
        Ok(())
    }
}
