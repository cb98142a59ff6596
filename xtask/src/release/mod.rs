//! The component for all platforms in one archive.

pub mod build;
pub mod check;
pub mod platform;
pub mod tools;
pub mod trial;

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::commands::write;
use anyhow::{Result, ensure};
use clap::builder::PossibleValuesParser;
use sha2::{Digest, Sha256};

use self::platform::{PLATFORMS, Platform};
use self::tools::Tools;
use crate::package::pack;
use crate::variant::Variant;
use crate::{explore, fmu, python, wheel};

#[derive(clap::Args)]
pub struct Arguments {
    /// Only these platforms
    #[arg(value_parser = PossibleValuesParser::new(PLATFORMS.map(|platform| platform.folder)))]
    platforms: Vec<String>,
}

/// Builds, checks and tries the libraries, and writes `dist/release/RelayContact.fmu` with `SHA256SUMS` beside it and a Python
/// package for each platform that carries its libraries and the page. A platform that cannot be built is omitted, and the command fails at the end.
pub fn run(arguments: &Arguments) -> Result<()> {
    let tools = Tools::find()?;
    let private = check::private_folders(&tools.rust.rustc)?;
    let asked = |platform: &&Platform| {
        arguments.platforms.is_empty() || arguments.platforms.iter().any(|name| name == platform.folder)
    };
    let (mut libraries, mut lines, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for platform in PLATFORMS.iter().filter(asked) {
        println!("== {}", platform.folder);
        match built(platform, &tools, &private) {
            Ok((library, trial)) => {
                lines.push(format!("{:15} {:7} bytes  {trial}", platform.folder, library.len()));
                libraries.push((platform, library));
            }
            Err(error) => {
                println!("{error:#}");
                lines.push(format!("{:15} LEFT OUT, see above", platform.folder));
                left_out.push(platform.folder);
            }
        }
    }
    ensure!(!libraries.is_empty(), "no platform could be built");
    let runs_here = libraries.iter().any(|(platform, _)| platform.is_host());
    let full = packed(&libraries, &tools)?;
    let archive = write("dist/release/RelayContact.fmu", &full)?;
    write("dist/release/SHA256SUMS", sum("RelayContact.fmu", &full))?;
    explore::page()?;
    let wheels: BTreeSet<_> = libraries.iter().map(|(platform, _)| platform.wheel()).collect();
    for wheel in wheels {
        let carried = libraries.iter().filter(|(platform, _)| platform.wheel() == wheel);
        let carried = packed(&carried.cloned().collect::<Vec<_>>(), &tools)?;
        let folder = build::folder()?.join("wheels").join(&wheel);
        let component = write(folder.join("RelayContact.fmu"), &carried)?;
        wheel::build(&component, "dist/release", Some(&wheel))?;
    }
    println!("== FMPy");
    if runs_here {
        // The archive alone, without its variants.
        let own = "not plain and not sprung and not carries";
        python::test(&["conformance/python/test_validate.py", "-k", own], &archive)?;
        python::test(&["tests/python/test_effects_outputs.py"], &archive)?;
    } else {
        println!("NOT RUN, the archive has no library for this machine");
    }
    println!("== dist/release/RelayContact.fmu\n{}", lines.join("\n"));
    ensure!(left_out.is_empty(), "the archive lacks {}", left_out.join(", "));
    Ok(())
}

/// The archive with these libraries.
fn packed(libraries: &[(&Platform, Vec<u8>)], tools: &Tools) -> Result<Vec<u8>> {
    let targets: Vec<_> = libraries.iter().flat_map(|(platform, _)| platform.targets.iter().copied()).collect();
    let binaries = libraries.iter().map(|(platform, library)| (platform.folder, platform.extension, library.clone()));
    pack(&fmu::files(&Variant::new(false, None)?, binaries, &tools.rust.rustc, &targets, tools.licences()?)?)
}

/// The library of a platform, checked, and what its trial showed. `private` are folders of this machine whose paths it may not
/// contain.
fn built(platform: &Platform, tools: &Tools, private: &[PathBuf]) -> Result<(Vec<u8>, String)> {
    let (mut parts, mut failed) = (Vec::new(), Vec::new());
    for target in platform.targets {
        let part = build::library(target, tools)?;
        let report = check::library(target, &part, private)?;
        print!("{}", report.text);
        failed.extend(report.failed.iter().map(|check| format!("{target}: {check}")));
        parts.push(part);
    }
    ensure!(failed.is_empty(), "checks failed: {}", failed.join(", "));
    let library = match parts.as_slice() {
        [one] => one.clone(),
        several => check::join(several)?,
    };
    let name = format!("RelayContact.{}", platform.extension);
    let path = write(build::folder()?.join("libraries").join(platform.folder).join(name), &library)?;
    let trial = trial::run(platform, &path, &tools.zig)?;
    println!("{trial}");
    Ok((library, trial))
}

/// A file's line of `SHA256SUMS`, as `sha256sum --check` reads it.
fn sum(name: &str, contents: &[u8]) -> String {
    let digits = Sha256::digest(contents).iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"));
    format!("{digits}  {name}\n")
}

#[cfg(test)]
mod tests {
    /// The example "abc" of FIPS 180-4.
    #[test]
    fn a_sum_is_the_digest_and_the_name() {
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(super::sum("a.so", b"abc"), format!("{digest}  a.so\n"));
    }
}
