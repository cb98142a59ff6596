//! Libraries for Linux.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use goblin::elf::Elf;
use goblin::elf::header::{EM_AARCH64, EM_X86_64, ET_DYN};
use goblin::elf::section_header::SHN_UNDEF;
use goblin::elf::sym::{STB_LOCAL, STB_WEAK, STV_HIDDEN, STV_INTERNAL};
use goblin::elf::symver::VerneedSection;

use super::report::Report;
use crate::release::platform::GLIBC;

/// The parts of the GNU C library, by the names they all had until 2.17 and still have.
const LIBRARIES: [&str; 5] = ["libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "ld-linux*"];

pub fn check(report: &mut Report, bytes: &[u8]) -> Result<()> {
    let elf = Elf::parse(bytes).context("not an ELF file")?;
    let processor = match elf.header.e_machine {
        EM_X86_64 if elf.is_64 => "x86_64",
        EM_AARCH64 if elf.little_endian => "aarch64",
        _ => "another processor",
    };
    report.kind("ELF", elf.header.e_type == ET_DYN, processor);
    let name = |symbol| elf.dynstrtab.get_at(symbol).unwrap_or_default().to_owned();
    let exported: BTreeSet<_> = elf
        .dynsyms
        .iter()
        .filter(|symbol| symbol.st_shndx != SHN_UNDEF as usize && symbol.st_bind() != STB_LOCAL)
        .filter(|symbol| ![STV_HIDDEN, STV_INTERNAL].contains(&symbol.st_visibility()))
        .map(|symbol| name(symbol.st_name))
        .collect();
    report.exports(&exported);
    report.only("imported libraries", &elf.libraries, &LIBRARIES);
    report.only("search paths", &[elf.rpaths.as_slice(), &elf.runpaths].concat(), &[]);

    let mut versions: BTreeSet<_> = elf
        .verneed
        .iter()
        .flat_map(VerneedSection::iter)
        .flat_map(|needed| needed.iter().map(|version| version.vna_name).collect::<Vec<_>>())
        .map(|version| elf.dynstrtab.get_at(version).unwrap_or("unreadable").to_owned())
        .collect();
    // Whoever gives an import without a version, it is none of the libraries above.
    for (index, symbol) in elf.dynsyms.iter().enumerate() {
        let version = elf.versym.as_ref().and_then(|section| section.get_at(index));
        let versioned = version.is_some_and(|version| !version.is_local() && !version.is_global());
        let demanded = symbol.st_shndx == SHN_UNDEF as usize && ![STB_LOCAL, STB_WEAK].contains(&symbol.st_bind());
        if demanded && !versioned {
            versions.insert(format!("{} without a version", name(symbol.st_name)));
        }
    }
    let allowed = |version: &&String| glibc(version).is_some_and(|numbers| numbers.as_slice() <= GLIBC.as_slice());
    let too_new: Vec<_> = versions.iter().filter(|version| !allowed(version)).collect();
    let newest = versions.iter().max_by_key(|version| glibc(version));
    let found = match (too_new.as_slice(), newest) {
        ([], Some(newest)) => format!("up to {newest}"),
        _ => super::report::listed(&too_new),
    };
    let [major, minor] = GLIBC;
    report.add("symbol versions", found, format!("GLIBC_, up to {major}.{minor}"), too_new.is_empty());
    Ok(())
}

/// The numbers of a version such as `GLIBC_2.2.5`.
fn glibc(version: &str) -> Option<Vec<u32>> {
    let numbers = version.strip_prefix("GLIBC_")?.split('.');
    numbers.map(|number| number.parse().ok()).collect()
}
