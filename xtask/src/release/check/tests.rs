//! Each check on a library that passes it and on one that does not.

use anyhow::Result;
use relay_contact::variables::GUID;

use super::super::platform::PLATFORMS;
use super::super::universal::join;
use super::tiny::Tiny;
use super::*;

const LINUX: [&str; 2] = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"];
const WINDOWS: &str = "x86_64-pc-windows-gnullvm";
const MACOS: [&str; 2] = ["x86_64-apple-darwin", "aarch64-apple-darwin"];

/// A library that passes every check.
fn good(target: &'static str) -> Tiny {
    let (library, version) = match target {
        WINDOWS => ("KERNEL32.dll", None),
        _ if MACOS.contains(&target) => ("/usr/lib/libSystem.B.dylib", None),
        _ => ("libc.so.6", Some("GLIBC_2.17".to_owned())),
    };
    let mut good = Tiny {
        target,
        exports: declared().into_iter().collect(),
        data: GUID.as_bytes().to_vec(),
        imports: vec![(library.to_owned(), version)],
        undefined: false,
        arguments: Vec::new(),
    };
    if MACOS.contains(&target) {
        good.macos("11.0", "@rpath/RelayContact.dylib");
    }
    good
}

impl Tiny {
    fn import(&mut self, library: &str) {
        self.imports.push((library.to_owned(), None));
    }
}

/// The checks that a library does not pass.
fn failed(target: &str, library: &[u8]) -> Result<Vec<&'static str>> {
    let findings = single(target, library, &["/home/somebody".into()])?;
    let failed = findings.iter().filter(|finding| !finding.passed);
    Ok(failed.map(|finding| finding.check).collect())
}

/// The checks that a library does not pass after a change.
fn failed_with(target: &'static str, change: impl Fn(&mut Tiny)) -> Result<Vec<&'static str>> {
    let mut tiny = good(target);
    change(&mut tiny);
    failed(target, &tiny.bytes()?)
}

fn targets() -> impl Iterator<Item = &'static str> {
    [&LINUX[..], &[WINDOWS], &MACOS].concat().into_iter()
}

/// FMI 2.0 has 25 functions that all components share (chapter 2.1), and 9 for co-simulation (chapter 4.2).
#[test]
fn the_header_declares_the_functions_of_the_standard() {
    let declared = declared();
    assert_eq!(declared.len(), 34);
    assert!(declared.contains("fmi2GetTypesPlatform") && declared.contains("fmi2GetStringStatus"));
    assert!(!declared.contains("fmi2StepFinished"));
}

#[test]
fn a_good_library_passes() -> Result<()> {
    for target in targets() {
        assert!(failed_with(target, |_| ())?.is_empty(), "{target}");
    }
    Ok(())
}

#[test]
fn an_export_too_many_or_too_few_fails() -> Result<()> {
    for target in targets() {
        let stray = failed_with(target, |tiny| tiny.exports.push("rust_eh_personality".to_owned()))?;
        assert_eq!(stray, ["exported symbols"], "{target}");
        let missing = failed_with(target, |tiny| tiny.exports.retain(|name| name != "fmi2DoStep"))?;
        assert_eq!(missing, ["exported symbols"], "{target}");
    }
    Ok(())
}

#[test]
fn a_library_from_elsewhere_fails() -> Result<()> {
    for target in targets() {
        let foreign = match target {
            WINDOWS => "libgcc_s_seh-1.dll",
            _ if MACOS.contains(&target) => "/usr/lib/libz.1.dylib",
            _ => "libgcc_s.so.1",
        };
        let failed = failed_with(target, |tiny| tiny.import(foreign))?;
        // On Linux a function without a version besides.
        assert_eq!(failed.first(), Some(&"imported libraries"), "{target}");
        assert_eq!(failed.len(), if LINUX.contains(&target) { 2 } else { 1 });
    }
    let versioned = failed_with(LINUX[0], |tiny| {
        tiny.imports
            .push(("libz.so.1".to_owned(), Some("ZLIB_1.2.9".to_owned())));
    })?;
    assert_eq!(versioned, ["imported libraries", "symbol versions"]);
    Ok(())
}

#[test]
fn case_and_the_end_of_a_name_may_differ_on_windows() -> Result<()> {
    for name in ["kernel32.DLL", "api-ms-win-crt-heap-l1-1-0.dll"] {
        assert!(failed_with(WINDOWS, |tiny| tiny.import(name))?.is_empty(), "{name}");
    }
    Ok(())
}

#[test]
fn a_newer_c_library_fails() -> Result<()> {
    for target in LINUX {
        for (version, passes) in [
            ("GLIBC_2.2.5", true),
            ("GLIBC_2.17.1", true),
            ("GLIBC_2.18", false),
            ("GLIBC_2.34", false),
            ("GLIBC_3.0", false),
            ("GLIBC_PRIVATE", false),
            ("GLIBC_ABI_DT_RELR", false),
        ] {
            let failed = failed_with(target, |tiny| {
                tiny.imports = vec![("libc.so.6".to_owned(), Some(version.to_owned()))];
            })?;
            let expected: &[&str] = if passes { &[] } else { &["symbol versions"] };
            assert_eq!(failed, expected, "{target} {version}");
        }
        let undefined = failed_with(target, |tiny| tiny.undefined = true)?;
        assert_eq!(undefined, ["symbol versions"]);
    }
    Ok(())
}

#[test]
fn a_search_path_fails() -> Result<()> {
    for (target, argument) in [(LINUX[0], "-rpath"), (LINUX[1], "-rpath"), (MACOS[1], "-rpath")] {
        let failed = failed_with(target, |tiny| {
            tiny.arguments.extend([argument, "/opt/lib"].map(str::to_owned));
        })?;
        assert_eq!(failed, ["search paths"], "{target}");
    }
    Ok(())
}

#[test]
fn a_newer_system_fails() -> Result<()> {
    for target in MACOS {
        let failed = failed_with(target, |tiny| tiny.macos("11.1", "@rpath/RelayContact.dylib"))?;
        assert_eq!(failed, ["macOS version"]);
        assert!(failed_with(target, |tiny| tiny.macos("10.13", "@rpath/RelayContact.dylib"))?.is_empty());
    }
    for (version, passes) in [("10.0", true), ("10.1", false), ("11.0", false)] {
        let failed = failed_with(WINDOWS, |tiny| {
            tiny.arguments.push(format!("/subsystem:console,{version}"));
        })?;
        let expected: &[&str] = if passes { &[] } else { &["Windows version"] };
        assert_eq!(failed, expected, "{version}");
    }
    Ok(())
}

#[test]
fn an_install_name_of_this_machine_fails() -> Result<()> {
    for target in MACOS {
        let failed = failed_with(target, |tiny| tiny.macos("11.0", "/build/librelay_contact.dylib"))?;
        assert_eq!(failed, ["install name"]);
    }
    Ok(())
}

#[test]
fn a_missing_or_wrong_signature_fails() -> Result<()> {
    let unsigned = |tiny: &mut Tiny| tiny.arguments.push("-no_adhoc_codesign".to_owned());
    assert!(failed_with(MACOS[0], unsigned)?.is_empty());
    assert_eq!(failed_with(MACOS[1], unsigned)?, ["code signature"]);
    for target in MACOS {
        let mut tiny = good(target);
        tiny.arguments.push("-adhoc_codesign".to_owned());
        tiny.data.extend(b" some byte");
        let mut library = tiny.bytes()?;
        assert!(failed(target, &library)?.is_empty());
        let at = position(&library, "some byte").unwrap_or_default();
        library[at] = b'S';
        assert_eq!(failed(target, &library)?, ["code signature"]);
    }
    Ok(())
}

#[test]
fn a_time_of_linking_fails_and_can_be_taken_out() -> Result<()> {
    let mut dated = good(WINDOWS);
    dated.arguments.push("/timestamp:5".to_owned());
    let dated = dated.bytes()?;
    assert_eq!(failed(WINDOWS, &dated)?, ["time of linking"]);
    let timeless = super::without_time(dated.clone())?;
    assert_eq!(failed(WINDOWS, &timeless)?, [""; 0]);
    assert_eq!(timeless.len(), dated.len());
    Ok(())
}

#[test]
fn another_processor_or_a_program_fails() -> Result<()> {
    for targets in [LINUX, MACOS] {
        assert_eq!(failed(targets[1], &good(targets[0]).bytes()?)?, ["kind"]);
    }
    assert!(failed(LINUX[0], &good(LINUX[1]).bytes()?)?.contains(&"kind"));
    let mut dll = good(WINDOWS).bytes()?;
    let machine = position(&dll, "PE\0\0").unwrap_or_default() + 4;
    dll[machine..machine + 2].copy_from_slice(&[0x64, 0xaa]); // Arm
    assert_eq!(failed(WINDOWS, &dll)?, ["kind"]);
    let mut program = good(LINUX[0]).bytes()?;
    program[16] = 2; // ET_EXEC
    assert_eq!(failed(LINUX[0], &program)?, ["kind"]);
    Ok(())
}

#[test]
fn another_format_is_an_error() -> Result<()> {
    let library = good(LINUX[0]).bytes()?;
    for target in [WINDOWS, MACOS[0]] {
        assert!(single(target, &library, &[]).is_err(), "{target}");
    }
    Ok(())
}

#[test]
fn a_large_library_fails() -> Result<()> {
    for target in targets() {
        let failed = failed_with(target, |tiny| tiny.data.resize(SIZE, 1))?;
        assert_eq!(failed, ["size"], "{target}");
    }
    Ok(())
}

#[test]
fn another_guid_fails() -> Result<()> {
    for target in targets() {
        let failed = failed_with(target, |tiny| tiny.data[5] ^= 1)?;
        assert_eq!(failed, ["GUID"], "{target}");
    }
    Ok(())
}

#[test]
fn a_path_of_this_machine_fails() -> Result<()> {
    for target in targets() {
        let failed = failed_with(target, |tiny| tiny.data.extend(b"/home/somebody/src/lib.rs:3"))?;
        assert_eq!(failed, ["paths"], "{target}");
        assert!(failed_with(target, |tiny| tiny.data.extend(b"/home/somebodyelse"))?.is_empty());
    }
    let path = path_within(br"..C:\Users\me\src\lib.rs ", Path::new(r"C:\Users\me"));
    assert_eq!(path.as_deref(), Some(r"C:\Users\me\src\lib.rs"));
    Ok(())
}

#[test]
fn the_error_names_library_check_found_and_allowed() -> Result<()> {
    let mut tiny = good(LINUX[0]);
    tiny.import("libz.so.1");
    tiny.exports.push("stray".to_owned());
    let findings = single(LINUX[0], &tiny.bytes()?, &[])?;
    let shown = findings[1].to_string();
    assert!(
        shown.contains(" FAILED  35 symbols, not declared stray (allowed: the 34 functions"),
        "{shown}"
    );
    assert!(findings[0].to_string().ends_with(" ok      ELF library, x86_64"));
    let error = demand("linux64", &findings).err().map(|error| error.to_string());
    let text = error.unwrap_or_default();
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(
        lines[0],
        "linux64, x86_64-unknown-linux-gnu: exported symbols: found 35 symbols, not declared stray; allowed the 34 \
         functions of the C header"
    );
    assert_eq!(
        lines[1],
        "linux64, x86_64-unknown-linux-gnu: imported libraries: found libc.so.6, libz.so.1; allowed libc.so.6, \
         libm.so.6, libpthread.so.0, libdl.so.2, ld-linux*"
    );
    assert!(lines[2].contains("imported1 without a version") && lines.len() == 3);
    assert!(demand("linux64", &single(LINUX[0], &good(LINUX[0]).bytes()?, &[])?).is_ok());
    Ok(())
}

#[test]
fn a_universal_library_has_each_processor_once_and_all_checks() -> Result<()> {
    let platform = PLATFORMS.iter().find(|platform| platform.folder == "darwin64");
    let platform = platform.expect("macOS is a platform");
    let libraries = [good(MACOS[0]).bytes()?, good(MACOS[1]).bytes()?];
    let failed = |bytes: &[u8]| -> Result<Vec<String>> {
        let findings = library(platform, bytes, &[])?;
        let failed = findings.iter().filter(|finding| !finding.passed);
        Ok(failed
            .map(|finding| format!("{}: {}", finding.target, finding.check))
            .collect())
    };
    let joined = join(&libraries)?;
    assert!(failed(&joined)?.is_empty());
    // What was joined is inside, unchanged.
    for (part, library) in MultiArch::new(&joined)?.arches()?.iter().zip(&libraries) {
        assert_eq!(part.slice(&joined), library);
    }
    assert_eq!(join(&libraries)?, joined);
    assert!(join(&[libraries[0].clone(), libraries[0].clone()]).is_err());

    assert_eq!(failed(&join(&libraries[..1])?)?, ["universal: libraries"]);
    let mut stray = good(MACOS[1]);
    stray.exports.push("stray".to_owned());
    let joined = join(&[libraries[0].clone(), stray.bytes()?])?;
    assert_eq!(failed(&joined)?, ["aarch64-apple-darwin: exported symbols"]);
    assert!(failed(&libraries[0]).is_err());

    // Both entries of the header tell the first one's processor.
    let mut twice = join(&libraries)?;
    twice.copy_within(8..12, 28);
    assert_eq!(failed(&twice)?, ["universal: libraries"]);

    // Everything 16 bytes further: each entry of the header is 20 bytes, its place at the third word.
    let mut shifted = join(&libraries)?;
    shifted.splice(0x1000..0x1000, [0; 16]);
    for low_byte in [8 + 11, 28 + 11] {
        shifted[low_byte] += 16;
    }
    assert_eq!(failed(&shifted)?, ["universal: libraries"]);
    Ok(())
}
