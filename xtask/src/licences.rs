//! The licence texts of everything that is linked into the component.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Context, Result, bail};
use cargo_metadata::Metadata;

use crate::commands::{root, sysroot};
use crate::linked::{COMPONENT, graph, package};
use crate::package::Files;

/// Texts by path below `documentation/licenses/`: ours, a folder for each crate, and the Rust standard library's, which is
/// that of the compiler `rustc`; `targets` are as for [`graph`].
pub fn texts(metadata: &Metadata, rustc: &Path, targets: &[&str]) -> Result<Files> {
    let mut files = Files::new();
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let text = fs::read(root().join(name)).with_context(|| format!("cannot read {name}"))?;
        files.insert(name.to_owned(), text);
    }
    for crate_ in graph(targets)?.keys().filter(|(name, _)| name != COMPONENT) {
        let package = package(metadata, crate_)?;
        let folder = format!("{}-{}", package.name, package.version);
        let texts = licence_files(
            package
                .manifest_path
                .parent()
                .context("a crate without a folder")?
                .as_std_path(),
        )?;
        if texts.is_empty() {
            bail!("crate {folder} is linked into the component but comes without a licence text");
        }
        for (name, text) in texts {
            files.insert(format!("{folder}/{name}"), text);
        }
    }
    if let Some((name, text)) = standard_library(rustc)? {
        files.insert(format!("rust-standard-library/{name}"), text);
    }
    Ok(files)
}

/// The licence text of the standard library, where rustup or Debian's packages put it below the compiler's folder.
fn standard_library(rustc: &Path) -> Result<Option<(String, Vec<u8>)>> {
    let documentation = sysroot(rustc)?.join("share/doc");
    let places = [
        "rust/COPYRIGHT-library.html",
        "libstd-rust-web-dev/copyright",
        "libstd-rust-dev/copyright",
    ];
    for place in places {
        let path = documentation.join(place);
        let name = path.file_name().context("a text without a name")?.to_string_lossy();
        match fs::read(&path) {
            Ok(text) => return Ok(Some((name.into_owned(), text))),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", path.display())),
        }
    }
    eprintln!(
        "licence of the Rust standard library left out: {} has none of {}",
        documentation.display(),
        places.join(", ")
    );
    Ok(None)
}

/// The files of a crate's top folder whose name says that they are about its licence.
fn licence_files(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let about = ["license", "licence", "copying", "copyright", "notice", "unlicense"];
        let lower = name.to_lowercase();
        if about.iter().any(|word| lower.starts_with(word)) && entry.file_type()?.is_file() {
            files.insert(name, fs::read(entry.path())?);
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
        let (name, text) = standard_library(Path::new("rustc"))?.context("no licence of the standard library")?;
        assert!(name.to_lowercase().starts_with("copyright"));
        assert!(String::from_utf8(text)?.contains("Apache"));
        Ok(())
    }
}
