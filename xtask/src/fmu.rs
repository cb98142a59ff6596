//! Builds the component and packs it.

use std::collections::BTreeSet;
use std::env;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};

use crate::commands::{cargo, is_there, read, root, run, write};
use anyhow::{Result, bail};
use relay_contact::C_HEADER;

use crate::package::{Files, pack};
use crate::release::platform::Platform;
use crate::variant::Variant;
use crate::{bill, documentation, licences, linked};

/// Where the component is.
pub fn path() -> PathBuf {
    root().join("dist/RelayContact.fmu")
}

/// Writes the component as `dist/RelayContact.fmu` and returns its path.
pub fn build() -> Result<PathBuf> {
    build_variant(&Variant::new(false, None)?)
}

/// Writes a variant of the component as `dist/NAME.fmu` and returns its path. Also writes, for C programs, the library to
/// `lib` and its header to `include`.
pub fn build_variant(variant: &Variant) -> Result<PathBuf> {
    build_library()?;
    let host = Platform::host()?;
    let name = format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}");
    let library = read(linked::metadata()?.target_directory.as_std_path().join("release").join(&name))?;
    write("dist/include/relay_contact.h", C_HEADER)?;
    write(format!("dist/lib/{name}"), &library)?;
    let libraries = [(host.folder, host.extension, library)];
    let files = files(variant, libraries, Path::new("rustc"), &[], Files::new())?;
    write(format!("dist/{}.fmu", variant.name), &pack(&files)?)
}

/// Cargo's arguments to build a package's shared library only, as otherwise it is not optimised across crates.
pub const CARGO_RUSTC: [&str; 4] = ["rustc", "--release", "--lib", "--crate-type=cdylib"];

fn build_library() -> Result<()> {
    let mut build = cargo();
    build.args(CARGO_RUSTC).arg("--package=relay-contact");
    // Cargo takes rustc's flags from one place only, so these are added to the user's.
    let given = |name, separator: char| {
        let flags = env::var(name).ok()?;
        let flags = flags.split(separator).filter(|flag| !flag.is_empty());
        Some(flags.map(str::to_owned).collect::<Vec<_>>())
    };
    let ours = path_flags()?;
    if let Some(flags) = given("CARGO_ENCODED_RUSTFLAGS", '\x1f').or_else(|| given("RUSTFLAGS", ' ')) {
        build.env("CARGO_ENCODED_RUSTFLAGS", [flags, ours].concat().join("\x1f"));
    } else {
        build.arg(format!("--config=build.rustflags={ours:?}"));
    }
    let built = run(&mut build);
    // Rust links with the C compiler; its own message is less clear.
    if built.is_err() && cfg!(unix) && !is_there("cc") {
        bail!("no C compiler: Rust needs one to link (on Debian: apt-get install gcc libc6-dev)");
    }
    built
}

/// Flags that remove the folders of this machine from the library: without them panic messages contain full paths of
/// source files.
pub fn path_flags() -> Result<Vec<String>> {
    let metadata = linked::metadata()?;
    let foreign = metadata.packages.iter().filter(|package| package.source.is_some());
    let crates: BTreeSet<_> = foreign.filter_map(|package| package.manifest_path.parent()?.parent()).collect();
    let crates = crates.iter().map(|folder| format!("--remap-path-prefix={folder}=crates"));
    let project = format!("--remap-path-prefix={}=relay-contact", metadata.workspace_root);
    Ok(crates.chain([project]).collect())
}

/// The contents of the archive. Libraries come with their folder and extension; `rustc` is the compiler whose standard
/// library they contain; `targets` are their platforms as it calls them, none stands for this machine; `more_licences` are
/// those of what is linked beside the crates.
pub fn files<'a>(
    variant: &Variant,
    libraries: impl IntoIterator<Item = (&'a str, &'a str, Vec<u8>)>,
    rustc: &Path,
    targets: &[&str],
    more_licences: Files,
) -> Result<Files> {
    let crates = linked::crates(targets)?;
    let mut files = licences::texts(&crates, rustc, more_licences)?;
    for (path, contents) in [
        ("modelDescription.xml", variant.description.clone().into_bytes()),
        ("model.png", read("docs/model.png")?),
        ("documentation/index.html", documentation::page(variant)?.into_bytes()),
        ("documentation/sbom.cdx.json", bill::text(&crates, rustc)?.into_bytes()),
    ] {
        files.insert(path.to_owned(), contents);
    }
    for name in ["terminalsAndIcons.xml", "icon.png", "icon.svg", "pin.png", "pin.svg"] {
        let path = format!("terminalsAndIcons/{name}");
        let contents = read(format!("docs/{path}"))?;
        files.insert(path, contents);
    }
    if let Some((name, text)) = &variant.spring {
        files.insert(format!("resources/{name}"), text.clone().into_bytes());
    }
    for (folder, extension, library) in libraries {
        files.insert(format!("binaries/{folder}/RelayContact.{extension}"), library);
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_but_the_library_is_the_same_bytes_every_time() -> Result<()> {
        let variant = Variant::new(false, None)?;
        let files = || files(&variant, [], Path::new("rustc"), &[], Files::new());
        assert_eq!(pack(&files()?)?, pack(&files()?)?);
        Ok(())
    }
}
