//! Checks for macOS, where the library is never run: each on a small library that passes and on one that does not.

use std::fs;
use std::process::Command;

use crate::commands::output;
use anyhow::Result;
use goblin::mach::MultiArch;
use object::write::{Object, Symbol, SymbolSection};
use object::{Architecture, BinaryFormat, Endianness, SectionKind, SymbolFlags, SymbolKind, SymbolScope};
use relay_contact::variables::GUID;

use super::*;
use crate::release::tools::lld;

const MACOS: [&str; 2] = ["x86_64-apple-darwin", "aarch64-apple-darwin"];

/// What to put into a small library.
struct Tiny {
    target: &'static str,
    exports: Vec<String>,
    data: Vec<u8>,
    import: &'static str,
    minimum_system: &'static str,
    arguments: &'static [&'static str],
}

/// A library that passes every check.
fn good(target: &'static str) -> Tiny {
    Tiny {
        target,
        exports: declared().into_iter().collect(),
        data: GUID.into(),
        import: "/usr/lib/libSystem.B.dylib",
        minimum_system: "11.0",
        arguments: &[],
    }
}

impl Tiny {
    fn is_arm(&self) -> bool {
        self.target.starts_with("aarch64")
    }

    fn link(&self) -> Result<Vec<u8>> {
        let folder = tempfile::tempdir()?;
        let architecture = if self.is_arm() { "arm64" } else { "x86_64" };
        let (import, minimum) = (self.import, self.minimum_system);
        // The linker that comes with Rust, or that of LLVM.
        let mut linker = Command::new(lld(Path::new("rustc")).unwrap_or_else(|_| "lld".into()));
        linker
            .current_dir(folder.path())
            .args(["-flavor", "darwin", "-dylib", "-arch", architecture])
            .args(["-platform_version", "macos", minimum, minimum])
            .args(["-o", "library", "object.o", "imported.tbd"])
            .args(["-install_name", "@rpath/RelayContact.dylib"])
            .args(self.arguments);
        let stub = format!(
            "--- !tapi-tbd\ntbd-version: 4\ntargets: [ {architecture}-macos ]\ninstall-name: '{import}'\n...\n"
        );
        fs::write(folder.path().join("imported.tbd"), stub)?;
        fs::write(folder.path().join("object.o"), self.object()?)?;
        output(&mut linker)?;
        Ok(fs::read(folder.path().join("library"))?)
    }

    /// Functions without code, and the data.
    fn object(&self) -> Result<Vec<u8>> {
        let architecture = if self.is_arm() { Architecture::Aarch64 } else { Architecture::X86_64 };
        let mut object = Object::new(BinaryFormat::MachO, architecture, Endianness::Little);
        let text = object.add_section(b"__TEXT".to_vec(), b".text".to_vec(), SectionKind::Text);
        let data = object.add_section(b"__DATA".to_vec(), b".data".to_vec(), SectionKind::Data);
        for export in &self.exports {
            let value = object.append_section_data(text, &[0; 16], 16);
            object.add_symbol(Symbol {
                name: export.as_bytes().to_vec(),
                value,
                size: 0,
                kind: SymbolKind::Text,
                scope: SymbolScope::Dynamic,
                weak: false,
                section: SymbolSection::Section(text),
                flags: SymbolFlags::None,
            });
        }
        object.append_section_data(data, &self.data, 8);
        Ok(object.write()?)
    }
}

/// The checks that a library does not pass.
fn failed(target: &'static str, library: &[u8]) -> Result<Vec<&'static str>> {
    Ok(super::library(target, library, &["/home/somebody".into()])?.failed)
}

type Change = fn(&mut Tiny);

/// The checks that a library does not pass after a change.
fn failed_with(target: &'static str, change: Change) -> Result<Vec<&'static str>> {
    let mut tiny = good(target);
    change(&mut tiny);
    failed(target, &tiny.link()?)
}

/// FMI 2.0 has 25 functions that all components share (chapter 2.1), and 9 for co-simulation (chapter 4.2).
#[test]
fn the_header_declares_the_functions_of_the_standard() {
    let declared = declared();
    assert_eq!(declared.len(), 35);
    assert!(declared.contains("fmi2GetTypesPlatform") && declared.contains("fmi2GetStringStatus"));
    assert!(!declared.contains("fmi2StepFinished"));
}

#[test]
fn every_defect_fails_its_check_alone_and_a_good_library_none() -> Result<()> {
    let changes: [(&[&str], Change); 12] = [
        (&[], |_| ()),
        (&[], |tiny| tiny.minimum_system = "10.13"),
        (&[], |tiny| tiny.data.extend(b"/home/somebodyelse")),
        (&["exported symbols"], |tiny| tiny.exports.push("rust_eh_personality".to_owned())),
        (&["exported symbols"], |tiny| tiny.exports.retain(|name| name != "fmi2DoStep")),
        (&["imported libraries"], |tiny| tiny.import = "/usr/lib/libz.1.dylib"),
        (&["search paths"], |tiny| tiny.arguments = &["-rpath", "/opt/lib"]),
        (&["macOS version"], |tiny| tiny.minimum_system = "11.1"),
        (&["install name"], |tiny| tiny.arguments = &["-install_name", "/build/librelay_contact.dylib"]),
        (&["size"], |tiny| tiny.data.resize(SIZE, 1)),
        (&["GUID"], |tiny| tiny.data[5] ^= 1),
        (&["paths"], |tiny| tiny.data.extend(b"/home/somebody/src/lib.rs:3")),
    ];
    for target in MACOS {
        for (checks, change) in changes {
            assert_eq!(failed_with(target, change)?, checks, "{target}");
        }
    }
    assert_eq!(failed(MACOS[1], &good(MACOS[0]).link()?)?, ["kind"]);
    assert!(failed(MACOS[0], b"\x7fELF").is_err(), "another format");
    Ok(())
}

#[test]
fn a_missing_or_wrong_signature_fails() -> Result<()> {
    let unsigned: Change = |tiny| tiny.arguments = &["-no_adhoc_codesign"];
    assert!(failed_with(MACOS[0], unsigned)?.is_empty());
    assert_eq!(failed_with(MACOS[1], unsigned)?, ["code signature"]);
    for target in MACOS {
        let mut tiny = good(target);
        tiny.arguments = &["-adhoc_codesign"];
        tiny.data.extend(b" some byte");
        let mut library = tiny.link()?;
        assert!(failed(target, &library)?.is_empty());
        let at = position(&library, "some byte").unwrap_or_default();
        library[at] = b'S';
        assert_eq!(failed(target, &library)?, ["code signature"]);
    }
    Ok(())
}

#[test]
fn a_universal_library_has_that_of_each_processor_unchanged() -> Result<()> {
    let libraries = [good(MACOS[0]).link()?, good(MACOS[1]).link()?];
    let joined = join(&libraries)?;
    let parts = MultiArch::new(&joined)?.arches()?;
    assert_eq!(parts.len(), libraries.len());
    for ((part, library), target) in parts.iter().zip(&libraries).zip(MACOS) {
        assert_eq!(macho::processor(part.cputype), processor(target));
        assert_eq!(part.slice(&joined), library);
        assert!(part.offset.is_multiple_of(0x4000), "a boundary of the largest memory page");
    }
    Ok(())
}
