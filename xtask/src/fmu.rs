//! Builds the component and packs it.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use cargo_metadata::MetadataCommand;
use relay_contact::MODEL_DESCRIPTION;

use crate::commands::{cargo, command, output, root, run};
use crate::documentation;
use crate::licences;
use crate::package::{Files, pack};

/// Writes `dist/RelayContact.fmu` and gives its path.
pub fn build() -> Result<PathBuf> {
    build_library()?;
    let path = root().join("dist/RelayContact.fmu");
    fs::create_dir_all(root().join("dist"))?;
    fs::write(&path, pack(&files()?)?).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

fn build_library() -> Result<()> {
    let built = run(cargo().args(["build", "--release", "--package=relay-contact", "--lib"]));
    // Rust links with the C compiler's help, and says so less plainly.
    if built.is_err() && cfg!(unix) && output(command("cc").arg("--version")).is_err() {
        bail!("no C compiler: Rust needs one to link (on Debian: apt-get install gcc libc6-dev)");
    }
    built
}

fn files() -> Result<Files> {
    let metadata = MetadataCommand::new().current_dir(root()).exec()?;
    let (folder, prefix, extension) = platform()?;
    let library = metadata
        .target_directory
        .as_std_path()
        .join(format!("release/{prefix}relay_contact.{extension}"));
    let mut files = Files::from([
        ("modelDescription.xml".to_owned(), MODEL_DESCRIPTION.as_bytes().to_vec()),
        (format!("binaries/{folder}/RelayContact.{extension}"), read(&library)?),
        ("model.png".to_owned(), read(&root().join("docs/model.png"))?),
        (
            "documentation/index.html".to_owned(),
            documentation::page()?.into_bytes(),
        ),
    ]);
    for (path, text) in licences::texts(&metadata)? {
        files.insert(format!("documentation/licenses/{path}"), text);
    }
    Ok(files)
}

fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// The folder FMI 2.0 gives this machine's platform, and how a shared library is called there.
fn platform() -> Result<(&'static str, &'static str, &'static str)> {
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        Ok(("linux64", "lib", "so"))
    } else if cfg!(all(target_os = "windows", target_arch = "x86_64")) {
        Ok(("win64", "", "dll"))
    } else if cfg!(target_os = "macos") {
        Ok(("darwin64", "lib", "dylib"))
    } else {
        bail!("FMI 2.0 has no name for this platform; it knows 64-bit x86 Linux and Windows, and macOS")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documentation_and_licences_are_the_same_bytes_every_time() -> Result<()> {
        let metadata = MetadataCommand::new().current_dir(root()).exec()?;
        let first = licences::texts(&metadata)?;
        assert!(first.contains_key("LICENSE-MIT") && first.keys().any(|path| path.starts_with("nalgebra-")));
        assert_eq!(pack(&first)?, pack(&licences::texts(&metadata)?)?);
        assert_eq!(documentation::page()?, documentation::page()?);
        Ok(())
    }
}
