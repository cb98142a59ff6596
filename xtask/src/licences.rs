//! The licence texts of everything that is linked into the component.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use cargo_metadata::{Metadata, Package};

use crate::commands::{cargo, command, output, root};
use crate::package::Files;

/// Texts by path below `documentation/licenses/`: ours, a folder for each crate, and the Rust standard library's.
pub fn texts(metadata: &Metadata) -> Result<Files> {
    let mut files = Files::new();
    for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let text = fs::read(root().join(name)).with_context(|| format!("cannot read {name}"))?;
        files.insert(name.to_owned(), text);
    }
    for package in linked(metadata)? {
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
    let sysroot = output(command("rustc").args(["--print", "sysroot"]))?;
    let standard = Path::new(sysroot.trim()).join("share/doc/rust/COPYRIGHT-library.html");
    match fs::read(&standard) {
        Ok(text) => {
            files.insert("rust-standard-library/COPYRIGHT-library.html".to_owned(), text);
        }
        Err(error) => eprintln!(
            "licence of the Rust standard library left out, {}: {error}",
            standard.display()
        ),
    }
    Ok(files)
}

/// The crates linked into the library. `cargo tree` is asked because, unlike `cargo metadata`, it resolves features
/// for this one package.
fn linked(metadata: &Metadata) -> Result<Vec<&Package>> {
    let tree = output(cargo().args([
        "tree",
        "--package=relay-contact",
        "--edges=normal,no-proc-macro",
        "--prefix=none",
        "--format={p}",
    ]))?;
    let names: BTreeSet<(&str, &str)> = tree
        .lines()
        .filter_map(|line| {
            let mut words = line.split(' ');
            Some((words.next()?, words.next()?.strip_prefix('v')?))
        })
        .collect();
    names
        .into_iter()
        .filter(|(name, _)| *name != "relay-contact")
        .map(|(name, version)| {
            metadata
                .packages
                .iter()
                .find(|package| package.name.as_str() == name && package.version.to_string() == version)
                .with_context(|| format!("cargo metadata does not know {name} {version}"))
        })
        .collect()
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
