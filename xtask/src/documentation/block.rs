//! The component as a block: its inputs on the left, its outputs on the right.

use maud::{Markup, html};

use super::description::Variable;

/// Between two variables, and sizes of the block and of what is beside it, in pixels.
const PITCH: usize = 22;
const LEFT: usize = 70;
const WIDTH: usize = 330;
const RIGHT: usize = 90;
const PIN: usize = 24;

/// The block, drawn.
pub fn block(name: &str, variables: &[Variable]) -> Markup {
    let [inputs, outputs] = ["input", "output"]
        .map(|causality| variables.iter().filter(|variable| variable.causality == causality).collect::<Vec<_>>());
    let rows = inputs.len().max(outputs.len());
    let height = (rows + 2) * PITCH;
    let right = LEFT + WIDTH;
    let row = |list: &[&Variable], index: usize| (rows - list.len()) * PITCH / 2 + (index + 2) * PITCH + PITCH / 4;
    let label =
        format!("{name} as a block: {} inputs on the left, {} outputs on the right", inputs.len(), outputs.len());
    html! {
        svg.block viewBox=(format!("0 0 {} {}", right + RIGHT, height + 2)) width=(right + RIGHT) role="img" aria-label=(label) {
            rect x=(LEFT) y="1" width=(WIDTH) height=(height) rx="8" {}
            text.name x=(LEFT + WIDTH / 2) y=(PITCH) text-anchor="middle" { (name) }
            @for (index, variable) in inputs.iter().enumerate() {
                @let y = row(&inputs, index);
                path d=(format!("M{} {y}h{PIN}l-8 -5m8 5l-8 5", LEFT - PIN)) {}
                text x=(LEFT + 8) y=(y) { (variable.name) }
                text.unit x=(LEFT - PIN - 6) y=(y) text-anchor="end" { (signal(variable)) }
            }
            @for (index, variable) in outputs.iter().enumerate() {
                @let y = row(&outputs, index);
                path d=(format!("M{right} {y}h{PIN}l-8 -5m8 5l-8 5")) {}
                text x=(right - 8) y=(y) text-anchor="end" { (variable.name) }
                text.unit x=(right + PIN + 6) y=(y) { (signal(variable)) }
            }
        }
    }
}

/// What a variable carries: its unit, or else its type.
fn signal<'a>(variable: &Variable<'a>) -> &'a str {
    if variable.unit.is_empty() { variable.kind } else { variable.unit }
}
