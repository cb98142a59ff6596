//! The page `documentation/index.html` of the component: the variables from `modelDescription.xml`, the words from
//! the README, so that neither is written twice.

mod block;
mod description;

use std::fs;

use anyhow::{Context, Result, ensure};
use commands::root;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use pulldown_cmark::Parser;
use relay_contact::MODEL_DESCRIPTION;
use roxmltree::{Document, Node};

use self::block::block;
use self::description::{attribute, start, unit};

/// That of the report.
const STYLE: &str = include_str!("../../../report/src/page/style.css");

/// Sections of the README that the page repeats.
const SECTIONS: [&str; 2] = ["Limits of validity", "Source"];

/// The page as HTML.
pub fn page() -> Result<String> {
    let readme = fs::read_to_string(root().join("README.md")).context("cannot read README.md")?;
    let document = Document::parse(MODEL_DESCRIPTION)?;
    let model = document.root_element();
    let name = attribute(model, "modelName");
    let version = attribute(model, "version");
    let sections = SECTIONS.map(|title| section(&readme, title).map(|text| (title, markdown(text))));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (name) " " (version) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (name) " " span.faint { (version) } }
                (markdown(introduction(&readme)?))
                p { "FMI 2.0 for co-simulation. All values are in SI units. Licence: " (attribute(model, "license"))
                    "; the texts, also those of the libraries linked in, are in the folder " a href="licenses/" { "licenses" } "." }
                (scroll("The component as a block", &block(&document)))
                @for (title, causality) in [("Inputs", "input"), ("Outputs", "output"),
                    ("Calculated parameters", "calculatedParameter"), ("Parameters", "parameter")] {
                    h2 { (title) }
                    (scroll(title, &variables(&document, causality)))
                }
                h2 { "Choices" }
                (scroll("Choices", &choices(&document)))
                @for section in sections {
                    @let (title, text) = section?;
                    h2 { (title) }
                    (text)
                }
            }
        }
    };
    Ok(page.into_string())
}

fn markdown(text: &str) -> Markup {
    let mut html = String::new();
    pulldown_cmark::html::push_html(&mut html, Parser::new(text));
    PreEscaped(html)
}

/// What may be wider than the page, in a box that scrolls.
fn scroll(label: &str, content: &Markup) -> Markup {
    html! { div.scroll role="region" tabindex="0" aria-label=(label) { (content) } }
}

fn variables(document: &Document, causality: &str) -> Markup {
    let rows = document
        .descendants()
        .filter(|node| node.has_tag_name("ScalarVariable") && attribute(*node, "causality") == causality);
    html! {
        table {
            tr { th { "name" } th { "type" } th { "unit" } th { "causality" } th { "start" } th { "min" } th { "max" } th { "description" } }
            @for variable in rows {
                @let value = variable.first_element_child().unwrap_or(variable);
                @let enumeration = value.has_tag_name("Enumeration");
                tr {
                    td { code { (attribute(variable, "name")) } }
                    td { @if enumeration { (attribute(value, "declaredType")) } @else { (value.tag_name().name()) } }
                    td { (unit(document, value)) }
                    td { (causality) }
                    td { (start(document, value)) }
                    td { (attribute(value, "min")) }
                    td { (attribute(value, "max")) }
                    td { (attribute(variable, "description")) }
                }
            }
        }
    }
}

fn choices(document: &Document) -> Markup {
    let types = document
        .descendants()
        .filter(|node| node.has_tag_name("Enumeration") && node.has_children());
    html! {
        table {
            tr { th { "type" } th { "choice" } th { "value" } th { "description" } }
            @for list in types {
                @let name = list.parent().map_or("", |definition| attribute(definition, "name"));
                @for item in list.children().filter(Node::is_element) {
                    tr {
                        td { (name) }
                        td { code { (attribute(item, "name")) } }
                        td { (attribute(item, "value")) }
                        td { (attribute(item, "description")) }
                    }
                }
            }
        }
    }
}

/// The README's first paragraph.
fn introduction(readme: &str) -> Result<&str> {
    let mut paragraphs = readme.split("\n\n");
    let paragraph = paragraphs.find(|text| !text.starts_with(['#', '!']));
    paragraph.context("README.md has no introduction")
}

/// The text below a heading of the README, up to the next one.
fn section<'a>(readme: &'a str, title: &str) -> Result<&'a str> {
    let heading = format!("\n## {title}\n");
    let (_, rest) = readme
        .split_once(&heading)
        .with_context(|| format!("README.md has no section {title:?}"))?;
    let text = rest.split("\n## ").next().unwrap_or(rest).trim();
    ensure!(!text.is_empty(), "section {title:?} of README.md is empty");
    Ok(text)
}

#[cfg(test)]
mod tests {
    use relay_contact::variables::VARIABLES;

    use super::*;

    #[test]
    fn every_variable_and_every_section_is_on_the_page() -> Result<()> {
        let page = page()?;
        for variable in &VARIABLES {
            let cell = format!("<td><code>{}</code></td>", variable.name);
            assert_eq!(page.matches(&cell).count(), 1, "{}", variable.name);
        }
        for title in SECTIONS {
            assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
        }
        assert!(page.contains("<td>m</td><td>parameter</td><td>0.0155</td><td>1e-3</td><td>0.2</td><td>Free length"));
        assert!(page.contains("<td>AxialForceKind</td><td></td><td>parameter</td><td>None</td>"));
        Ok(())
    }
}
