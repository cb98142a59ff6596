//! What contact the published numbers belong to: the tables that `examples/python/published_contact.py` writes.

use std::fs;

use anyhow::{Context, Result};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as STANDARD;
use commands::root;
use serde::Deserialize;

use super::published as paper;
use super::table::{cells, table};
use crate::content::{Arguments, Block};
use crate::numbers::{magnitude, number, signed, significant, two_digits};

/// A published number, and what the component has of it with each contact.
#[derive(Clone, Debug, Deserialize)]
pub struct Compared {
    pub quantity: String,
    pub location: String,
    pub unit: String,
    pub published: f64,
    /// 1: of those that the contacts were fitted to.
    pub fitted: u8,
    #[serde(rename = "Hertz")]
    pub hertz: f64,
    #[serde(rename = "Rough")]
    pub rough: f64,
    pub support: f64,
}

/// A parameter of a fit, or its residual, with the ends of its 95 % interval.
#[derive(Clone, Debug, Deserialize)]
pub struct Parameter {
    pub contact: String,
    #[serde(rename = "parameter")]
    pub name: String,
    pub unit: String,
    pub value: f64,
    pub low: Option<f64>,
    pub high: Option<f64>,
}

/// Name of a parameter.
const STIFFNESS: &str = "contact stiffness at 0.152 N";

/// Contacts by their names in the tables, and what they are called here.
const CONTACTS: [(&str, &str); 3] = [
    ("Hertz", "smooth spheres"),
    ("Rough", "rough contact"),
    ("support", "support that yields"),
];

/// Figures that the program draws: name, title, caption.
const FIGURES: [[&str; 3]; 3] = [
    [
        "frequency",
        "First frequency over overtravel, three contacts",
        "The published frequencies of 11.5 mm fall with the overtravel; no contact whose stiffness grows with the force does that.",
    ],
    [
        "amplitude",
        "Amplitudes over the damping ratio",
        "Left: elastic part of the contact force, by frequency; right: displacement of the contact with the base. Solid: rough \
         contact; dashed: smooth spheres. A curve ends where the contact opens.",
    ],
    [
        "stiffness",
        "Stiffness of the contact over its force",
        "Vertical lines: static forces of the springs whose frequencies are published.",
    ],
];

/// Rows of a table in `docs/`.
fn rows<T: for<'a> Deserialize<'a>>(name: &str) -> Result<Vec<T>> {
    let path = root().join(name);
    let mut reader = csv::Reader::from_path(&path).with_context(|| path.display().to_string())?;
    let rows = reader.deserialize().collect::<Result<_, _>>();
    rows.with_context(|| path.display().to_string())
}

/// The published numbers beside those of the three contacts.
pub fn compared() -> Result<Vec<Compared>> {
    rows("docs/published-contact.csv")
}

/// The parameters of the three fits.
pub fn parameters() -> Result<Vec<Parameter>> {
    rows("docs/published-contact-parameters.csv")
}

/// A parameter of a fit.
fn value(parameters: &[Parameter], contact: &str, name: &str) -> Result<f64> {
    let mut all = parameters.iter();
    let found = all.find(|each| each.contact == contact && each.name == name);
    found
        .map(|each| each.value)
        .with_context(|| format!("no {name} of {contact}"))
}

/// The blocks.
pub fn blocks(arguments: Arguments) -> Result<Vec<Block>> {
    let (compared, parameters) = (compared()?, parameters()?);
    let text = introduction(&compared, &parameters)?;
    let (fitted, others): (Vec<_>, Vec<_>) = compared.into_iter().partition(|each| each.fitted == 1);
    let mut blocks = vec![
        Block::Text(text),
        comparison("The numbers that were fitted", &fitted, Some(&parameters))?,
        comparison("Numbers that were not fitted", &others, None)?,
        fits(&parameters),
    ];
    for figure in FIGURES {
        blocks.push(Block::Text(picture(figure, arguments)?));
    }
    blocks.push(Block::Text(verdict(&fitted, &parameters)?));
    Ok(blocks)
}

/// A picture of the program: by name beside the pages of `docs/`, inside the report.
fn picture([name, title, caption]: [&str; 3], arguments: Arguments) -> Result<String> {
    let file = format!("published-contact-{name}.png");
    let source = if arguments.docs {
        file
    } else {
        let path = root().join("docs").join(file);
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        format!("data:image/png;base64,{}", STANDARD.encode(bytes))
    };
    Ok(format!("![{title}]({source})\n\n{caption}"))
}

/// What the section says, in a sentence.
pub fn lead() -> Result<String> {
    let parameters = parameters()?;
    let rms = |contact| value(&parameters, contact, "rms").map(|rms| number(rms, 0));
    Ok(format!(
        "fitted to 17 published numbers at once, a rough contact leaves {} % rms, smooth spheres {} %, a support that yields {} %.",
        rms("Rough")?,
        rms("Hertz")?,
        rms("support")?,
    ))
}

fn introduction(compared: &[Compared], parameters: &[Parameter]) -> Result<String> {
    // Those fitted, and the displacement with the weakest damping, which stands first among the others.
    let last = compared.iter().position(|each| each.fitted == 0).unwrap_or(0);
    let all = || {
        compared
            .iter()
            .filter(|each| each.fitted == 1)
            .chain(&compared[last..=last])
    };
    let with_weakest = |value: fn(&Compared) -> f64| {
        let squares = all().map(|each| (value(each) / each.published).ln().powi(2));
        number(100.0 * (squares.sum::<f64>() / all().count() as f64).sqrt(), 1)
    };
    Ok(format!(
        "`.venv/bin/python examples/python/published_contact.py` makes the fits, tables and figures of this section, in a minute, and \
         `cargo xtask report --docs` then this page.\n\n\
         The start values take the published contact stiffness, which is that of smooth spheres, and explain neither the shorter springs \
         nor the displacements. Here 17 published numbers (`docs/published-numbers.csv`) are fitted at once by least squares of their \
         logarithms, with the component, in the time domain: four frequencies of three lengths, four force amplitudes, two peaks of \
         the frequency domain, seven displacement amplitudes. Free are mass per length, rivet, one damping time for beam and contact \
         (that of other ratios in proportion), and of the contact:\n\n\
         - smooth spheres (`effects.contactLaw` Hertz): nothing, its stiffness is the published one;\n\
         - rough contact (Rough): the stiffness at {} N, and the exponent by which it grows with the force;\n\
         - support that yields: its stiffness. A linear support in series with smooth spheres {} times as stiff is nearly a linear spring \
         that opens, and is run as one (Rough with the exponent 0), so that it is damped as the contact is.\n\n\
         The bending stiffness follows from the published static force. Published force amplitudes are taken for those of the elastic \
         part, without what the damping of the contact carries (see *Two and three times the damping*). The displacement with ratio 0.1 \
         is not fitted: at 1000 Hz, below the resonance, the steady amplitudes with ratios of 0.1 and 1 are the same to 1 % with each \
         contact, while the published ones differ by {} %: they are not both of steady vibrations. (With it the same fits leave {} %, {} % and {} % rms.) Three \
         starts of each fit end at the same residual.",
        paper::FORCE,
        number(paper::STIFFNESS / value(parameters, "support", STIFFNESS)?, 0),
        number(100.0 * (paper::DISPLACEMENTS[0] / paper::DISPLACEMENTS[1] - 1.0), 0),
        with_weakest(|each| each.hertz),
        with_weakest(|each| each.rough),
        with_weakest(|each| each.support),
    ))
}

/// A table of numbers beside those of the contacts, closed by the residuals.
fn comparison(caption: &str, numbers: &[Compared], parameters: Option<&[Parameter]>) -> Result<Block> {
    let mut rows: Vec<_> = numbers
        .iter()
        .map(|each| {
            let found = [each.hertz, each.rough, each.support].map(|value| {
                let deviation = match each.unit.as_str() {
                    "°" => format!("{} °", signed(value - each.published, 0)),
                    _ => tenths(value / each.published),
                };
                format!("{} {}, {deviation}", significant(value), each.unit).replace(" ,", ",")
            });
            let published = format!("{} {}", each.published, each.unit);
            cells(&[
                &each.quantity,
                &published,
                &found[0],
                &found[1],
                &found[2],
                &each.location,
            ])
        })
        .collect();
    if let Some(parameters) = parameters {
        let rms = CONTACTS
            .map(|(contact, _)| value(parameters, contact, "rms").map(|rms| format!("**{} %**", number(rms, 1))));
        let [hertz, rough, support] = rms;
        rows.push(cells(&["**rms**", "", &hertz?, &rough?, &support?, ""]));
    }
    let columns: Vec<_> = ["quantity", "published"]
        .into_iter()
        .chain(CONTACTS.map(|(_, name)| name))
        .chain(["location in the publication"])
        .collect();
    Ok(table(caption, &columns, rows))
}

/// Deviation of a ratio from 1, to a tenth of a percent.
fn tenths(ratio: f64) -> String {
    format!("{} %", signed(100.0 * (ratio - 1.0), 1))
}

/// The parameters with their intervals.
fn fits(parameters: &[Parameter]) -> Block {
    let names: Vec<_> = parameters
        .iter()
        .filter(|each| each.contact == "Rough" && each.name != "rms")
        .collect();
    let cell = |contact: &str, name: &str| {
        let found = parameters
            .iter()
            .find(|each| each.contact == contact && each.name == name);
        let Some((each, low, high)) = found.and_then(|each| Some((each, each.low?, each.high?))) else {
            return String::new();
        };
        let value = three(each.value);
        if high > 100.0 * low {
            format!("{value} {}, undetermined", each.unit)
        } else {
            format!("{value} {} ({} to {})", each.unit, three(low), three(high)).replace("  ", " ")
        }
    };
    let rows = names.iter().map(|each| {
        let found = CONTACTS.map(|(contact, _)| cell(contact, &each.name));
        cells(&[&each.name, &found[0], &found[1], &found[2]])
    });
    let columns: Vec<_> = ["parameter"]
        .into_iter()
        .chain(CONTACTS.map(|(_, name)| name))
        .collect();
    let caption = "Parameters found, with 95 % intervals by the scatter of the residuals, linearised";
    table(caption, &columns, rows.collect())
}

/// Three significant digits.
fn three(value: f64) -> String {
    let last = magnitude(value) - 2;
    let unit = 10_f64.powi(last);
    number((value / unit).round() * unit, usize::try_from(-last).unwrap_or(0))
}

/// A number of the table by what is said of it.
pub fn found<'a>(numbers: &'a [Compared], quantity: &str) -> Result<&'a Compared> {
    let mut all = numbers.iter();
    let found = all.find(|each| each.quantity.contains(quantity));
    found.with_context(|| format!("docs/published-contact.csv has no {quantity}"))
}

fn verdict(fitted: &[Compared], parameters: &[Parameter]) -> Result<String> {
    let all = compared()?;
    let worst = fitted
        .iter()
        .map(|each| 100.0 * (each.rough / each.published - 1.0).abs());
    let short = |quantity: &str| {
        let each = found(fitted, quantity)?;
        Ok::<_, anyhow::Error>([each.rough, each.hertz, each.support].map(|value| tenths(value / each.published)))
    };
    let (middle, shortest) = (short("L = 11.5 mm, s = 0.45 mm")?, short("L = 7.5 mm")?);
    let rest = found(&all, "resistance at rest")?;
    let stiffness = value(parameters, "Rough", STIFFNESS)?;
    let exponent = value(parameters, "Rough", "exponent of the stiffness")?;
    let published = stiffness * rest.rough / rest.published;
    let roughness = paper::FORCE / paper::ROUGHNESS;
    let [least, greatest] = ["least resistance", "greatest resistance"].map(|name| found(&all, name));
    Ok(format!(
        "**The published numbers belong to a contact some {} times softer than smooth spheres, whose stiffness grows with the force.** The \
         rough contact has each of the 17 within {} %. The lengths decide it, as their static forces differ tenfold. The first frequencies of \
         11.5 and 7.5 mm deviate by {} and {} with the rough contact, {} and {} with smooth spheres, {} and {} with a linear support, which is too soft for them.\n\n\
         **The published resistance says much the same, though nothing was fitted to it.** Stiffness and conductance of a contact are \
         proportional (J. R. Barber, *Proc. R. Soc. A* 459 (2003) 53; `effects.resistance` Barber). At rest the fitted stiffness gives {} mΩ, \
         the published law {} mΩ, smooth spheres {} mΩ. Eq. 29 read as a stiffness is {} N/m at {} N, less than the fit allows, and crosses \
         the fitted stiffness at {} N, between the forces of the springs; its exponent is 0.95, the fitted one {}. The published roughness h lets \
         expect F/h to F/0.4 h, {} to {} N/m at {} N. So the order of magnitude agrees, three ways, and the exponent does not. Under \
         vibration the resistance is {} to {} mΩ (measured: 25 to 63): for the resistance itself the power law stays the better choice.\n\n\
         What yields is not decided. Asperities, the rivet's seat or a support that stiffens under load are the same spring to these \
         numbers; only a linear support alone is excluded. The scene `paper-rough` has these values.",
        number(paper::STIFFNESS / stiffness, 0),
        number(worst.fold(0.0, f64::max).ceil(), 0),
        middle[0],
        shortest[0],
        middle[1],
        shortest[1],
        middle[2],
        shortest[2],
        three(rest.rough),
        three(rest.published),
        two_digits(rest.hertz),
        three(published),
        paper::FORCE,
        two_digits(paper::FORCE * (stiffness / published).powf(1.0 / (paper::RESISTANCE.1 - exponent))),
        number(exponent, 2),
        three(roughness),
        three(roughness / 0.4),
        paper::FORCE,
        three(least?.rough),
        three(greatest?.rough),
    ))
}
