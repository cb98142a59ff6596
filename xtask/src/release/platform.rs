//! The platforms of the full archive.

/// A platform that FMI tools run on.
pub struct Platform {
    /// Its folder below `binaries/` in the archive: the name of FMI 2.0, or of FMI 3.0 where 2.0 has none.
    pub folder: &'static str,
    /// Of a shared library.
    pub extension: &'static str,
    /// What rustc calls it; several are joined into one universal library.
    pub targets: &'static [&'static str],
    /// The Python package that carries its library, by the platform tag that pip and the index of Python packages know:
    /// libraries are built and checked for just this oldest system.
    pub wheel: &'static str,
}

const X86_LINUX: &str = "x86_64-unknown-linux-gnu";
const ARM_LINUX: &str = "aarch64-unknown-linux-gnu";
const WINDOWS: &str = "x86_64-pc-windows-gnullvm";
const X86_MAC: &str = "x86_64-apple-darwin";
const ARM_MAC: &str = "aarch64-apple-darwin";

/// All platforms.
pub const PLATFORMS: [Platform; 5] = [
    Platform { folder: "linux64", extension: "so", targets: &[X86_LINUX], wheel: "manylinux_2_17_x86_64" },
    Platform { folder: "aarch64-linux", extension: "so", targets: &[ARM_LINUX], wheel: "manylinux_2_17_aarch64" },
    Platform { folder: "win64", extension: "dll", targets: &[WINDOWS], wheel: "win_amd64" },
    Platform { folder: "darwin64", extension: "dylib", targets: &[X86_MAC, ARM_MAC], wheel: "macosx_11_0_universal2" },
    Platform { folder: "aarch64-darwin", extension: "dylib", targets: &[ARM_MAC], wheel: "macosx_11_0_universal2" },
];

#[cfg(test)]
mod tests {
    use super::super::build::{GLIBC, MACOS};
    use super::*;

    #[test]
    fn wheels_are_for_the_oldest_system_that_is_built_for() {
        for Platform { extension, wheel, .. } in &PLATFORMS {
            let (system, oldest) = match *extension {
                "so" => ("manylinux_", GLIBC),
                "dylib" => ("macosx_", MACOS),
                _ => ("win_amd64", ""),
            };
            let start = format!("{system}{}", oldest.replace('.', "_"));
            assert!(wheel.starts_with(&start), "{wheel}: {start}");
        }
    }
}
