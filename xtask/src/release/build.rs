//! Builds the library for any platform on this machine.

use std::path::{Path, PathBuf};

use crate::commands::{cargo, command, read, run, write};
use anyhow::{Context, Result};
use cargo_metadata::Metadata;

use super::check::{declared, without_time};
use super::tools::{Tools, lld};
use crate::fmu;

/// Oldest C library of Linux on which the libraries load.
pub const GLIBC: &str = "2.17";
/// Oldest macOS.
pub const MACOS: &str = "11.0";

/// Where all of it is built.
pub fn folder(metadata: &Metadata) -> PathBuf {
    metadata.target_directory.as_std_path().join("platforms")
}

/// Builds the library for `target`, the platform as rustc calls it. The standard library is compiled with it, without what
/// prints backtraces: that would be an eighth of the size.
pub fn library(target: &str, tools: &Tools, metadata: &Metadata) -> Result<Vec<u8>> {
    let folder = folder(metadata);
    let mut flags = fmu::path_flags(metadata);
    flags.extend(tools.rust.path_flags());
    if target.contains("windows") {
        flags.push(format!("-Clink-arg={}", exports(&folder)?.display()));
    }
    let mut build = if target.contains("apple") {
        flags.extend(apple_flags(&lld(&tools.rust.rustc)?));
        let mut build = cargo();
        build.env("SDKROOT", sdk(&tools.zig, &folder)?);
        // The linker strips: rustc would ask for a program that is not there.
        build
            .env("MACOSX_DEPLOYMENT_TARGET", MACOS)
            .env("CARGO_PROFILE_RELEASE_STRIP", "none");
        build
    } else {
        let mut build = command(&tools.zigbuild);
        build.env("CARGO_ZIGBUILD_ZIG_PATH", &tools.zig);
        build
    };
    build.args(fmu::CARGO_RUSTC);
    build.args(["-Zbuild-std=std,panic_unwind", "-Zbuild-std-features="]);
    let version = if target.contains("linux") {
        format!(".{GLIBC}")
    } else {
        String::new()
    };
    build
        .arg(format!("--target={target}{version}"))
        .arg("--target-dir")
        .arg(&folder);
    // Of the user's flags none: the same archive everywhere.
    build
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
        .env_remove("RUSTC_WRAPPER");
    build.env("RUSTC", &tools.rust.rustc).env("RUSTC_BOOTSTRAP", "1");
    run(&mut build)?;
    let release = folder.join(target).join("release");
    let names = ["librelay_contact.so", "relay_contact.dll", "librelay_contact.dylib"];
    let paths = names.map(|name| release.join(name));
    let path = paths.iter().find(|path| path.exists());
    let library = read(path.with_context(|| format!("cargo built no library in {}", release.display()))?)?;
    if target.contains("windows") {
        without_time(library)
    } else {
        Ok(library)
    }
}

fn apple_flags(lld: &Path) -> Vec<String> {
    let linker = format!("-Clinker={}", lld.display());
    // Symbols that are not exported go; so does libiconv, which the standard library names and nothing uses.
    let arguments = "-install_name @rpath/RelayContact.dylib -dead_strip_dylibs -x -S";
    ["-Zunstable-options", "-Clinker-flavor=darwin-lld", &linker]
        .map(str::to_owned)
        .into_iter()
        .chain(arguments.split(' ').map(|argument| format!("-Clink-arg={argument}")))
        .collect()
}

/// A file that names what the library exports: without one zig exports everything, as MinGW's linkers do.
fn exports(folder: &Path) -> Result<PathBuf> {
    let names = declared().into_iter().map(|name| format!("    {name}\n"));
    write(
        folder.join("exports.def"),
        format!("EXPORTS\n{}", names.collect::<String>()).as_bytes(),
    )
}

/// A folder that stands for the SDK of macOS: the list of what its system library exports, as zig has it.
fn sdk(zig: &Path, folder: &Path) -> Result<PathBuf> {
    let text = read(zig.with_file_name("lib").join("libc/darwin/libSystem.tbd"))?;
    // A processor that this linker does not know yet.
    let text = String::from_utf8(text)?.replace("arm64e.x1-", "arm64e-");
    let sdk = folder.join("MacOSX.sdk");
    for name in ["System", "c", "m", "iconv"] {
        write(sdk.join(format!("usr/lib/lib{name}.tbd")), text.as_bytes())?;
    }
    Ok(sdk)
}
