//! Running other programs in the project's folder, its files, and stages of work.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use std::{env, fs};

use anyhow::{Context, Result, bail, ensure};

/// Arguments of cargo's lint after the packages.
pub const LINT: [&str; 4] = ["--all-targets", "--", "-D", "warnings"];

/// The project's top folder: that of the package which cargo runs, or the current one.
pub fn root() -> PathBuf {
    // At run time, so that a copy of the project with its `target` folder uses its own files.
    let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let top = package.as_deref().and_then(Path::parent);
    top.map_or_else(|| PathBuf::from("."), Path::to_owned)
}

/// Reads a file of the project.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<u8>> {
    let path = root().join(path);
    fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
}

/// The same of a text.
pub fn text(path: impl AsRef<Path>) -> Result<String> {
    String::from_utf8(read(&path)?).with_context(|| path.as_ref().display().to_string())
}

/// Writes a file of the project, and its folder if there is none yet; gives its whole path.
pub fn write(path: impl AsRef<Path>, contents: impl AsRef<[u8]>) -> Result<PathBuf> {
    let path = root().join(path);
    fs::create_dir_all(path.parent().context("a file without a folder")?)?;
    fs::write(&path, contents).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// A program to run in the project's top folder.
pub fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    command(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The Python of `.venv`, which `cargo xtask` makes.
pub fn python() -> Command {
    command(root().join(if cfg!(windows) { ".venv/Scripts/python.exe" } else { ".venv/bin/python" }))
}

/// Runs a program and shows its output; the error names the whole command.
pub fn run(command: &mut Command) -> Result<()> {
    let status = command.status().with_context(|| format!("cannot start: {}", line(command)))?;
    ensure!(status.success(), "failed ({status}): {}", line(command));
    Ok(())
}

/// Runs a program and gives what it printed; the error has all of its output.
pub fn output(command: &mut Command) -> Result<String> {
    let output = command.output().with_context(|| format!("cannot start: {}", line(command)))?;
    if !output.status.success() {
        let [printed, message] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
        let all = format!("{printed}{message}");
        bail!("failed ({}): {}\n{}", output.status, line(command), all.trim());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// Whether a program is installed.
pub fn is_there(program: &str) -> bool {
    output(command(program).arg("--version")).is_ok()
}

/// Does the work of a stage and prints its duration.
pub fn stage<T>(name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    println!("== {name}");
    let start = Instant::now();
    let result = work()?;
    println!("== {name}: passed in {:.1} s", start.elapsed().as_secs_f64());
    Ok(result)
}

/// The folder of a Rust compiler, which has its libraries and documentation.
pub fn sysroot(rustc: impl AsRef<std::ffi::OsStr>) -> Result<PathBuf> {
    let sysroot = output(command(rustc).args(["--print", "sysroot"]))?;
    Ok(PathBuf::from(sysroot.trim()))
}

fn line(command: &Command) -> String {
    let words = [command.get_program()].into_iter().chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
