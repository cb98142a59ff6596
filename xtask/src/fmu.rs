//! Builds the component and packs it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use anyhow::{Context, Result, bail};
use cargo_metadata::{Metadata, MetadataCommand};
use relay_contact::{C_HEADER, MODEL_DESCRIPTION};

use crate::bill;
use crate::commands::{cargo, command, output, root, run};
use crate::documentation;
use crate::licences;
use crate::package::{Files, pack};

/// Writes `dist/RelayContact.fmu` and gives its path. Beside it, for C programs, the library in `lib` and its header in
/// `include`.
pub fn build() -> Result<PathBuf> {
    let metadata = MetadataCommand::new().current_dir(root()).exec()?;
    build_library(&metadata)?;
    let (folder, prefix, extension) = platform()?;
    let name = format!("{prefix}relay_contact.{extension}");
    let library = read(&metadata.target_directory.as_std_path().join("release").join(&name))?;
    write("include/relay_contact.h", C_HEADER.as_bytes())?;
    write(&format!("lib/{name}"), &library)?;
    let files = files(&metadata, [(folder, extension, library)], Path::new("rustc"), &[])?;
    write("RelayContact.fmu", &pack(&files)?)
}

/// Writes a file in `dist` and gives its path.
pub fn write(name: &str, contents: &[u8]) -> Result<PathBuf> {
    let path = root().join("dist").join(name);
    fs::create_dir_all(path.parent().context("a file without a folder")?)?;
    fs::write(&path, contents).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// Cargo's arguments that build the shared library. It alone, as only then it is optimised across crates.
pub const CARGO_RUSTC: [&str; 5] = [
    "rustc",
    "--release",
    "--package=relay-contact",
    "--lib",
    "--crate-type=cdylib",
];

fn build_library(metadata: &Metadata) -> Result<()> {
    let mut build = cargo();
    build.args(CARGO_RUSTC);
    // Cargo takes rustc's flags from one place alone, so ours go where the user's are.
    let given = |name, separator: char| {
        let flags = env::var(name).ok()?;
        let flags = flags.split(separator).filter(|flag| !flag.is_empty());
        Some(flags.map(str::to_owned).collect::<Vec<_>>())
    };
    let ours = path_flags(metadata);
    if let Some(flags) = given("CARGO_ENCODED_RUSTFLAGS", '\x1f').or_else(|| given("RUSTFLAGS", ' ')) {
        build.env("CARGO_ENCODED_RUSTFLAGS", [flags, ours].concat().join("\x1f"));
    } else {
        build.arg(format!("--config=build.rustflags={ours:?}"));
    }
    let built = run(&mut build);
    // Rust links with the C compiler's help, and says so less plainly.
    if built.is_err() && cfg!(unix) && output(command("cc").arg("--version")).is_err() {
        bail!("no C compiler: Rust needs one to link (on Debian: apt-get install gcc libc6-dev)");
    }
    built
}

/// Flags that keep the folders of this machine out of the library: without them its messages of panics name their
/// source files by whole path.
pub fn path_flags(metadata: &Metadata) -> Vec<String> {
    let foreign = metadata.packages.iter().filter(|package| package.source.is_some());
    let crates: BTreeSet<_> = foreign
        .filter_map(|package| package.manifest_path.parent()?.parent())
        .collect();
    let crates = crates
        .iter()
        .map(|folder| format!("--remap-path-prefix={folder}=crates"));
    let project = format!("--remap-path-prefix={}=relay-contact", metadata.workspace_root);
    crates.chain([project]).collect()
}

/// What is in the archive: libraries come with folder and extension. `rustc` is the compiler whose standard library they
/// have, `targets` are their platforms as it calls them, this machine's where there are none.
pub fn files<'a>(
    metadata: &Metadata,
    libraries: impl IntoIterator<Item = (&'a str, &'a str, Vec<u8>)>,
    rustc: &Path,
    targets: &[&str],
) -> Result<Files> {
    let mut files = Files::from([
        ("modelDescription.xml".to_owned(), MODEL_DESCRIPTION.as_bytes().to_vec()),
        ("model.png".to_owned(), read(&root().join("docs/model.png"))?),
        (
            "documentation/index.html".to_owned(),
            documentation::page()?.into_bytes(),
        ),
    ]);
    for (folder, extension, library) in libraries {
        files.insert(format!("binaries/{folder}/RelayContact.{extension}"), library);
    }
    let bill = bill::text(metadata, rustc, targets)?;
    files.insert("documentation/sbom.cdx.json".to_owned(), bill.into_bytes());
    for (path, text) in licences::texts(metadata, rustc, targets)? {
        files.insert(format!("documentation/licenses/{path}"), text);
    }
    Ok(files)
}

pub fn read(path: &Path) -> Result<Vec<u8>> {
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
        bail!(
            "importers on this platform look for no library of its own: FMI 2.0 names 64-bit x86 Linux and Windows, and macOS"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documentation_and_licences_are_the_same_bytes_every_time() -> Result<()> {
        let metadata = MetadataCommand::new().current_dir(root()).exec()?;
        let first = licences::texts(&metadata, Path::new("rustc"), &[])?;
        assert!(first.contains_key("LICENSE-MIT") && first.keys().any(|path| path.starts_with("nalgebra-")));
        assert_eq!(
            pack(&first)?,
            pack(&licences::texts(&metadata, Path::new("rustc"), &[])?)?
        );
        assert_eq!(documentation::page()?, documentation::page()?);
        assert!(files(&metadata, [], Path::new("rustc"), &[])?.contains_key("documentation/sbom.cdx.json"));
        Ok(())
    }
}
