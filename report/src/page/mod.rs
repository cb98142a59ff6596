//! The page: a single file with everything in it.
//!
//! [`figure`]: figures for plotly.js;   [`table`]: tables.

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

/// Writes `out/report/index.html`, or, if `quick`, `out/report-quick/index.html`.
pub fn write(summary: &Section, main: &[Section], appendix: &[Section], quick: bool) -> Result<PathBuf> {
    let code = "import pathlib, plotly; print(pathlib.Path(plotly.__file__).parent / 'package_data/plotly.min.js')";
    let library = output(python().args(["-c", code]))?;
    let library = fs::read_to_string(library.trim()).with_context(|| format!("cannot read {}", library.trim()))?;
    let folder = root().join(if quick { "out/report-quick" } else { "out/report" });
    fs::create_dir_all(&folder)?;
    let path = folder.join("index.html");
    let page = page(summary, main, appendix, quick, &library)?;
    fs::write(&path, page).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}

/// The page as HTML, with the text of plotly.js.
fn page(summary: &Section, main: &[Section], appendix: &[Section], quick: bool, library: &str) -> Result<String> {
    let document = Document::parse(MODEL_DESCRIPTION)?;
    let attribute = |name| document.root_element().attribute(name).unwrap_or_default();
    let figures = main.iter().chain(appendix).flat_map(Section::figures);
    let figures: Vec<_> = figures.map(figure::plot).collect();
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
                        "An FMI 2.0 component for co-simulation. Where nothing else is said, its numbers were computed when this page was written; "
                        "published numbers name their source."
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
                    (section(summary))
                    nav aria-labelledby="contents" {
                        h2 #contents { "Contents" }
                        (contents(main))
                        p { "Appendix" }
                        (contents(appendix))
                    }
                    @for section in main { (self::section(section)) }
                    h1 #appendix { "Appendix" }
                    @for section in appendix { (self::section(section)) }
                }
                script #figures type="application/json" { (PreEscaped(figures)) }
                script { (PreEscaped(library)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}

fn contents(sections: &[Section]) -> Markup {
    html! { ul { @for section in sections { li { a href={ "#" (section.id) } { (section.title) } } } } }
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
            @if !figure.caption.is_empty() { figcaption { (html_of(&figure.caption)) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample_page(quick: bool) -> Result<String> {
        let [main, summary] = sample::sections();
        page(&summary, &[main], &[], quick, "")
    }

    #[test]
    fn every_section_figure_and_table_is_on_the_page_once() -> Result<()> {
        let page = sample_page(false)?;
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
        assert!(sample_page(true)?.contains("Quick form"));
        assert!(!sample_page(false)?.contains("Quick form"));
        Ok(())
    }

    #[test]
    fn nothing_in_a_figure_ends_the_script_element_of_its_data() -> Result<()> {
        let [mut main, summary] = sample::sections();
        for block in &mut main.blocks {
            if let Block::Figure(figure) = block {
                figure
                    .curves
                    .iter_mut()
                    .for_each(|curve| "</script>".clone_into(&mut curve.name));
            }
        }
        let page = page(&summary, &[main], &[], false, "")?;
        assert_eq!(page.matches("</script>").count(), 3);
        Ok(())
    }
}
