//! Runs a built library where possible: on this machine, on Arm Linux under qemu, on Windows under Wine.
//!
//! Two C programs use the generated header: the example `embed.c`, linked with the library, runs a vibration in which it takes
//! steps back; `paper_scene.c` loads the library as an importer does and runs the published 1 kHz case. The forces of that run
//! are compared with those of the library in Rust on this machine.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{command, is_there, output, root};
use anyhow::{Context, Result, bail, ensure};
use relay_contact::C_HEADER;
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::RealOutput;

use super::platform::{GLIBC, Platform};
use crate::reference;

/// The scene that `paper_scene.c` runs.
const SCENE: &str = "scenes/paper-1khz.toml";

/// Where Debian's `libc6-arm64-cross` puts the C library of Arm.
const ARM: &str = "/usr/aarch64-linux-gnu";

/// Names of Wine; the last is Debian's `wine64` without the package `wine`.
const WINE: [&str; 3] = ["wine", "wine64", "/usr/lib/wine/wine64"];

/// Runs the library of a platform and returns the result as text: the output of both programs, or why they could not be run.
/// `zig` compiles programs for other machines than this one.
/// Errors are a program that does not compile, run or succeed, and a force that differs by more than the tolerance.
pub fn run(platform: &Platform, library: &Path, zig: &Path) -> Result<String> {
    let runner = match Runner::of(platform, zig) {
        Ok(runner) => runner,
        Err(reason) => return Ok(format!("NOT RUN, {reason}")),
    };
    let trial = Trial::prepare(runner, platform.folder, library)?;
    let embedded = trial.embedded()?;
    let (libraries, path): (&[_], _) = if platform.extension == "dll" {
        (&[], "RelayContact.dll".to_owned())
    } else {
        (&["-ldl"], format!("./RelayContact.{}", platform.extension))
    };
    let printed = trial.output("tests/c/paper_scene.c", libraries, &[&path])?;
    let forces = printed.lines().map(|line| line.trim().parse::<f64>());
    let forces: Vec<_> = forces.collect::<Result<_, _>>().context("not a force")?;
    let interruptions = embedded.lines().next().unwrap_or_default();
    Ok(format!("{interruptions}; published run: {}", compare(&forces)?))
}

/// How close forces of the published run are to those in Rust on this machine; an error where one differs by more than the
/// scene's tolerance allows.
fn compare(forces: &[f64]) -> Result<String> {
    let file = SceneFile::read(&root().join(SCENE))?;
    let mut expected = Vec::new();
    reference::run(&file, |simulation, time| {
        expected.push((time, simulation.real(RealOutput::ContactForce)));
        Ok(())
    })?;
    let (_, preload) = expected.first().context("no forces")?;
    let allowed = file.scene.solver.effective_tolerance() * preload;
    let count = forces.len();
    ensure!(count == expected.len(), "{count} forces instead of {}", expected.len());
    let mut largest = 0.0_f64;
    for (force, (time, expected)) in forces.iter().zip(&expected) {
        let difference = (force - expected).abs();
        ensure!(
            difference <= allowed,
            "{force} N at {time} s, but {expected} N on this machine; allowed difference {allowed:.1e} N"
        );
        largest = largest.max(difference);
    }
    Ok(if largest == 0.0 {
        format!("{count} forces, all with the bits of this machine's")
    } else {
        format!("{count} forces, largest difference {largest:.1e} N, allowed {allowed:.1e} N")
    })
}

/// How programs are compiled and started: a C compiler, and the words before a program.
pub struct Runner {
    pub compiler: Vec<OsString>,
    pub start: Vec<OsString>,
}

impl Runner {
    /// For the platform; otherwise the reason why there is none, and what to install.
    fn of(platform: &Platform, zig: &Path) -> Result<Self> {
        let by_zig = |target: &str, start: &[&str]| Self {
            compiler: vec![zig.into(), "cc".into(), "-target".into(), target.into()],
            start: start.iter().map(Into::into).collect(),
        };
        match platform.folder {
            _ if platform.is_host() => {
                ensure!(is_there("cc"), missing("cc", "gcc libc6-dev"));
                Ok(Self { compiler: vec!["cc".into()], start: Vec::new() })
            }
            "aarch64-linux" => {
                ensure!(is_there("qemu-aarch64"), missing("qemu-aarch64", "qemu-user"));
                let there = Path::new(ARM).join("lib/libc.so.6").exists();
                ensure!(there, missing("the C library of Arm", "libc6-arm64-cross"));
                Ok(by_zig(&format!("aarch64-linux-gnu.{}.{}", GLIBC[0], GLIBC[1]), &["qemu-aarch64", "-L", ARM]))
            }
            "win64" => {
                let wine = WINE.into_iter().find(|wine| is_there(wine));
                let wine = wine.with_context(|| missing("Wine", "wine64"))?;
                Ok(by_zig("x86_64-windows-gnu", &[wine]))
            }
            "linux64" => bail!("it runs only on 64-bit x86 Linux"),
            _ => bail!("it runs only on macOS"),
        }
    }
}

fn missing(what: &str, packages: &str) -> String {
    format!("{what} is missing (on Debian: apt-get install {packages})")
}

/// A folder with the library and the header.
pub struct Trial {
    runner: Runner,
    folder: PathBuf,
}

impl Trial {
    /// Makes the folder below `target/trial`.
    pub fn prepare(runner: Runner, name: &str, library: &Path) -> Result<Self> {
        let folder = root().join("target/trial").join(name);
        // So that no earlier library is found.
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| format!("cannot clear {}", folder.display()))?;
        }
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("relay_contact.h"), C_HEADER)?;
        // The second is for a program that is linked with it: it asks for the name that the library was built with.
        let extension = library.extension().context("a library without an extension")?;
        let prefix = if extension == "dll" { "" } else { "lib" };
        for name in ["RelayContact", &format!("{prefix}relay_contact")] {
            let copy = folder.join(name).with_extension(extension);
            fs::copy(library, &copy).with_context(|| format!("cannot copy to {}", copy.display()))?;
        }
        Ok(Self { runner, folder })
    }

    /// What the example `embed.c` prints, over 6 ms.
    pub fn embedded(&self) -> Result<String> {
        let arguments = ["400", "0.006", "embed.csv"];
        self.output("examples/embed.c", &["-lrelay_contact", "-lm"], &arguments)
    }

    /// Compiles a program without a warning, runs it and gives what it printed.
    fn output(&self, source: &str, libraries: &[&str], arguments: &[&str]) -> Result<String> {
        let source = root().join(source);
        let name = source.file_stem().context("a program without a name")?;
        // Windows requires the extension; the others ignore it.
        let program = self.folder.join(name).with_extension("exe");
        let mut compiler = words(&self.runner.compiler)?;
        compiler
            // Without fused operations, so that all platforms compute the same instants.
            .args(["-std=c99", "-O1", "-ffp-contract=off"])
            .args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
            .arg(&self.folder)
            .arg(source)
            .arg("-o")
            .arg(&program)
            .arg("-L")
            .arg(&self.folder)
            .args(libraries);
        output(&mut compiler)?;
        let mut start = words(&[self.runner.start.as_slice(), &[program.into()]].concat())?;
        start.current_dir(&self.folder).args(arguments);
        // Where Linux and macOS look for libraries first.
        for variable in ["LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH"] {
            start.env(variable, &self.folder);
        }
        start
            .env("WINEPREFIX", root().join("target/wine"))
            .env("WINEARCH", "win64")
            .env("WINEDEBUG", "-all")
            // No offer to download what is not needed.
            .env("WINEDLLOVERRIDES", "mscoree,mshtml=");
        output(&mut start)
    }
}

fn words(words: &[OsString]) -> Result<Command> {
    let (program, arguments) = words.split_first().context("no program")?;
    let mut command = command(program);
    command.args(arguments);
    Ok(command)
}

#[cfg(test)]
mod tests {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

    use super::*;

    #[test]
    fn here_the_library_gives_the_forces_of_rust() -> Result<()> {
        let host = Platform::host()?;
        // Built by cargo beside the tests.
        let library = std::env::current_exe()?.with_file_name(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"));
        let result = run(host, &library, Path::new("no zig"))?;
        // 20 ms in steps of 10 us, and the start; the same code on the same machine rounds the same.
        assert!(result.starts_with("interruptions of 5 us or more: "), "{result}");
        assert!(result.ends_with("2001 forces, all with the bits of this machine's"), "{result}");
        Ok(())
    }
}
