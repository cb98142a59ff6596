//! Tools for the builds for all platforms.

use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf};

use crate::commands::{command, output, read, sysroot};
use anyhow::{Result, ensure};

use crate::package::Files;
use crate::python;

/// A Rust compiler that comes with the sources of its standard library: they are compiled for each platform.
pub struct Rust {
    /// The compiler.
    pub rustc: PathBuf,
    /// The folder of the sources, by its two names: where it is below the compiler, and where links lead.
    sources: [PathBuf; 2],
}

impl Rust {
    /// Finds it.
    pub fn find() -> Result<Self> {
        // The compiler itself, not rustup's stand-in for it.
        let sysroot = sysroot("rustc")?;
        let sources = sysroot.join("lib/rustlib/src/rust");
        ensure!(
            sources.join("library/Cargo.toml").exists(),
            "no sources of Rust's standard library: rustup component add rust-src"
        );
        let leads_to = sources.canonicalize()?;
        Ok(Self { rustc: sysroot.join("bin").join(format!("rustc{EXE_SUFFIX}")), sources: [sources, leads_to] })
    }

    /// Flags that remove its folders from what it compiles.
    pub fn path_flags(&self) -> impl Iterator<Item = String> {
        let folders = self.sources.iter();
        folders.map(|folder| format!("--remap-path-prefix={}=rust", folder.display()))
    }
}

/// Programs and files that were found.
pub struct Tools {
    /// The compiler.
    pub rust: Rust,
    /// Compiles and links C for Linux and Windows.
    pub zig: PathBuf,
    /// Lets cargo link with zig.
    pub zigbuild: PathBuf,
}

/// Licences of what zig links into libraries, below its folder: its own parts, LLVM's, and for Windows those of MinGW.
const ZIG_LICENCES: [&str; 3] = ["LICENSE", "lib/libunwind/LICENSE.TXT", "lib/libc/mingw/COPYING"];

impl Tools {
    /// Finds a compiler, and installs zig into `.venv`.
    pub fn find() -> Result<Self> {
        let rust = Rust::find()?;
        let (zig, zigbuild) = python::zig()?;
        Ok(Self { rust, zig, zigbuild })
    }

    /// Licence texts of what zig links into libraries, by path in the archive.
    pub fn licences(&self) -> Result<Files> {
        let text = |name: &str| {
            let path = format!("documentation/licenses/zig/{}", name.replace('/', "-"));
            Ok((path, read(self.zig.with_file_name(name))?))
        };
        ZIG_LICENCES.into_iter().map(text).collect()
    }
}

/// Links for macOS and WebAssembly. It comes with rustup's toolchains.
pub fn lld(rustc: &Path) -> Result<PathBuf> {
    let libraries = output(command(rustc).args(["--print", "target-libdir"]))?;
    let tools = Path::new(libraries.trim()).with_file_name("bin");
    let lld = tools.join(format!("rust-lld{EXE_SUFFIX}"));
    ensure!(
        lld.exists(),
        "{} is missing, which links for macOS and WebAssembly: it comes with the toolchains of rustup",
        lld.display()
    );
    Ok(lld)
}
