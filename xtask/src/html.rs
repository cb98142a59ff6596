//! What the HTML pages share: the style sheet, and Markdown.

use maud::{Markup, PreEscaped};
use pulldown_cmark::{Options, Parser};

/// The style sheet: light and dark, screen and paper.
pub const STYLE: &str = include_str!("html.css");

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
