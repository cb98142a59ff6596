//! The Python environment `.venv`, with exactly what `requirements.txt` lists.

use std::env::consts::EXE_SUFFIX;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{command, output, python, root, run, text, write};
use anyhow::{Context, Result, bail};

/// Runs the Python tests in folders or files, with the component.
pub fn test(tests: &[&str], component: &Path) -> Result<()> {
    run(python()
        .args(["-m", "pytest", "--quiet", "-rs"])
        // On all cores; the tests of a file on one, as they share what takes long to make.
        .args(["--numprocesses=logical", "--dist=loadfile"])
        .args(tests)
        // Their matrices are small: two threads wait for each other longer than one computes.
        .env("OPENBLAS_NUM_THREADS", "1")
        // Many tests start programs, which would compile all modules again.
        .env_remove("PYTHONDONTWRITEBYTECODE")
        .env("RELAY_CONTACT_FMU", component))
}

/// Runs a task of the package `report` with its options.
pub fn report(arguments: &[&str]) -> Result<()> {
    run(python().args(["-m", "report"]).args(arguments))
}

/// Creates the environment, unless it exists with the same requirements. Where another stage does so, waits for it.
pub fn prepare() -> Result<()> {
    let lock = File::open(write("out/python.lock", b"")?)?;
    lock.lock()?;
    let required = text("requirements.txt")?;
    // Written last, so that an unfinished environment is created again.
    let stamp = root().join(".venv/requirements.txt");
    let current = fs::read_to_string(&stamp).is_ok_and(|installed| installed == required);
    if current && output(python().arg("--version")).is_ok() {
        return Ok(());
    }
    let python3 = system_python()?;
    println!("creating .venv (Python packages of requirements.txt): a minute the first time");
    output(command(python3).args(["-m", "venv", "--clear", ".venv"]))?;
    install_packages(&["-r", "requirements.txt"], &required)?;
    // The project's own package is used from its folder.
    let link = "import os, sysconfig; site = sysconfig.get_path('purelib'); \
                open(os.path.join(site, 'relay_contact.pth'), 'w').write(os.path.relpath('python', site))";
    output(python().args(["-c", link]))?;
    Ok(fs::write(stamp, required)?)
}

/// Installs packages by uv, which takes a tenth of pip's time; by pip where uv cannot, as it does not read pip's settings.
fn install_packages(packages: &[&str], required: &str) -> Result<()> {
    // Modules are compiled when they are first imported; most never are.
    let by_pip = |packages: &[&str]| {
        let quick = ["--disable-pip-version-check", "--no-compile", "--quiet"];
        output(python().args(["-m", "pip", "install"]).args(quick).args(packages))
    };
    let uv = required.lines().find(|line| line.starts_with("uv=="));
    by_pip(&[uv.context("requirements.txt does not pin uv")?])?;
    let by_uv = output(python().args(["-m", "uv", "pip", "install", "--quiet"]).args(packages));
    if let Err(error) = by_uv {
        println!("uv cannot install them, pip does: {error:#}");
        by_pip(packages)?;
    }
    Ok(())
}

/// The folder of the libclang that comes with the environment.
pub fn libclang() -> Result<PathBuf> {
    Ok(package("clang")?.join("native"))
}

/// The folder of a package of the environment.
fn package(name: &str) -> Result<PathBuf> {
    let path = output(python().args(["-c", &format!("import {name}; print({name}.__path__[0])")]))?;
    Ok(PathBuf::from(path.trim()))
}

/// Adds the packages that only one task needs: marked in requirements.txt with its name, and not installed by [`prepare`].
pub fn install(task: &str) -> Result<()> {
    prepare()?;
    let required = text("requirements.txt")?;
    let mark = format!("; extra == '{task}'");
    println!("installing what the task {task} needs (Python packages of requirements.txt)");
    let marked = required.lines().filter_map(|line| line.strip_suffix(&mark));
    install_packages(&marked.map(str::trim).collect::<Vec<_>>(), &required)
}

/// zig and cargo-zigbuild, which only the release needs.
pub fn zig() -> Result<(PathBuf, PathBuf)> {
    install("release")?;
    let zigbuild = Path::new(python().get_program()).with_file_name(format!("cargo-zigbuild{EXE_SUFFIX}"));
    Ok((package("ziglang")?.join(format!("zig{EXE_SUFFIX}")), zigbuild))
}

/// The Python 3 of this machine, if it can create environments.
fn system_python() -> Result<&'static str> {
    let runs = |name: &str, code: &str| output(Command::new(name).args(["-c", code])).is_ok();
    let name = ["python3", "python"].into_iter().find(|name| runs(name, ""));
    let name = name.context(
        "Python 3 is missing: install Python 3.11 or newer so that python3 is found (on Debian: apt-get install python3 \
         python3-venv)",
    )?;
    // The oldest for which the pinned packages exist.
    if !runs(name, "import sys; assert sys.version_info >= (3, 11)") {
        let found = output(Command::new(name).arg("--version"))?;
        bail!("{} is too old: 3.11 or newer is needed", found.trim());
    }
    if !runs(name, "import venv, ensurepip") {
        bail!("Python's venv module is missing: install it (on Debian: apt-get install python3-venv)");
    }
    Ok(name)
}
