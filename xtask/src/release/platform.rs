//! The platforms of the full archive.

use super::build::{GLIBC, MACOS};

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
    const fn new(folder: &'static str, extension: &'static str, targets: &'static [&'static str]) -> Self {
        Self {
            folder,
            extension,
            targets,
        }
    }

    /// Whether wheels of a system and processor carry its library.
    pub fn is_of(&self, wheel: &Wheel) -> bool {
        wheel.folders.contains(&self.folder)
    }
}

/// A Python package with the libraries of one platform.
pub struct Wheel {
    /// Its platform tag but for the oldest version of the system.
    tag: (&'static str, &'static str, &'static str),
    /// Folders of the libraries that it carries.
    folders: &'static [&'static str],
}

impl Wheel {
    const fn new(tag: (&'static str, &'static str, &'static str), folders: &'static [&'static str]) -> Self {
        Self { tag, folders }
    }

    /// Its platform tag, as pip and the index of Python packages know it: the libraries are checked for just this oldest
    /// system.
    pub fn tag(&self) -> String {
        let (system, oldest, processor) = self.tag;
        let oldest = oldest.replace('.', "_");
        let mut parts = vec![system, &oldest, processor];
        parts.retain(|part| !part.is_empty());
        parts.join("_")
    }
}

/// All of them.
pub const WHEELS: [Wheel; 4] = [
    Wheel::new(("manylinux", GLIBC, "x86_64"), &["linux64"]),
    Wheel::new(("manylinux", GLIBC, "aarch64"), &["aarch64-linux"]),
    Wheel::new(("win", "", "amd64"), &["win64"]),
    Wheel::new(("macosx", MACOS, "universal2"), &["darwin64", "aarch64-darwin"]),
];

/// All platforms.
pub const PLATFORMS: [Platform; 5] = [
    Platform::new("linux64", "so", &["x86_64-unknown-linux-gnu"]),
    Platform::new("aarch64-linux", "so", &["aarch64-unknown-linux-gnu"]),
    Platform::new("win64", "dll", &["x86_64-pc-windows-gnullvm"]),
    Platform::new("darwin64", "dylib", &["x86_64-apple-darwin", "aarch64-apple-darwin"]),
    Platform::new("aarch64-darwin", "dylib", &["aarch64-apple-darwin"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_library_is_in_one_wheel_and_tags_are_those_of_the_index() {
        for platform in &PLATFORMS {
            let carriers = WHEELS.iter().filter(|wheel| platform.is_of(wheel)).count();
            assert_eq!(carriers, 1, "{}", platform.folder);
        }
        assert_eq!(
            WHEELS.map(|wheel| wheel.tag()),
            [
                "manylinux_2_17_x86_64",
                "manylinux_2_17_aarch64",
                "win_amd64",
                "macosx_11_0_universal2"
            ]
        );
    }
}
