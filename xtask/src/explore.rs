//! The page that runs the simulation: one file, with the library in WebAssembly.

use std::io::Write as _;
use std::path::PathBuf;

use crate::commands::{cargo, read, run, text, write};
use anyhow::{Result, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use relay_contact::variables::VARIABLES;
use serde_json::json;

use crate::release::build;
use crate::release::tools::{Rust, lld};
use crate::{fmu, python};

/// What cargo calls the platform.
const TARGET: &str = "wasm32-unknown-unknown";

/// Largest size of the page, in bytes.
const SIZE: usize = 1_500_000;

/// Builds the page as `dist/explore.html`, and tests it in Chromium with the component beside it.
pub fn run_task() -> Result<()> {
    python::prepare()?;
    let page = page()?;
    python::test(&["explore/test_page.py"], &fmu::build()?)?;
    println!("{}", page.display());
    Ok(())
}

/// Writes the page and returns its path.
pub fn page() -> Result<PathBuf> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&library()?)?;
    let library = STANDARD.encode(packed.finish()?);
    let start: serde_json::Map<_, _> =
        VARIABLES.iter().map(|variable| (variable.name.to_owned(), json!(variable.start))).collect();
    let part = |name: &str| text(format!("explore/page/{name}"));
    let mut page = part("page.html")?;
    for (mark, contents) in [
        ("/*style*/", part("style.css")?),
        ("/*start values*/", serde_json::to_string(&start)?),
        ("/*worker*/", part("worker.js")?),
        ("/*scene*/", part("scene.js")?),
        ("/*plot*/", part("plot.js")?),
        ("/*page*/", part("page.js")?),
        ("/*version*/", env!("CARGO_PKG_VERSION").to_owned()),
        ("/*library*/", library),
    ] {
        let count = page.matches(mark).count();
        ensure!(count == 1, "explore/page/page.html: not once: {mark}");
        page = page.replace(mark, &contents);
    }
    let size = page.len();
    ensure!(size <= SIZE, "the page has {size} bytes; at most {SIZE} are allowed");
    write("dist/explore.html", page)
}

/// The library in WebAssembly.
fn library() -> Result<Vec<u8>> {
    let rust = Rust::find()?;
    let linker = format!("-Clinker={}", lld(&rust.rustc)?.display());
    let mut build = cargo();
    build.args(fmu::CARGO_RUSTC).arg("--package=explore");
    build::with_std(&mut build, &rust, "panic_abort", vec![linker])?;
    run(build.arg(format!("--target={TARGET}")))?;
    read(build::folder()?.join(TARGET).join("release/explore.wasm"))
}
