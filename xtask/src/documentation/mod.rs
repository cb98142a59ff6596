//! The page `documentation/index.html` of a variant of the component: the variables from its `modelDescription.xml`, the
//! words from the README and the page on spring files, so that none is written twice.

mod block;
#[expect(dead_code, reason = "the build script uses more of it")]
#[path = "../../../build/description.rs"]
mod description;

use crate::commands::text;
use anyhow::{Context, Error, Result, ensure};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use roxmltree::{Document, Node};

use self::block::block;
use self::description::{Variable, variables};
use crate::variant::Variant;

/// Those of the report.
const STYLE: &str = include_str!("../../../report/style.css");
const SCRIPT: &str = include_str!("../../../report/wider.js");

/// Sections of the README that the page repeats.
const SECTIONS: [&str; 2] = ["Limits of validity", "Source"];

/// Headings of the other parts of the page, and which variables are below the first ones.
const CAUSALITIES: [(&str, &str); 4] = [
    ("Inputs", "input"),
    ("Outputs", "output"),
    ("Calculated parameters", "calculatedParameter"),
    ("Parameters", "parameter"),
];
const CHOICES: &str = "Choices";
const SPRING_FILES: &str = "Spring files";

/// The page as HTML.
pub fn page(variant: &Variant) -> Result<String> {
    let readme = text("README.md")?;
    let springs = text("docs/spring-files.md")?;
    let springs = springs.trim_start_matches("# Spring files").replace("\n## ", "\n### ");
    let document = Document::parse(&variant.description)?;
    let model = document.root_element();
    let variables = variables(&document).map_err(Error::msg)?;
    let name = attribute(model, "modelName");
    let version = attribute(model, "version");
    let sections = SECTIONS.map(|title| section(&readme, title).map(|text| (title, markdown(text))));
    let mut enumerations: Vec<_> = document.descendants().filter(|node| node.has_tag_name("Enumeration")).collect();
    enumerations.retain(Node::has_children);
    let choices_or_none = (!enumerations.is_empty()).then_some(CHOICES);
    let titles =
        CAUSALITIES.iter().map(|(title, _)| *title).chain(choices_or_none).chain(SECTIONS).chain([SPRING_FILES]);
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
                    "; the texts, also those of the libraries linked in, are listed in " a href="licenses/license.txt" { "licenses/license.txt" } "." }
                @if let Some((file, _)) = &variant.spring {
                    p { "This component carries the spring of " a href="#spring" { (file) } ", the start value of " code { "beam.file" } "." }
                }
                nav { ul { @for title in titles { li { a href=(format!("#{}", anchor(title))) { (title) } } } } }
                (scroll("The component as a block", &block(name, &variables)))
                @for (title, causality) in CAUSALITIES {
                    @let own: Vec<_> = variables.iter().filter(|variable| variable.causality == causality).collect();
                    (heading(title))
                    (scroll(title, &table(&own)))
                }
                @if !enumerations.is_empty() {
                    (heading(CHOICES))
                    (scroll("Choices", &choices(&enumerations)))
                }
                @for section in sections {
                    @let (title, text) = section?;
                    (heading(title))
                    (text)
                }
                @if let Some((file, text)) = &variant.spring {
                    h2 id="spring" { (file) }
                    (scroll(file, &html! { pre { code { (text) } } }))
                }
                (heading(SPRING_FILES))
                (markdown(&springs))
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}

/// The text without links to other files of the project, which are not in the archive.
fn markdown(text: &str) -> Markup {
    let mut html = String::new();
    let mut leads_out = false;
    let events = Parser::new_ext(text, Options::ENABLE_TABLES).filter(|event| match event {
        Event::Start(Tag::Link { dest_url, .. }) => {
            leads_out = dest_url.contains("://");
            leads_out
        }
        Event::End(TagEnd::Link) => leads_out,
        _ => true,
    });
    pulldown_cmark::html::push_html(&mut html, events);
    let (open, close) =
        (r#"<div class="scroll" role="region" tabindex="0" aria-label="Table"><table>"#, "</table></div>");
    PreEscaped(html.replace("<table>", open).replace("</table>", close))
}

/// A heading to which the contents lead.
fn heading(title: &str) -> Markup {
    html! { h2 id=(anchor(title)) { (title) } }
}

/// The part of the address that leads to a heading.
fn anchor(title: &str) -> String {
    title.to_lowercase().replace(' ', "-")
}

/// What may be wider than the page, in a box that scrolls.
fn scroll(label: &str, content: &Markup) -> Markup {
    html! { div.scroll role="region" tabindex="0" aria-label=(label) { (content) } }
}

/// An attribute, or nothing.
fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or("")
}

/// Variables of one causality. The start value of an enumeration is the choice's name.
fn table(variables: &[&Variable]) -> Markup {
    // Outputs have neither.
    let is_set = variables.iter().any(|variable| variable.value.has_attribute("start"));
    html! {
        table {
            tr { th { "name" } th { "description" } th { "unit" } @if is_set { th.number { "start" } th.number { "range" } } th { "type" } }
            @for variable in variables {
                @let value = variable.value;
                @let start = attribute(value, "start");
                tr {
                    td { code { (variable.name) } }
                    td { (variable.description) }
                    td { (variable.unit) }
                    @if is_set {
                        td.number { (variable.choice(start).unwrap_or(start)) }
                        td.number { @if value.has_attribute("min") { (attribute(value, "min")) " to " (attribute(value, "max")) } }
                    }
                    td { @if variable.kind == "Enumeration" { (attribute(value, "declaredType")) } @else { (variable.kind) } }
                }
            }
        }
    }
}

/// The choices of enumerations.
fn choices(enumerations: &[Node]) -> Markup {
    html! {
        table {
            tr { th { "type" } th { "choice" } th { "value" } th { "description" } }
            @for list in enumerations {
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
    let (_, rest) = readme.split_once(&heading).with_context(|| format!("README.md has no section {title:?}"))?;
    let text = rest.split("\n## ").next().unwrap_or(rest).trim();
    ensure!(!text.is_empty(), "section {title:?} of README.md is empty");
    Ok(text)
}

#[cfg(test)]
mod tests {
    use crate::commands::root;
    use relay_contact::variables::VARIABLES;

    use super::*;

    #[test]
    fn every_variable_and_every_section_is_on_the_page() -> Result<()> {
        let page = page(&Variant::new(false, None)?)?;
        for variable in &VARIABLES {
            let cell = format!("<td><code>{}</code></td>", variable.name);
            assert_eq!(page.matches(&cell).count(), 1, "{}", variable.name);
        }
        for title in SECTIONS {
            assert!(page.contains(&format!("<h2 id=\"{}\">{title}</h2>", anchor(title))), "{title}");
        }
        assert!(page.contains(
            "</td><td>m</td><td class=\"number\">0.0155</td><td class=\"number\">1e-3 to 0.2</td><td>Real</td>"
        ));
        assert!(page.contains("<td class=\"number\">None</td><td class=\"number\"></td><td>AxialForceKind</td>"));
        assert!(page.contains(">Choices</h2>") && !page.contains("This component carries"));
        // The format of spring files, with its tables and examples, and no link out of the archive.
        assert!(page.contains("<td><code>clamp_stiffness</code></td>") && page.contains("[[segment]]"));
        let links = page.split("href=\"").skip(1).filter_map(|link| link.split('"').next());
        for link in links.filter(|link| !link.starts_with("http") && *link != "licenses/license.txt") {
            assert!(link.strip_prefix('#').is_some_and(|id| page.contains(&format!("id=\"{id}\""))), "{link}");
        }
        Ok(())
    }

    #[test]
    fn the_page_is_that_of_the_variant() -> Result<()> {
        let path = root().join("scenes/springs/tapered-cube.toml");
        let page = page(&Variant::new(true, Some(&path))?)?;
        assert!(page.contains("<h1>RelayContact-plain-tapered-cube "));
        assert!(!page.contains("Choices") && !page.contains("Kind<"));
        assert!(page.contains("<td class=\"number\">2</td><td class=\"number\">1 to 4</td><td>Real</td>"));
        assert!(page.contains(": 1 FromPreload, 2 None, 3 FromDeflection, 4 Prescribed</td>"));
        assert!(page.contains("<td class=\"number\">tapered-cube.toml</td><td class=\"number\"></td><td>String</td>"));
        let spring = std::fs::read_to_string(path)?;
        let first = spring.lines().find(|line| line.starts_with("length")).context("no length")?;
        assert!(
            page.contains("carries the spring of <a href=\"#spring\">tapered-cube.toml</a>") && page.contains(first)
        );
        Ok(())
    }
}
