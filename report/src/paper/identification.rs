//! Identification of the unpublished parameters from published results: the table of `examples/identify`.

use anyhow::{Context, Result, anyhow};
use relay_contact::scene::Scene;

use super::table::table;
use crate::content::Block;
use crate::numbers::{deviation, magnitude, number, percent};
use identify::{Amplitude, PARAMETERS, Published, SOURCES, Specimen, precision, sensitivities};

/// The blocks of the section.
pub fn blocks() -> Result<Vec<Block>> {
    let found = Specimen::identify(&Published::default()).map_err(|error| anyhow!(error))?;
    let slopes = sensitivities().map_err(|error| anyhow!(error))?;
    let precision = precision().map_err(|error| anyhow!(error))?;
    let start = Specimen::of(&Scene::default());
    let position = |symbol: &str| PARAMETERS.iter().position(|parameter| parameter.symbol == symbol);
    let (width, rivet) = (
        position("b").context("no width")?,
        position("m").context("no rivet mass")?,
    );
    let elastic = Published {
        amplitude: Amplitude::Elastic,
        ..Published::default()
    };
    let elastic = Specimen::identify(&elastic).map_err(|error| anyhow!(error))?;
    let text = format!(
        "Width, thickness, rivet mass, camber radius and a usable damping are not published. They follow from \
         published results by root finding on the library's own functions: `cargo run --release --example identify` \
         repeats it.\n\n\
         Width and thickness are those of an equivalent uniform section, not of the real spring: {} mm of width on a \
         spring of 15.5 mm would be a plate.\n\n\
         The rivet mass is weakly determined: it depends on one force amplitude. A first frequency higher by 1 % \
         would change it by {} (linearised), half a unit in the last digit of the static force by {} %. If the \
         published force amplitude is that of the elastic part only (see *Not reproduced*), it is {} mg, and others if \
         more is fitted. The damping is a calibration (see *Findings*).",
        number(found.values[width], 1),
        percent(slopes[2][rivet]),
        number(precision[0][rivet], 1),
        number(elastic.values[rivet], 1),
    );
    let rows = PARAMETERS
        .iter()
        .zip(found.values)
        .zip(start.values)
        .map(|((parameter, found), start)| {
            vec![
                format!("{} {}", parameter.name, parameter.symbol),
                parameter.from.to_owned(),
                format!("{found:.*} {}", decimals(found), parameter.unit),
                format!("{start:.*} {}", decimals(start), parameter.unit),
                deviation(start, found),
            ]
        });
    let columns = ["parameter", "determined by", "identified", "start value", "difference"];
    let parameters = table("Identified parameters", &columns, rows.collect());

    let names = PARAMETERS.iter().map(|parameter| parameter.symbol);
    let columns: Vec<_> = ["published result", "half a unit of its last digit"]
        .into_iter()
        .chain(names)
        .collect();
    let rows = SOURCES.iter().zip(&slopes).map(|(source, slopes)| {
        let value = match source.value {
            value if (1e-2..1e5).contains(&value) => format!("{value}"),
            value => format!("{value:e}"),
        };
        let head = format!("{}: {value} {}, {}", source.name, source.unit, source.place);
        let digit = format!("± {} %", number(50.0 * source.digit / source.value, 3));
        let slopes = slopes.iter().map(|slope| match percent(*slope).as_str() {
            "0.00 %" => String::new(),
            text => text.to_owned(),
        });
        [head, digit].into_iter().chain(slopes).collect()
    });
    let caption = "Change of each parameter for a published result higher by 1 %, linearised (empty: none). The rounding of that result \
                   to its last digit changes the parameters in proportion";
    let sensitivity = table(caption, &columns, rows.collect());
    Ok(vec![Block::Text(text), parameters, sensitivity])
}

/// Digits after the point for six significant ones.
fn decimals(value: f64) -> usize {
    usize::try_from(5 - magnitude(value)).unwrap_or_default()
}
