//! Builds the component and packs it.

use std::collections::BTreeSet;
use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use cargo_metadata::Metadata;
use commands::{cargo, command, output, read, run, write};
use relay_contact::scene::spring::SpringFile;
use relay_contact::{C_HEADER, MODEL_DESCRIPTION};

use crate::package::{Files, pack};
use crate::{bill, documentation, licences, linked, plain};

/// Writes `dist/RelayContact.fmu` and returns its path. Also writes, for C programs, the library to `lib` and its
/// header to `include`.
pub fn build() -> Result<PathBuf> {
    write("dist/RelayContact.fmu", &pack(&package(None)?)?)
}

/// Writes the component as `dist/RelayContact.fmu`, or with what is added to that name: `-plain` has integers as choices,
/// `-NAME` carries the spring file NAME.toml. Returns its path.
pub fn build_variant(plain: bool, spring: Option<&Path>) -> Result<PathBuf> {
    if !plain && spring.is_none() {
        return build();
    }
    let spring = spring.map(Spring::read).transpose()?;
    let mut files = package(spring.as_ref())?;
    let mut name = String::from("RelayContact");
    let mut description = if plain {
        plain::description()?
    } else {
        MODEL_DESCRIPTION.to_owned()
    };
    if plain {
        name.push_str("-plain");
    }
    if let Some(spring) = spring {
        name = format!("{name}-{}", spring.name.trim_end_matches(".toml"));
        description = spring.described(&description);
        files.insert(format!("resources/{}", spring.name), spring.contents);
    }
    files.insert("modelDescription.xml".to_owned(), description.into_bytes());
    write(format!("dist/{name}.fmu"), &pack(&files)?)
}

/// A spring file to be carried.
struct Spring {
    name: String,
    contents: Vec<u8>,
}

impl Spring {
    fn read(path: &Path) -> Result<Self> {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default()
            .to_owned();
        let ordinary = |c: char| c.is_alphanumeric() || "-_.".contains(c);
        if name.is_empty() || !name.chars().all(ordinary) {
            bail!("{}: allowed in the name are letters, digits and -_.", path.display());
        }
        SpringFile::read(Path::new(""), &path.to_string_lossy())?;
        let contents = std::fs::read(path)?;
        Ok(Self { name, contents })
    }

    /// The description with the file as start value of `beam.file`, the only string.
    fn described(&self, description: &str) -> String {
        description.replacen("<String start=\"\"/>", &format!("<String start=\"{}\"/>", self.name), 1)
    }
}

/// The contents of the archive for this machine.
fn package(spring: Option<&Spring>) -> Result<Files> {
    let metadata = linked::metadata()?;
    build_library(&metadata, spring)?;
    let (folder, prefix, extension) = platform()?;
    let name = format!("{prefix}relay_contact.{extension}");
    let library = read(metadata.target_directory.as_std_path().join("release").join(&name))?;
    if spring.is_none() {
        write("dist/include/relay_contact.h", C_HEADER.as_bytes())?;
        write(format!("dist/lib/{name}"), &library)?;
    }
    files(&metadata, [(folder, extension, library)], Path::new("rustc"), &[])
}

/// Cargo's arguments to build the shared library only, as otherwise it is not optimised across crates.
pub const CARGO_RUSTC: [&str; 5] = [
    "rustc",
    "--release",
    "--package=relay-contact",
    "--lib",
    "--crate-type=cdylib",
];

fn build_library(metadata: &Metadata, spring: Option<&Spring>) -> Result<()> {
    let mut build = cargo();
    build.args(CARGO_RUSTC);
    // What it has as the start value of `beam.file`.
    match spring {
        Some(spring) => build.env("RELAY_CONTACT_SPRING", &spring.name),
        None => build.env_remove("RELAY_CONTACT_SPRING"),
    };
    // Cargo takes rustc's flags from one place only, so these are added to the user's.
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
    // Rust links with the C compiler; its own message is less clear.
    if built.is_err() && cfg!(unix) && output(command("cc").arg("--version")).is_err() {
        bail!("no C compiler: Rust needs one to link (on Debian: apt-get install gcc libc6-dev)");
    }
    built
}

/// Flags that remove the folders of this machine from the library: without them panic messages contain full paths of
/// source files.
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

/// The contents of the archive. Libraries come with their folder and extension; `rustc` is the compiler whose standard
/// library they contain; `targets` are their platforms as it calls them, none stands for this machine.
pub fn files<'a>(
    metadata: &Metadata,
    libraries: impl IntoIterator<Item = (&'a str, &'a str, Vec<u8>)>,
    rustc: &Path,
    targets: &[&str],
) -> Result<Files> {
    let crates = linked::crates(metadata, targets)?;
    let mut files = licences::texts(&crates, rustc)?;
    for (path, contents) in [
        ("modelDescription.xml", MODEL_DESCRIPTION.as_bytes().to_vec()),
        ("model.png", read("docs/model.png")?),
        ("documentation/index.html", documentation::page()?.into_bytes()),
        ("documentation/sbom.cdx.json", bill::text(&crates, rustc)?.into_bytes()),
    ] {
        files.insert(path.to_owned(), contents);
    }
    for (folder, extension, library) in libraries {
        files.insert(format!("binaries/{folder}/RelayContact.{extension}"), library);
    }
    Ok(files)
}

/// The folder of this machine's platform in FMI 2.0, and the naming of shared libraries there.
fn platform() -> Result<(&'static str, &'static str, &'static str)> {
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        Ok(("linux64", "lib", "so"))
    } else if cfg!(all(target_os = "windows", target_arch = "x86_64")) {
        Ok(("win64", "", "dll"))
    } else if cfg!(target_os = "macos") {
        Ok(("darwin64", "lib", "dylib"))
    } else {
        bail!("FMI 2.0 defines no folder for this platform, only for Linux and Windows on 64-bit x86, and macOS")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_becomes_the_start_value_of_the_only_string() {
        let spring = Spring {
            name: "my.toml".to_owned(),
            contents: Vec::new(),
        };
        let described = spring.described(MODEL_DESCRIPTION);
        assert_eq!(described.matches("<String start=\"my.toml\"/>").count(), 1);
        assert_eq!(described.matches("<String").count(), 1);
        assert!(Spring::read(Path::new("a&b.toml")).is_err() && Spring::read(Path::new("none.toml")).is_err());
    }

    #[test]
    fn everything_but_the_library_is_the_same_bytes_every_time() -> Result<()> {
        let metadata = linked::metadata()?;
        let files = || files(&metadata, [], Path::new("rustc"), &[]);
        let first = files()?;
        assert!(first.contains_key("documentation/licenses/LICENSE-MIT"));
        let of_crate = |path: &String| path.starts_with("documentation/licenses/nalgebra-");
        assert!(first.keys().any(of_crate));
        assert_eq!(pack(&first)?, pack(&files()?)?);
        Ok(())
    }
}
