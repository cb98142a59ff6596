//! The documentation as a site that can be searched, also from its folder, without a server: the Markdown of the project as it
//! is, which the hook `report/site.py` gathers, beside the Python interface from its docstrings and the page that runs the
//! simulation.

use crate::commands::{read, root, run as run_command, write};
use anyhow::Result;

use crate::{explore, python};

/// Builds the site, and tests it in Chromium.
pub fn run() -> Result<()> {
    build()?;
    run_command(crate::commands::python().args(["-m", "pytest", "--quiet", "explore/test_site.py"]))?;
    println!("{}", root().join("out/site/html/index.html").display());
    Ok(())
}

/// Builds the site in `out/site/html`, and the page that runs the simulation; a dead link is an error.
pub fn build() -> Result<()> {
    write("out/site/source/explore.html", &read(explore::page()?)?)?;
    python::install("docs")?;
    let mut build = crate::commands::python();
    build.args(["-m", "mkdocs", "build", "--strict", "--quiet"]);
    run_command(build.env("NO_MKDOCS_2_WARNING", "1"))
}
