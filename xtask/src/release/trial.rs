//! Tries a built library where it can be run: on this machine itself, an Arm Linux under qemu, Windows under Wine.
//!
//! Two C programs with the generated header: the life of two instances, linked with the library, and the published 1 kHz
//! run, which loads it as an importer does. The forces of that run are compared with our own, in Rust on this machine.

use std::env::consts::{ARCH, OS};
use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use relay_contact::C_HEADER;
use relay_contact::variables::RealOutput;

use super::platform::Platform;
use crate::commands::{command, output, root};
use crate::scene;

/// The scene that `paper_scene.c` runs.
const SCENE: &str = "paper-1khz";

/// Where Debian's `libc6-arm64-cross` puts the C library of Arm.
const ARM: &str = "/usr/aarch64-linux-gnu";

/// What Wine can be called; the last is Debian's `wine64` without the package `wine`.
const WINE: [&str; 3] = ["wine", "wine64", "/usr/lib/wine/wine64"];

/// What became of a trial; one that failed is an error.
#[derive(Debug)]
pub enum Outcome {
    /// Both programs did what they should: what the one printed, the forces of the other.
    Ran(String, Closeness),
    /// Why not, and what to install.
    NotRun(String),
}

impl Display for Outcome {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        match self {
            Self::Ran(life, closeness) => write!(formatter, "{life}; published run: {closeness}"),
            Self::NotRun(reason) => write!(formatter, "NOT RUN, {reason}"),
        }
    }
}

/// How close the contact forces of two runs are.
#[derive(Debug)]
pub struct Closeness {
    /// Number of forces.
    pub forces: usize,
    /// Largest difference, N.
    pub largest: f64,
    /// What the scene's tolerance allows, N.
    pub allowed: f64,
}

impl Display for Closeness {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        let Self {
            forces,
            largest,
            allowed,
        } = self;
        if *largest == 0.0 {
            write!(formatter, "{forces} forces, all with the bits of this machine's")
        } else {
            write!(
                formatter,
                "{forces} forces, largest difference {largest:.1e} N, allowed {allowed:.1e} N"
            )
        }
    }
}

/// Tries the library of a platform. Programs for other machines than this one are compiled by `zig`.
///
/// # Errors
/// A program that does not compile, does not run, or runs wrongly; a force that differs by more than the tolerance.
pub fn run(platform: &Platform, library: &Path, zig: &Path) -> Result<Outcome> {
    let runner = match Runner::of(platform, zig) {
        Ok(runner) => runner,
        Err(reason) => return Ok(Outcome::NotRun(reason)),
    };
    let trial = Trial::prepare(runner, platform, library)?;
    let life = passed(&trial.output("life_cycle", &["-lrelay_contact", "-lm"], &[])?)?;
    let (own, allowed) = own_forces()?;
    Ok(Outcome::Ran(life, compare(&trial.forces()?, &own, allowed)?))
}

/// What compiles and starts programs of a platform.
enum Runner {
    Native,
    Qemu { zig: PathBuf },
    Wine { zig: PathBuf, wine: &'static str },
}

impl Runner {
    /// For the platform; else why there is none, and what to install.
    fn of(platform: &Platform, zig: &Path) -> Result<Self, String> {
        if is_host(platform) {
            needed("cc", "gcc libc6-dev")?;
            return Ok(Self::Native);
        }
        match platform.folder {
            "aarch64-linux" => {
                needed("qemu-aarch64", "qemu-user")?;
                if !Path::new(ARM).join("lib/libc.so.6").exists() {
                    return Err(missing("the C library of Arm", "libc6-arm64-cross"));
                }
                Ok(Self::Qemu { zig: zig.to_owned() })
            }
            "win64" => {
                let wine = WINE.into_iter().find(|wine| is_there(wine));
                let wine = wine.ok_or_else(|| missing("Wine", "wine64"))?;
                Ok(Self::Wine {
                    zig: zig.to_owned(),
                    wine,
                })
            }
            "linux64" => Err("it runs on 64-bit x86 Linux alone".to_owned()),
            _ => Err("it runs on macOS alone".to_owned()),
        }
    }

    fn compiler(&self) -> Command {
        let (zig, target) = match self {
            Self::Native => return command("cc"),
            Self::Qemu { zig } => (zig, "aarch64-linux-gnu.2.17"),
            Self::Wine { zig, .. } => (zig, "x86_64-windows-gnu"),
        };
        let mut compiler = command(zig);
        compiler.args(["cc", "-target", target]);
        compiler
    }

    fn start(&self, program: &Path) -> Command {
        match self {
            Self::Native => command(program),
            Self::Qemu { .. } => {
                let mut start = command("qemu-aarch64");
                start.args(["-L", ARM]).arg(program);
                start
            }
            Self::Wine { wine, .. } => {
                let mut start = command(wine);
                start
                    .arg(program)
                    .env("WINEPREFIX", root().join("target/wine"))
                    .env("WINEARCH", "win64")
                    .env("WINEDEBUG", "-all")
                    // No offer to download what is not needed.
                    .env("WINEDLLOVERRIDES", "mscoree,mshtml=");
                start
            }
        }
    }
}

/// Whether this machine is one of the platform.
pub fn is_host(platform: &Platform) -> bool {
    let system = if OS == "macos" { "darwin" } else { OS };
    let mut targets = platform.targets.iter();
    targets.any(|target| target.starts_with(ARCH) && target.contains(system))
}

fn is_there(program: &str) -> bool {
    output(command(program).arg("--version")).is_ok()
}

fn needed(program: &str, packages: &str) -> Result<(), String> {
    is_there(program)
        .then_some(())
        .ok_or_else(|| missing(program, packages))
}

fn missing(what: &str, packages: &str) -> String {
    format!("{what} is missing (on Debian: apt-get install {packages})")
}

/// A folder with the library and the header.
struct Trial {
    runner: Runner,
    folder: PathBuf,
    is_windows: bool,
    /// As it is called in the archive.
    library: String,
}

impl Trial {
    fn prepare(runner: Runner, platform: &Platform, library: &Path) -> Result<Self> {
        let folder = root().join("target/trial").join(platform.folder);
        // Nothing of an earlier library may be found.
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| format!("cannot clear {}", folder.display()))?;
        }
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("relay_contact.h"), C_HEADER)?;
        let trial = Self {
            runner,
            folder,
            is_windows: platform.extension == "dll",
            library: format!("RelayContact.{}", platform.extension),
        };
        let prefix = if trial.is_windows { "" } else { "lib" };
        // A linked program asks for the name that the library was built with.
        let linked = format!("{prefix}relay_contact.{}", platform.extension);
        for name in [&trial.library, &linked] {
            fs::copy(library, trial.folder.join(name))
                .with_context(|| format!("cannot copy {} to {}", library.display(), trial.folder.display()))?;
        }
        Ok(trial)
    }

    /// Compiles a program of `tests/c`, without a warning.
    fn compile(&self, name: &str, extension: &str, last: &[&str]) -> Result<PathBuf> {
        let program = self.folder.join(name).with_extension(extension);
        // Without fused operations, so that all platforms reckon the same instants.
        let mut compiler = self.runner.compiler();
        compiler
            .args(["-std=c99", "-O1", "-ffp-contract=off"])
            .args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
            .arg(&self.folder)
            .arg(root().join("tests/c").join(name).with_extension("c"))
            .arg("-o")
            .arg(&program)
            .arg("-L")
            .arg(&self.folder)
            .args(last);
        output(&mut compiler)?;
        Ok(program)
    }

    /// Compiles a program, runs it and gives what it printed.
    fn output(&self, name: &str, libraries: &[&str], arguments: &[&str]) -> Result<String> {
        let extension = if self.is_windows { "exe" } else { "" };
        let program = self.compile(name, extension, libraries)?;
        let mut start = self.runner.start(&program);
        start.current_dir(&self.folder).args(arguments);
        // Where Linux and macOS look first.
        for variable in ["LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH"] {
            start.env(variable, &self.folder);
        }
        output(&mut start)
    }

    /// Contact forces of the published run, N.
    fn forces(&self) -> Result<Vec<f64>> {
        let (libraries, path): (&[_], _) = if self.is_windows {
            (&[], self.library.clone())
        } else {
            (&["-ldl"], format!("./{}", self.library))
        };
        let printed = self.output("paper_scene", libraries, &[&path])?;
        let forces = printed.lines().map(|line| line.trim().parse());
        forces.collect::<Result<_, _>>().context("not a force")
    }
}

/// What the life of two instances printed, unless it ended early.
fn passed(printed: &str) -> Result<String> {
    let printed = printed.trim();
    if !printed.starts_with("life cycle passed") {
        bail!("the life of two instances ended early, with: {printed}");
    }
    Ok(printed.to_owned())
}

/// Contact forces of the published run in Rust on this machine, and what the scene's tolerance allows, both in N.
fn own_forces() -> Result<(Vec<f64>, f64)> {
    let file = scene::read(SCENE)?;
    let mut contact = scene::start(&file)?;
    let mut forces = vec![contact.real(RealOutput::ContactForce)];
    for (time, size) in file.steps() {
        contact.step(&file.inputs_over(time, size)?, time, size)?;
        forces.push(contact.real(RealOutput::ContactForce));
    }
    let allowed = file.scene.solver.effective_tolerance() * contact.model().force_scale;
    Ok((forces, allowed))
}

/// An error unless every force is as near to our own as is allowed, N.
fn compare(forces: &[f64], own: &[f64], allowed: f64) -> Result<Closeness> {
    if forces.len() != own.len() {
        bail!("{} forces instead of {}", forces.len(), own.len());
    }
    let mut largest = 0.0_f64;
    for (n, (force, own)) in forces.iter().zip(own).enumerate() {
        let difference = (force - own).abs();
        // What is not a number is not near either.
        if difference.is_nan() || difference > allowed {
            bail!("force {n} is {force} N, but {own} N on this machine; allowed is a difference of {allowed:.1e} N");
        }
        largest = largest.max(difference);
    }
    Ok(Closeness {
        forces: forces.len(),
        largest,
        allowed,
    })
}

#[cfg(test)]
mod tests {
    use super::super::platform::PLATFORMS;
    use super::*;

    /// Built by cargo beside the tests, as the library that they use.
    fn library() -> Result<PathBuf> {
        let test = std::env::current_exe()?;
        let folder = test.parent().context("a test without a folder")?;
        Ok(folder.join(format!(
            "{}relay_contact{}",
            std::env::consts::DLL_PREFIX,
            std::env::consts::DLL_SUFFIX
        )))
    }

    fn host() -> Result<&'static Platform> {
        let mut hosts = PLATFORMS.iter().filter(|platform| is_host(platform));
        hosts.next().context("no library is released for this machine")
    }

    fn no_zig() -> &'static Path {
        Path::new("no zig")
    }

    #[test]
    fn here_the_library_gives_the_forces_of_rust() -> Result<()> {
        let no_library = root().join("xtask/Cargo.toml");
        assert!(run(host()?, &no_library, no_zig()).is_err());
        let Outcome::Ran(_, closeness) = run(host()?, &library()?, no_zig())? else {
            bail!("not run");
        };
        // 20 ms in steps of 10 us, and the start; the same code on the same machine rounds the same.
        assert_eq!((closeness.forces, closeness.largest), (2001, 0.0));
        Ok(())
    }

    #[test]
    fn a_life_that_ends_early_has_not_passed() {
        assert!(passed("life cycle passed, contact force 0.1 N\r\n").is_ok());
        assert!(passed("").is_err());
    }

    #[test]
    fn a_library_without_a_machine_to_run_on_is_told_as_not_run() -> Result<()> {
        let [.., mac] = &PLATFORMS;
        if is_host(mac) {
            return Ok(());
        }
        let outcome = run(mac, &library()?, no_zig())?;
        assert!(matches!(outcome, Outcome::NotRun(_)), "{outcome}");
        assert_eq!(outcome.to_string(), "NOT RUN, it runs on macOS alone");
        Ok(())
    }

    #[test]
    fn a_force_counts_as_equal_up_to_the_tolerance() -> Result<()> {
        let (own, allowed) = own_forces()?;
        let changed = |n: usize, change: f64| {
            let mut forces = own.clone();
            if let Some(force) = forces.get_mut(n) {
                *force += change;
            }
            compare(&forces, &own, allowed)
        };
        for n in [0, 1, own.len() - 1] {
            assert!(changed(n, 1.1 * allowed).is_err());
            assert!(changed(n, -1.1 * allowed).is_err());
            assert!(changed(n, f64::NAN).is_err());
            let closeness = changed(n, -0.9 * allowed)?;
            assert!((closeness.largest / allowed - 0.9).abs() < 1e-6, "{closeness}");
        }
        let (_, fewer) = own.split_last().context("no forces")?;
        assert!(compare(fewer, &own, allowed).is_err());
        // The tolerance of a scene that gives none, of the preload of 0.152 N.
        assert!((allowed / 0.152e-6 - 1.0).abs() < 0.01, "{allowed}");
        Ok(())
    }
}
