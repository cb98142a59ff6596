//! The platforms of the full archive.

/// A platform that FMI tools run on.
pub struct Platform {
    /// Its folder below `binaries/` in the archive: the name of FMI 2.0, or of FMI 3.0 where 2.0 has none.
    pub folder: &'static str,
    /// Of a shared library.
    pub extension: &'static str,
    /// What rustc calls it; several are joined into one universal library.
    pub targets: &'static [&'static str],
}

/// All of them.
pub const PLATFORMS: [Platform; 5] = [
    Platform {
        folder: "linux64",
        extension: "so",
        targets: &["x86_64-unknown-linux-gnu"],
    },
    Platform {
        folder: "aarch64-linux",
        extension: "so",
        targets: &["aarch64-unknown-linux-gnu"],
    },
    Platform {
        folder: "win64",
        extension: "dll",
        targets: &["x86_64-pc-windows-gnullvm"],
    },
    Platform {
        folder: "darwin64",
        extension: "dylib",
        targets: &["x86_64-apple-darwin", "aarch64-apple-darwin"],
    },
    Platform {
        folder: "aarch64-darwin",
        extension: "dylib",
        targets: &["aarch64-apple-darwin"],
    },
];
