//! Builds the library for any platform on this machine.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{cargo, command, read, run, text, write};
use anyhow::{Context, Result};

use super::check::{declared, without_time};
use super::platform::{GLIBC, MACOS};
use super::tools::{Rust, Tools, lld};
use crate::{fmu, linked};

/// Where all of it is built.
pub fn folder() -> Result<PathBuf> {
    Ok(linked::metadata()?.target_directory.as_std_path().join("platforms"))
}

/// Builds the library for `target`, the platform as rustc calls it.
pub fn library(target: &str, tools: &Tools) -> Result<Vec<u8>> {
    let folder = folder()?;
    let (mut flags, mut version) = (Vec::new(), String::new());
    let mut build = command(&tools.zigbuild);
    build.env("CARGO_ZIGBUILD_ZIG_PATH", &tools.zig);
    if target.contains("windows") {
        flags.push(format!("-Clink-arg={}", exports(&folder)?.display()));
    } else if target.contains("apple") {
        flags.extend(apple_flags(&lld(&tools.rust.rustc)?));
        build = cargo();
        build.env("SDKROOT", sdk(&tools.zig, &folder)?);
        // The linker strips: rustc would ask for a program that is not there.
        build
            .env("MACOSX_DEPLOYMENT_TARGET", format!("{}.{}", MACOS[0], MACOS[1]))
            .env("CARGO_PROFILE_RELEASE_STRIP", "none");
    } else {
        version = format!(".{}.{}", GLIBC[0], GLIBC[1]);
    }
    build.args(fmu::CARGO_RUSTC).arg("--package=relay-contact");
    with_std(&mut build, &tools.rust, "panic_unwind", flags)?;
    run(build.arg(format!("--target={target}{version}")))?;
    let release = folder.join(target).join("release");
    let names = ["librelay_contact.so", "relay_contact.dll", "librelay_contact.dylib"];
    let paths = names.map(|name| release.join(name));
    let path = paths.iter().find(|path| path.exists());
    let library = read(path.with_context(|| format!("cargo built no library in {}", release.display()))?)?;
    if target.contains("windows") { without_time(library) } else { Ok(library) }
}

/// Lets cargo compile the standard library too, with this crate for panics and without what prints backtraces: that would be an
/// eighth of the size. The flags are for rustc, which removes the folders of this machine.
pub fn with_std(build: &mut Command, rust: &Rust, panic: &str, flags: Vec<String>) -> Result<()> {
    let paths = fmu::path_flags()?.into_iter().chain(rust.path_flags());
    let flags: Vec<_> = paths.chain(flags).collect();
    build
        .args([&format!("-Zbuild-std=std,{panic}"), "-Zbuild-std-features="])
        .arg("--target-dir")
        .arg(folder()?)
        // Of the user's flags none: the same archive everywhere.
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
        .env_remove("RUSTC_WRAPPER")
        .env("RUSTC", &rust.rustc)
        .env("RUSTC_BOOTSTRAP", "1");
    Ok(())
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
    let text = format!("EXPORTS\n{}", names.collect::<String>());
    write(folder.join("exports.def"), text)
}

/// A folder that stands for the SDK of macOS: the list of what its system library exports, as zig has it.
fn sdk(zig: &Path, folder: &Path) -> Result<PathBuf> {
    let list = text(zig.with_file_name("lib").join("libc/darwin/libSystem.tbd"))?;
    // A processor that this linker does not know yet.
    let list = list.replace("arm64e.x1-", "arm64e-");
    let sdk = folder.join("MacOSX.sdk");
    for name in ["System", "c", "m", "iconv"] {
        write(sdk.join(format!("usr/lib/lib{name}.tbd")), &list)?;
    }
    Ok(sdk)
}
