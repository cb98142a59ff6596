//! Libraries for macOS.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use fat_macho::FatWriter;
use goblin::mach::MachO;
use goblin::mach::cputype::{CPU_TYPE_ARM64, CPU_TYPE_X86_64};
use goblin::mach::header::MH_DYLIB;
use goblin::mach::load_command::{CommandVariant, PLATFORM_MACOS};
use sha2::{Digest, Sha256};

use super::report::Report;
use crate::release::platform::MACOS;

/// What a program that links the library writes down to find it by.
const INSTALL_NAME: &str = "@rpath/RelayContact.dylib";

pub fn check(report: &mut Report, bytes: &[u8]) -> Result<()> {
    let library = MachO::parse(bytes, 0).context("not a macOS file")?;
    let processor = processor(library.header.cputype());
    report.kind("macOS", library.header.filetype == MH_DYLIB, processor);
    let exported: BTreeSet<_> = library
        .exports()?
        .into_iter()
        .map(|export| match export.name.strip_prefix('_') {
            Some(name) => name.to_owned(), // As the C compiler calls it.
            None => export.name,
        })
        .collect();
    report.exports(&exported);
    // The first is the library itself.
    let imported = library.libs.get(1..).unwrap_or_default();
    report.only("imported libraries", imported, &["/usr/lib/libSystem.B.dylib"]);
    report.only("search paths", &library.rpaths, &[]);
    report.only("install name", &[library.name.unwrap_or("none")], &[INSTALL_NAME]);

    let minimum = library.load_commands.iter().find_map(|command| match command.command {
        CommandVariant::BuildVersion(version) if version.platform == PLATFORM_MACOS => Some(version.minos),
        CommandVariant::VersionMinMacosx(version) => Some(version.version),
        _ => None,
    });
    let minimum = minimum.map(|version| [version >> 16, version >> 8 & 0xff]);
    report.add(
        "macOS version",
        minimum.map_or_else(|| "none".to_owned(), |[major, minor]| format!("{major}.{minor}")),
        format!("up to {}.{}", MACOS[0], MACOS[1]),
        minimum.is_some_and(|version| version <= MACOS),
    );

    let signature = library.load_commands.iter().find_map(|command| match command.command {
        CommandVariant::CodeSignature(signature) => Some(signature.dataoff as usize),
        _ => None,
    });
    let signed = signature.map(|at| pages_match(bytes, at).unwrap_or(false));
    let found = match signed {
        None => "none",
        Some(true) => "matches",
        Some(false) => "does not match",
    };
    // Without one Arm does not run it; with a wrong one nothing does.
    let (allowed, passed) = match processor {
        "aarch64" => ("one that matches", signed == Some(true)),
        _ => ("none, or one that matches", signed != Some(false)),
    };
    report.add("code signature", found, allowed, passed);
    Ok(())
}

/// Joins libraries for several processors into one universal library.
pub fn join(libraries: &[Vec<u8>]) -> Result<Vec<u8>> {
    let mut writer = FatWriter::new();
    for library in libraries {
        writer.add(library.as_slice()).context("cannot join the libraries")?;
    }
    let mut joined = Vec::new();
    writer.write_to(&mut joined).context("cannot join the libraries")?;
    Ok(joined)
}

/// As rustc calls it.
pub fn processor(kind: u32) -> &'static str {
    match kind {
        CPU_TYPE_X86_64 => "x86_64",
        CPU_TYPE_ARM64 => "aarch64",
        _ => "another processor",
    }
}

/// Whether the pages of the file have the SHA-256 digests in the code signature at `signature`, nothing where it cannot
/// be read. A tool that changes a library after it was linked leaves the signature wrong.
fn pages_match(bytes: &[u8], signature: usize) -> Option<bool> {
    const DIRECTORY: u32 = 0xfade_0c02;
    const SHA256: u8 = 2;
    let word = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    // A list of parts: after magic, length and count, a kind and a place for each.
    let parts = (0..word(signature + 8)?).filter_map(|part| Some(signature + word(signature + 16 + 8 * part)?));
    let directory = parts.into_iter().find(|part| word(*part) == Some(DIRECTORY as usize))?;
    let [digests, _, count, limit] = [16, 20, 28, 32].map(|field| word(directory + field));
    let (digests, limit) = (directory + digests?, limit?);
    let &[length, kind, _, page] = bytes.get(directory + 36..directory + 40)? else { return None };
    let pages: Vec<_> = bytes.get(..limit)?.chunks(1_usize.checked_shl(page.into())?).collect();
    let matches = pages.iter().enumerate().all(|(number, page)| {
        let at = digests + number * usize::from(length);
        bytes.get(at..at + usize::from(length)) == Some(Sha256::digest(page).as_slice())
    });
    Some(kind == SHA256 && Some(pages.len()) == count && limit == signature && matches)
}
