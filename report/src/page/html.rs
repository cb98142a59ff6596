//! HTML of the head with the style sheet, and of Markdown.

use maud::{Markup, PreEscaped, html};
use pulldown_cmark::{Options, Parser};

/// The style sheet: light and dark, screen and paper.
const STYLE: &str = include_str!("style.css");

/// The head of a page.
pub fn head(title: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            // Without it a browser asks for an icon.
            link rel="icon" href="data:,";
            title { (title) }
            style { (PreEscaped(STYLE)) }
        }
    }
}

/// Paragraphs in Markdown.
pub fn markdown(text: &str) -> Markup {
    let mut html = String::new();
    pulldown_cmark::html::push_html(&mut html, Parser::new_ext(text, Options::ENABLE_TABLES));
    PreEscaped(html)
}

/// One paragraph in Markdown, without the paragraph around it.
pub fn inline_markdown(text: &str) -> Markup {
    let PreEscaped(html) = markdown(text);
    let html = html.trim();
    let inside = html.strip_prefix("<p>").and_then(|html| html.strip_suffix("</p>"));
    PreEscaped(inside.unwrap_or(html).to_owned())
}
