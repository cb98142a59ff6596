//! The page: a single file with everything in it.
//!
//! [`figure`]: what plotly.js is told to draw;   [`table`]: tables.

mod figure;
mod html;
#[cfg(test)]
pub mod sample;
mod table;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use commands::{output, python, root};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use relay_contact::MODEL_DESCRIPTION;
use roxmltree::Document;

use self::html::{head, markdown as html_of};
use crate::content::{Block, Figure, Section};

const SCRIPT: &str = include_str!("figures.js");

/// Anchor of the section that comes before the table of contents.
const SUMMARY: &str = "summary";

/// Writes `out/report/index.html`, or, if `quick`, `out/report-quick/index.html`.
pub fn write(sections: &[Section], quick: bool) -> Result<PathBuf> {
    let code = "import pathlib, plotly; print(pathlib.Path(plotly.__file__).parent / 'package_data/plotly.min.js')";
    let library = output(python().args(["-c", code]))?;
    let library = fs::read_to_string(library.trim()).with_context(|| format!("cannot read {}", library.trim()))?;
    let folder = root().join(if quick { "out/report-quick" } else { "out/report" });
    fs::create_dir_all(&folder)?;
    let path = folder.join("index.html");
    fs::write(&path, page(sections, quick, &library)?).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// The page as HTML, with the text of plotly.js.
fn page(sections: &[Section], quick: bool, library: &str) -> Result<String> {
    let document = Document::parse(MODEL_DESCRIPTION)?;
    let attribute = |name| document.root_element().attribute(name).unwrap_or_default();
    let (summary, others): (Vec<_>, Vec<_>) = sections.iter().partition(|section| section.id == SUMMARY);
    let blocks = sections.iter().flat_map(|section| &section.blocks);
    let figures: Vec<_> = blocks
        .filter_map(|block| match block {
            Block::Figure(figure) => Some(figure::plot(figure)),
            Block::Text(_) | Block::Table(_) => None,
        })
        .collect();
    // Within a script element only `<` could end it early.
    let figures = serde_json::to_string(&figures)?.replace('<', "\\u003c");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head("relay-contact: report"))
            body {
                header {
                    h1 { "relay-contact " span.faint { (attribute("version")) } }
                    p { (attribute("description")) "." }
                    p {
                        "An FMI 2.0 component for co-simulation. \"Ours\" are numbers of this component, computed when this page was written "
                        "where nothing else is said; published numbers name their source."
                    }
                    pre { code {
                        "cargo xtask report   # this page\n"
                        "cargo xtask demo     # builds the component, runs the published 1 kHz case under FMPy\n"
                        "cargo xtask test     # every check and test"
                    } }
                    @if quick {
                        p { strong { "Quick form: fewer points and runs than the full report." } }
                    }
                    noscript { p { strong { "The figures need JavaScript." } } }
                }
                main {
                    @for section in summary { (self::section(section)) }
                    nav aria-labelledby="contents" {
                        h2 #contents { "Contents" }
                        ol { @for section in &others { li { a href={ "#" (section.id) } { (section.title) } } } }
                    }
                    @for section in &others { (self::section(section)) }
                }
                script #figures type="application/json" { (PreEscaped(figures)) }
                script { (PreEscaped(library)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}

fn section(section: &Section) -> Markup {
    html! {
        section aria-labelledby=(section.id) {
            h2 id=(section.id) { (section.title) }
            @for block in &section.blocks {
                @match block {
                    Block::Text(text) => { (html_of(text)) }
                    Block::Table(table) => { (table::table(table)) }
                    Block::Figure(figure) => { (self::figure(figure)) }
                }
            }
        }
    }
}

fn figure(figure: &Figure) -> Markup {
    let axes = (figure::title(&figure.y), figure::title(&figure.x));
    html! {
        figure id=(figure.id) {
            h3 { (figure.title) }
            div.plot role="img" aria-label={ (figure.title) ": " (axes.0) " over " (axes.1) } {}
            figcaption { (html_of(&figure.caption)) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_section_figure_and_table_is_on_the_page_once() -> Result<()> {
        let page = page(&sample::sections(), false, "")?;
        for id in ["summary", "kinds", "history"] {
            assert_eq!(page.matches(&format!("id=\"{id}\"")).count(), 1, "{id}");
        }
        assert_eq!(page.matches("<table>").count(), 1);
        assert!(page.contains("<td class=\"number\">1397.6</td>"));
        let [summary, contents, kinds] = ["id=\"summary\"", "id=\"contents\"", "id=\"kinds\""].map(|id| page.find(id));
        assert!(summary < contents && contents < kinds);
        Ok(())
    }

    #[test]
    fn a_quick_page_says_so() -> Result<()> {
        assert!(page(&[], true, "")?.contains("Quick form"));
        assert!(!page(&[], false, "")?.contains("Quick form"));
        Ok(())
    }

    #[test]
    fn nothing_in_a_figure_ends_the_script_element_of_its_data() -> Result<()> {
        let mut sections = sample::sections();
        let figures = sections.iter_mut().flat_map(|section| &mut section.blocks);
        for block in figures {
            if let Block::Figure(figure) = block {
                figure
                    .curves
                    .iter_mut()
                    .for_each(|curve| "</script>".clone_into(&mut curve.name));
            }
        }
        assert_eq!(page(&sections, false, "")?.matches("</script>").count(), 3);
        Ok(())
    }
}
