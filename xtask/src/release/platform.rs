//! The platforms of the full archive.

use std::env::consts::{ARCH, OS};

use anyhow::{Context, Result};

use super::check::processor;

/// Oldest C library of Linux on which libraries load.
pub const GLIBC: [u32; 2] = [2, 17];

/// Oldest macOS: the first on Arm.
pub const MACOS: [u32; 2] = [11, 0];

/// A platform that FMI tools run on.
pub struct Platform {
    /// Its folder below `binaries/` in the archive: the name of FMI 2.0, or of FMI 3.0 where 2.0 has none.
    pub folder: &'static str,
    /// Of a shared library.
    pub extension: &'static str,
    /// What rustc calls it; several are joined into one universal library.
    pub targets: &'static [&'static str],
}

impl Platform {
    /// That of this machine.
    pub fn host() -> Result<&'static Self> {
        PLATFORMS
            .iter()
            .find(|platform| platform.is_host())
            .context("no library is made for platforms such as this machine's")
    }

    /// Whether this machine is one of the platform.
    pub fn is_host(&self) -> bool {
        let system = if OS == "macos" { "darwin" } else { OS };
        self.targets.iter().any(|target| target.starts_with(ARCH) && target.contains(system))
    }

    /// The Python package that carries its library, by the platform tag that pip and the index of Python packages know.
    pub fn wheel(&self) -> String {
        match (self.extension, self.targets) {
            ("so", [target]) => format!("manylinux_{}_{}_{}", GLIBC[0], GLIBC[1], processor(target)),
            ("dylib", _) => format!("macosx_{}_{}_universal2", MACOS[0], MACOS[1]),
            _ => "win_amd64".to_owned(),
        }
    }
}

const X86_LINUX: &str = "x86_64-unknown-linux-gnu";
const ARM_LINUX: &str = "aarch64-unknown-linux-gnu";
const WINDOWS: &str = "x86_64-pc-windows-gnullvm";
const X86_MAC: &str = "x86_64-apple-darwin";
const ARM_MAC: &str = "aarch64-apple-darwin";

/// All platforms.
pub const PLATFORMS: [Platform; 5] = [
    Platform { folder: "linux64", extension: "so", targets: &[X86_LINUX] },
    Platform { folder: "aarch64-linux", extension: "so", targets: &[ARM_LINUX] },
    Platform { folder: "win64", extension: "dll", targets: &[WINDOWS] },
    Platform { folder: "darwin64", extension: "dylib", targets: &[X86_MAC, ARM_MAC] },
    Platform { folder: "aarch64-darwin", extension: "dylib", targets: &[ARM_MAC] },
];
