//! A C program uses the library through the generated header: it must compile without a warning, link and run.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

use relay_contact::variables::{GUID, Variable};

const REFERENCES: [&str; 7] = [
    "base.acceleration",
    "contact.force",
    "preload.force",
    "contact.overtravel",
    "effects.excitation",
    "contact.closed",
    "solver.steps",
];

/// Folder of the dynamic library, which cargo builds beside the test.
fn library_folder() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.parent().unwrap();
    let library = folder.join(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"));
    assert!(library.exists(), "{} is missing", library.display());
    folder.to_owned()
}

#[test]
fn a_c_program_lives_a_full_life_with_two_instances() {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("life_cycle{EXE_SUFFIX}"));
    let folder = library_folder();
    let compiled = Command::new("cc")
        .args([
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
            "-I",
            env!("RELAY_CONTACT_INCLUDE"),
        ])
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/c/life_cycle.c"))
        .arg("-L")
        .arg(&folder)
        .args(["-lrelay_contact", "-lm", "-o"])
        .arg(&program)
        .output()
        .unwrap_or_else(|error| match error.kind() {
            ErrorKind::NotFound => {
                panic!("No C compiler: this test needs one that is called cc (Debian: apt install gcc).")
            }
            _ => panic!("cc: {error}"),
        });
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );

    let ran = Command::new(&program)
        // Cargo points this at a folder that may hold the library of an earlier build.
        .env("LD_LIBRARY_PATH", &folder)
        .arg(GUID)
        .args(REFERENCES.map(|name| Variable::by_name(name).unwrap().value_reference.to_string()))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(ran.status.success(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
    assert!(said.contains("life cycle passed"), "{said}");
}
