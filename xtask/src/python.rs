//! The Python environment `.venv`, with exactly what `requirements.txt` lists.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use indicatif::ProgressBar;

use crate::commands::{command, output, root};

/// Oldest Python for which the pinned packages exist.
const OLDEST: (u32, u32) = (3, 11);

/// The environment's folder.
fn folder() -> PathBuf {
    root().join(".venv")
}

/// The environment's interpreter.
fn interpreter() -> PathBuf {
    folder().join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    })
}

/// A command of the environment's Python, in the project's top folder.
pub fn python() -> Command {
    command(interpreter())
}

/// Makes the environment, unless it is there with the same requirements.
pub fn prepare() -> Result<()> {
    let wanted = fs::read_to_string(root().join("requirements.txt")).context("cannot read requirements.txt")?;
    // Written last, so that a half-made environment is made anew.
    let stamp = folder().join("requirements.txt");
    let current = fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted);
    if current && output(python().arg("--version")).is_ok() {
        return Ok(());
    }
    let python3 = system_python()?;
    let progress = ProgressBar::new_spinner().with_message("making .venv (Python packages of requirements.txt)");
    progress.enable_steady_tick(Duration::from_millis(100));
    output(command(python3).args(["-m", "venv", "--clear", ".venv"]))?;
    let pip = [
        "-m",
        "pip",
        "install",
        "--disable-pip-version-check",
        "--quiet",
        "-r",
        "requirements.txt",
    ];
    output(python().args(pip))?;
    fs::write(stamp, wanted)?;
    progress.finish_and_clear();
    Ok(())
}

/// The folder of the libclang that comes with the environment.
pub fn libclang() -> Result<PathBuf> {
    let code = "import clang, pathlib; print(pathlib.Path(clang.__path__[0]) / 'native')";
    let path = output(python().args(["-c", code]))?;
    Ok(PathBuf::from(path.trim()))
}

/// zig and cargo-zigbuild, which only the release needs: `prepare` leaves out what requirements.txt marks so.
pub fn zig() -> Result<(PathBuf, PathBuf)> {
    const MARK: &str = "; extra == 'release'";
    prepare()?;
    let requirements = fs::read_to_string(root().join("requirements.txt")).context("cannot read requirements.txt")?;
    let wanted = requirements.lines().filter_map(|line| line.strip_suffix(MARK));
    let progress = ProgressBar::new_spinner().with_message("installing zig (Python package of requirements.txt)");
    progress.enable_steady_tick(Duration::from_millis(100));
    let pip = ["-m", "pip", "install", "--disable-pip-version-check", "--quiet"];
    output(python().args(pip).args(wanted.map(str::trim)))?;
    progress.finish_and_clear();
    let code = "import pathlib, ziglang; print(pathlib.Path(ziglang.__path__[0]))";
    let zig = PathBuf::from(output(python().args(["-c", code]))?.trim()).join(format!("zig{EXE_SUFFIX}"));
    let zigbuild = interpreter().with_file_name(format!("cargo-zigbuild{EXE_SUFFIX}"));
    Ok((zig, zigbuild))
}

/// The machine's Python 3, if it can make environments.
fn system_python() -> Result<&'static str> {
    let version = |name: &str| {
        let code = "import sys; print(*sys.version_info[:2])";
        output(Command::new(name).args(["-c", code])).ok()
    };
    let found = ["python3", "python"]
        .into_iter()
        .find_map(|name| Some((name, version(name)?)));
    let Some((name, version)) = found else {
        bail!(
            "Python 3 is missing: install Python 3.11 or newer so that python3 is found (on Debian: apt-get install python3 python3-venv)"
        );
    };
    let numbers: Vec<u32> = version
        .split_whitespace()
        .filter_map(|number| number.parse().ok())
        .collect();
    if numbers.as_slice() < [OLDEST.0, OLDEST.1].as_slice() {
        let found = version.trim().replace(' ', ".");
        bail!(
            "Python {found} is too old: {}.{} or newer is needed",
            OLDEST.0,
            OLDEST.1
        );
    }
    if output(command(name).args(["-c", "import venv, ensurepip"])).is_err() {
        bail!("Python's venv module is missing: install it (on Debian: apt-get install python3-venv)");
    }
    Ok(name)
}
