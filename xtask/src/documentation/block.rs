//! The component as a block: its inputs on the left, its outputs on the right.

use maud::{Markup, html};
use roxmltree::{Document, Node};

use super::description::unit;

/// Between two variables, and sizes of the block and of what is beside it, in pixels.
const PITCH: usize = 22;
const LEFT: usize = 70;
const WIDTH: usize = 330;
const RIGHT: usize = 90;
const PIN: usize = 24;

/// The block, drawn.
pub fn block(document: &Document) -> Markup {
    let [inputs, outputs] = ["input", "output"].map(|causality| variables(document, causality));
    let rows = inputs.len().max(outputs.len());
    let height = (rows + 2) * PITCH;
    let right = LEFT + WIDTH;
    let row = |list: &[Node], index: usize| (rows - list.len()) * PITCH / 2 + (index + 2) * PITCH + PITCH / 4;
    let name = attribute(document.root_element(), "modelName");
    let label =
        format!("{name} as a block: {} inputs on the left, {} outputs on the right", inputs.len(), outputs.len());
    html! {
        svg.block viewBox=(format!("0 0 {} {}", right + RIGHT, height + 2)) width=(right + RIGHT) role="img" aria-label=(label) {
            rect x=(LEFT) y="1" width=(WIDTH) height=(height) rx="8" {}
            text.name x=(LEFT + WIDTH / 2) y=(PITCH) text-anchor="middle" { (name) }
            @for (index, variable) in inputs.iter().enumerate() {
                @let y = row(&inputs, index);
                path d=(format!("M{} {y}h{PIN}l-8 -5m8 5l-8 5", LEFT - PIN)) {}
                text x=(LEFT + 8) y=(y) { (attribute(*variable, "name")) }
                text.unit x=(LEFT - PIN - 6) y=(y) text-anchor="end" { (signal(document, *variable)) }
            }
            @for (index, variable) in outputs.iter().enumerate() {
                @let y = row(&outputs, index);
                path d=(format!("M{right} {y}h{PIN}l-8 -5m8 5l-8 5")) {}
                text x=(right - 8) y=(y) text-anchor="end" { (attribute(*variable, "name")) }
                text.unit x=(right + PIN + 6) y=(y) { (signal(document, *variable)) }
            }
        }
    }
}

/// An attribute, or nothing.
pub fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or("")
}

pub fn variables<'a>(document: &'a Document, causality: &str) -> Vec<Node<'a, 'a>> {
    let variables = document.descendants().filter(|node| node.has_tag_name("ScalarVariable"));
    variables.filter(|node| attribute(*node, "causality") == causality).collect()
}

/// What a variable carries: its unit, or else its type.
fn signal<'a>(document: &'a Document, variable: Node<'a, 'a>) -> &'a str {
    let value = variable.first_element_child().unwrap_or(variable);
    match unit(document, value) {
        "" => value.tag_name().name(),
        unit => unit,
    }
}
