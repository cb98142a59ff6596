//! C programs that use the library through the generated header: compiled without a warning, linked with the dynamic library.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of the dynamic library, which cargo builds beside the test.
fn library_folder() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.parent().unwrap();
    let library = folder.join(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"));
    assert!(library.exists(), "{} is missing", library.display());
    folder.to_owned()
}

/// Compiles `source`, a path in the project, and gives the program.
pub fn compile(source: &str) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(source);
    let name = source.file_stem().unwrap().to_str().unwrap();
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}{EXE_SUFFIX}"));
    let compiler = Command::new("cc")
        .args([
            "-std=c99",
            // Rust rounds every operation; C may fuse a product and a sum, as clang does on Arm.
            "-ffp-contract=off",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
            "-I",
            env!("RELAY_CONTACT_INCLUDE"),
        ])
        .arg(source)
        .arg("-L")
        .arg(library_folder())
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
        compiler.status.success(),
        "{}",
        String::from_utf8_lossy(&compiler.stderr)
    );
    program
}

/// The program, ready to be started.
pub fn command(program: &Path) -> Command {
    let mut command = Command::new(program);
    // Cargo points this at a folder that may hold the library of an earlier build.
    command.env("LD_LIBRARY_PATH", library_folder());
    command
}
