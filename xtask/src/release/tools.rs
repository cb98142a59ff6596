//! What the builds for all platforms need.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::commands::{command, output};
use crate::python;

/// Programs and files that were found.
pub struct Tools {
    /// A Rust compiler that comes with the sources of its standard library: they are compiled for each platform.
    pub rustc: PathBuf,
    /// Those sources.
    pub sources: PathBuf,
    /// Compiles and links C for Linux and Windows.
    pub zig: PathBuf,
    /// Has cargo link by zig.
    pub zigbuild: PathBuf,
}

impl Tools {
    /// Finds a compiler, and installs zig into `.venv`.
    pub fn find() -> Result<Self> {
        let Some((rustc, sources)) = ["rustc", "/usr/bin/rustc"].into_iter().find_map(with_sources) else {
            bail!(
                "no sources of Rust's standard library: rustup component add rust-src (or on Debian: apt-get install rustc-web rust-web-src)"
            );
        };
        let (zig, zigbuild) = python::zig()?;
        Ok(Self {
            rustc,
            sources,
            zig,
            zigbuild,
        })
    }
}

/// The compiler itself, not rustup's stand-in for it, and the sources, where it has them.
fn with_sources(rustc: &str) -> Option<(PathBuf, PathBuf)> {
    let sysroot = sysroot(Path::new(rustc))?;
    // Debian's is a link, and the compiler names the files by where it leads.
    let sources = sysroot.join("lib/rustlib/src/rust").canonicalize().ok()?;
    let rustc = sysroot.join("bin").join(format!("rustc{}", std::env::consts::EXE_SUFFIX));
    sources.join("library/Cargo.toml").exists().then_some((rustc, sources))
}

/// Links for macOS. It comes with rustup's toolchains; Debian's have none.
pub fn lld(rustc: &Path) -> Result<PathBuf> {
    let found = [rustc, Path::new("rustc")].into_iter().find_map(|rustc| {
        let libraries = output(command(rustc).args(["--print", "target-libdir"])).ok()?;
        let name = format!("rust-lld{}", std::env::consts::EXE_SUFFIX);
        let lld = Path::new(libraries.trim()).parent()?.join("bin").join(name);
        lld.exists().then_some(lld)
    });
    let Some(lld) = found else {
        bail!("rust-lld is missing, which links for macOS: it comes with the toolchains of rustup");
    };
    Ok(lld)
}

fn sysroot(rustc: &Path) -> Option<PathBuf> {
    let sysroot = output(command(rustc).args(["--print", "sysroot"])).ok()?;
    Some(PathBuf::from(sysroot.trim()))
}
