//! The documentation as a site that can be searched, also from its folder, without a server: the Markdown of the project as it
//! is, beside the Python interface from its docstrings and the page that runs the simulation.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::commands::{read, root, run as run_command, write};
use anyhow::{Context, Result, bail};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use crate::{explore, python};

/// Where pages are gathered, with the paths that they have in the project.
const SOURCE: &str = "out/site/source";

/// Folders of pages, beside those in the top folder.
const FOLDERS: [&str; 2] = ["docs", "."];

/// The page of the Python interface.
const PYTHON: &str = "# Python interface\n\n::: relay_contact\n\n::: relay_contact.qualification.qualify\n\n\
                      ::: relay_contact.qualification.Assessment\n\n::: relay_contact.qualification.Tested\n\n\
                      ::: relay_contact.qualification.Finding\n\n::: relay_contact.qualification.results.Margin\n\n\
                      ::: relay_contact.qualification.results.Chance\n\n::: relay_contact.comparison.compare\n\n\
                      ::: relay_contact.identification.identify\n";

/// Builds the site in `out/site/html`; a dead link is an error.
pub fn run() -> Result<()> {
    let wrong = dead_links()?;
    if !wrong.is_empty() {
        bail!("dead links:\n{}", wrong.join("\n"));
    }
    let source = root().join(SOURCE);
    if source.exists() {
        fs::remove_dir_all(&source).context("cannot clear the folder of pages")?;
    }
    let pages = pages()?;
    let linked = pages.iter().map(|page| Page::read(page)).collect::<Result<Vec<_>>>()?;
    let files: BTreeSet<_> = linked
        .iter()
        .flat_map(Page::files)
        .chain(pages.iter().cloned())
        .collect();
    for file in &files {
        copy(file)?;
    }
    write(Path::new(SOURCE).join("python.md"), PYTHON.as_bytes())?;
    write(Path::new(SOURCE).join("explore.html"), &read(explore::page()?)?)?;
    let search = "iframe-worker.js";
    write(
        Path::new(SOURCE).join(search),
        &read(Path::new("explore/page").join(search))?,
    )?;
    python::install("docs")?;
    let mut build = crate::commands::python();
    build.args(["-m", "mkdocs", "build", "--strict", "--quiet"]);
    run_command(build.env("NO_MKDOCS_2_WARNING", "1"))?;
    run_command(crate::commands::python().args(["-m", "pytest", "--quiet", "explore/test_site.py"]))?;
    println!("{}", root().join("out/site/html/index.html").display());
    Ok(())
}

/// Copies a file, or all files in a folder.
fn copy(path: &Path) -> Result<()> {
    if root().join(path).is_dir() {
        for entry in fs::read_dir(root().join(path))? {
            copy(&path.join(entry?.file_name()))?;
        }
        return Ok(());
    }
    write(Path::new(SOURCE).join(path), &read(path)?)?;
    Ok(())
}

/// All pages, relative to the top folder.
fn pages() -> Result<Vec<PathBuf>> {
    let mut pages = Vec::new();
    for folder in FOLDERS {
        for entry in fs::read_dir(root().join(folder))? {
            let path = entry?.path();
            if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(
                    path.strip_prefix(root())?
                        .components()
                        .filter(|part| *part != Component::CurDir)
                        .collect(),
                );
            }
        }
    }
    pages.sort();
    Ok(pages)
}

/// What a page leads to, and where others may lead in it.
struct Page {
    path: PathBuf,
    links: Vec<String>,
    anchors: BTreeSet<String>,
}

impl Page {
    fn read(path: &Path) -> Result<Self> {
        let text = String::from_utf8(read(path)?).with_context(|| path.display().to_string())?;
        let mut page = Self {
            path: path.to_owned(),
            links: Vec::new(),
            anchors: BTreeSet::new(),
        };
        let mut heading: Option<String> = None;
        for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.into_string());
                }
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => page.anchors.extend(heading.take().map(|text| anchor(&text))),
                Event::Text(text) | Event::Code(text) => {
                    if let Some(heading) = &mut heading {
                        heading.push_str(&text);
                    }
                }
                _ => {}
            }
        }
        Ok(page)
    }

    /// Links within the project: the path that one leads to, relative to the top folder, and the part of the page.
    fn within(&self) -> impl Iterator<Item = (PathBuf, &str)> {
        let own = self
            .links
            .iter()
            .filter(|link| !link.contains("://") && !link.starts_with("mailto:"));
        own.map(|link| {
            let (path, part) = link.split_once('#').unwrap_or((link, ""));
            let place = match path {
                "" => self.path.clone(),
                path => plain(&self.path.parent().unwrap_or(Path::new("")).join(path)),
            };
            (place, part)
        })
    }

    fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.within().map(|(path, _)| path)
    }
}

/// The path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

/// The part of an address that leads to a heading, as forges make it, and mkdocs.yml says.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Links of all pages to files or headings that are not there.
fn dead_links() -> Result<Vec<String>> {
    let pages = pages()?
        .iter()
        .map(|path| Page::read(path))
        .collect::<Result<Vec<_>>>()?;
    let mut wrong = Vec::new();
    for page in &pages {
        for (path, part) in page.within() {
            let there = root().join(&path).exists();
            let heading = part.is_empty()
                || pages
                    .iter()
                    .find(|other| other.path == path)
                    .is_some_and(|other| other.anchors.contains(part));
            if !there || !heading {
                wrong.push(format!("{}: {}#{part}", page.path.display(), path.display()));
            }
        }
    }
    Ok(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_link_is_dead() -> Result<()> {
        assert_eq!(dead_links()?, Vec::<String>::new());
        Ok(())
    }

    #[test]
    fn links_and_headings_are_seen() -> Result<()> {
        let readme = Page::read(Path::new("README.md"))?;
        assert!(readme.files().any(|path| path == Path::new("docs/importers.md")));
        assert!(readme.anchors.contains("limits-of-validity"));
        let importers = Page::read(Path::new("docs/importers.md"))?;
        assert!(
            importers
                .files()
                .any(|path| path == Path::new("conformance/SystemStructure.ssd"))
        );
        assert_eq!(anchor("What `it` is: 98 m/s²"), "what-it-is-98-ms²");
        Ok(())
    }

    #[test]
    fn every_page_is_in_the_menu_of_the_site() -> Result<()> {
        let menu = String::from_utf8(read("mkdocs.yml")?)?;
        for page in pages()? {
            assert!(menu.contains(&format!(": {}\n", page.display())), "{}", page.display());
        }
        Ok(())
    }
}
