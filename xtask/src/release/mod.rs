//! The component for all platforms in one archive.

pub mod build;
pub mod check;
pub mod platform;
pub mod sums;
pub mod tools;
pub mod trial;
pub mod universal;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use cargo_metadata::{Metadata, MetadataCommand};
use clap::builder::PossibleValuesParser;

use crate::commands::root;
use crate::package::{Files, pack};
use crate::{fmu, test};
use platform::{PLATFORMS, Platform};
use tools::Tools;
use trial::Outcome;

#[derive(clap::Args)]
pub struct Arguments {
    /// Only these platforms
    #[arg(value_parser = PossibleValuesParser::new(PLATFORMS.map(|platform| platform.folder)))]
    platforms: Vec<String>,
}

/// Builds, checks and tries the libraries, and writes `dist/release/RelayContact.fmu` with `SHA256SUMS` beside it. A platform
/// that cannot be built is left out, and the command fails in the end.
pub fn run(arguments: &Arguments) -> Result<()> {
    let metadata = MetadataCommand::new().current_dir(root()).exec()?;
    let tools = Tools::find()?;
    let asked = |platform: &&Platform| {
        arguments.platforms.is_empty() || arguments.platforms.iter().any(|name| name == platform.folder)
    };
    let mut release = Release {
        metadata: &metadata,
        tools: &tools,
        private: check::private_folders(&metadata, &tools.rustc)?,
        built: BTreeMap::new(),
    };
    let (mut libraries, mut lines, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for platform in PLATFORMS.iter().filter(asked) {
        println!("== {}", platform.folder);
        match release.platform(platform) {
            Ok((library, outcome)) => {
                lines.push(format!("{:15} {:7} bytes  {outcome}", platform.folder, library.len()));
                libraries.push((platform, library));
            }
            Err(error) => {
                println!("{error:#}");
                lines.push(format!("{:15} LEFT OUT, see above", platform.folder));
                left_out.push(platform.folder);
            }
        }
    }
    if libraries.is_empty() {
        bail!("no platform could be built");
    }
    let targets: Vec<_> = libraries
        .iter()
        .flat_map(|(platform, _)| platform.targets.iter().copied())
        .collect();
    let binaries = libraries
        .iter()
        .map(|(platform, library)| (platform.folder, platform.extension, library.clone()));
    let mut files = fmu::files(&metadata, binaries, &tools.rustc, &targets)?;
    for (path, text) in tools.licences()? {
        files.insert(format!("documentation/licenses/{path}"), text);
    }
    let packed = pack(&files)?;
    let archive = fmu::write("release/RelayContact.fmu", &packed)?;
    let sums = sums::text(&Files::from([("RelayContact.fmu".to_owned(), packed)]));
    fmu::write("release/SHA256SUMS", sums.as_bytes())?;
    println!("== FMPy");
    if libraries.iter().any(|(platform, _)| trial::is_host(platform)) {
        for tests in ["test_validate.py", "test_check_values.py", "test_paper.py"] {
            test::pytest(&format!("conformance/python/{tests}"), &archive)?;
        }
    } else {
        println!("NOT RUN, the archive has no library for this machine");
    }
    println!("== dist/release/RelayContact.fmu\n{}", lines.join("\n"));
    if !left_out.is_empty() {
        bail!("the archive lacks {}", left_out.join(", "));
    }
    Ok(())
}

struct Release<'a> {
    metadata: &'a Metadata,
    tools: &'a Tools,
    /// Folders of this machine whose paths no library may hold.
    private: Vec<PathBuf>,
    /// Libraries by what rustc calls their platforms.
    built: BTreeMap<&'static str, Vec<u8>>,
}

impl Release<'_> {
    /// The library of a platform, checked, and how it was tried.
    fn platform(&mut self, platform: &Platform) -> Result<(Vec<u8>, Outcome)> {
        let mut parts = Vec::new();
        for target in platform.targets {
            if !self.built.contains_key(target) {
                let library = build::library(target, self.tools, self.metadata)?;
                self.built.insert(target, library);
            }
            parts.extend(self.built.get(target).cloned());
        }
        let library = match parts.as_slice() {
            [one] => one.clone(),
            several => universal::join(several)?,
        };
        let findings = check::library(platform, &library, &self.private)?;
        for finding in &findings {
            println!("{finding}");
        }
        check::demand(platform.folder, &findings)?;
        let folder = build::folder(self.metadata).join("libraries").join(platform.folder);
        fs::create_dir_all(&folder)?;
        let path = folder.join(format!("RelayContact.{}", platform.extension));
        fs::write(&path, &library).with_context(|| format!("cannot write {}", path.display()))?;
        let outcome = trial::run(platform, &path, &self.tools.zig)?;
        println!("{outcome}");
        Ok((library, outcome))
    }
}
