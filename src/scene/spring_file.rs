//! Spring files in TOML, SI units: segments from the clamp on and what they carry,
//!
//! ```toml
//! contact_position = 0.018    # of the contact from the clamp; the end without it
//! fork_position = 0.012       # where it forks into two tongues, for effects.parallelContact; not at all without it
//! clamp_stiffness = 2.0       # N m/rad; rigid without it
//!
//! [[segment]]
//! length = 0.020
//! width_start = 4e-3          # or width, where it is constant
//! width_end = 2.5e-3
//! thickness = 2e-4            # or thickness_start and thickness_end
//! youngs_modulus = 1.28e11    # beam.youngsModulus without it
//! density = 8250.0            # beam.density without it
//!
//! [[mass]]                    # tip.mass sits at the contact, without an entry
//! position = 0.012
//! mass = 5e-6
//! rotary_inertia = 0.0        # none without it
//! ```
//!
//! or modes of the free spring, normalised to a modal mass of 1 kg, with its static compliance:
//!
//! ```toml
//! compliance = 2.1e-3         # m/N
//!
//! [[mode]]
//! frequency = 512.0           # Hz
//! contact = 160.0             # displacement of the contact point, 1/sqrt(kg)
//! participation = 9.1e-3      # load per base acceleration, sqrt(kg)
//! damping = 0.01              # share of critical; beam.massDamping and .stiffnessDamping without it
//! ```

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use crate::error::SceneError;
use crate::scene::names::located;
use crate::scene::spring::{
    CLAMP_STIFFNESS, COMPLIANCE, CONTACT, CONTACT_POSITION, DAMPING, DENSITY, FORK_POSITION, FREQUENCY, Field,
    GivenMode, LENGTH, MASS, Modes, PARALLEL, PARALLEL_COMPLIANCE, PARTICIPATION, POSITION, PUSHER, PointMass,
    ROTARY_INERTIA, ROTATION, Segment, Segments, Shape, SpringFile, THICKNESS, WIDTH, YOUNGS_MODULUS, count,
};

/// Largest file, bytes.
const LARGEST: u64 = 1 << 20;

/// Brackets inside each other that a spring takes: a list of tables. The parser calls itself for each, on a stack that may be
/// small.
const DEEPEST: usize = 2;

/// Likeness by Jaro and Winkler from which on a key may be meant: `thicknes` and `thickness` have 0.98, `segment` and `mode` 0.54.
const NEAR: f64 = 0.8;

impl SpringFile {
    /// Reads the file `name`; a relative name is one in `folder`.
    ///
    /// # Errors
    /// The first [`SceneError`] found, with file, line and entry.
    pub fn read(folder: &Path, name: &str) -> Result<Self, SceneError> {
        let path = folder.join(name);
        let file = || path.display().to_string();
        let text = text(&path).map_err(|cause| SceneError::Unreadable { file: file(), cause })?;
        let shape = shape(&text).map_err(|error| SceneError::InFile {
            file: file(),
            error: Box::new(error),
        })?;
        Ok(Self {
            name: name.to_owned(),
            shape,
        })
    }
}

/// The text of a file of bounded size: no folder, pipe or device, whose end may never come.
pub(crate) fn text(path: &Path) -> Result<String, String> {
    let failed = |error: std::io::Error| error.to_string();
    if !path.metadata().map_err(failed)?.is_file() {
        return Err("not a file".to_owned());
    }
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_string(&mut text));
    if read.map_err(failed)? as u64 > LARGEST {
        return Err(format!("longer than {LARGEST} bytes"));
    }
    Ok(text)
}

/// The spring of a text.
fn shape(text: &str) -> Result<Shape, SceneError> {
    check_nesting(text)?;
    let document = DeTable::parse(text).map_err(|error| {
        let error_there = SceneError::Toml(error.message().to_owned());
        match error.span() {
            Some(place) => located(text, &place, error_there),
            None => error_there,
        }
    })?;
    let top = Entry {
        text,
        name: None,
        place: 0..0,
        table: document.get_ref(),
    };
    if top.value("mode").is_some() || top.value("compliance").is_some() {
        modes(&top).map(Shape::Modes)
    } else {
        segments(&top).map(Shape::Segments)
    }
}

/// Refuses brackets inside each other that are more than [`DEEPEST`].
fn check_nesting(text: &str) -> Result<(), SceneError> {
    let mut depth = 0_usize;
    for token in Source::new(text).lex() {
        match token.kind() {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => depth += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let place = token.span().start()..token.span().end();
            return Err(located(text, &place, SceneError::Nested(DEEPEST)));
        }
    }
    Ok(())
}

fn segments(top: &Entry) -> Result<Segments, SceneError> {
    top.knows(&[
        "title",
        "segment",
        "mass",
        "contact_position",
        "fork_position",
        "clamp_stiffness",
    ])?;
    let mut spring = Segments {
        segments: top.list("segment", 1, segment)?,
        clamp_stiffness: top.optional(CLAMP_STIFFNESS)?,
        ..Segments::default()
    };
    spring.contact_position = top.optional(spring.on_spring(CONTACT_POSITION))?;
    spring.fork_position = top.optional(spring.before_contact(FORK_POSITION))?;
    spring.masses = top.list("mass", 0, |entry| point_mass(entry, spring.on_spring(POSITION)))?;
    // The sum of the lengths has no line of its own.
    spring.check().map(|()| spring)
}

fn segment(entry: &Entry) -> Result<Segment, SceneError> {
    let known = [
        "length",
        "width",
        "width_start",
        "width_end",
        "thickness",
        "thickness_start",
        "thickness_end",
        "youngs_modulus",
        "density",
    ];
    entry.knows(&known)?;
    Ok(Segment {
        length: entry.required(LENGTH)?,
        width: entry.ends(WIDTH)?,
        thickness: entry.ends(THICKNESS)?,
        youngs_modulus: entry.optional(YOUNGS_MODULUS)?,
        density: entry.optional(DENSITY)?,
    })
}

fn point_mass(entry: &Entry, position: Field) -> Result<PointMass, SceneError> {
    entry.knows(&["position", "mass", "rotary_inertia"])?;
    Ok(PointMass {
        position: entry.required(position)?,
        mass: entry.required(MASS)?,
        rotary_inertia: entry.optional(ROTARY_INERTIA)?.unwrap_or_default(),
    })
}

fn modes(top: &Entry) -> Result<Modes, SceneError> {
    top.knows(&["title", "compliance", "parallel_compliance", "mode"])?;
    let spring = Modes {
        compliance: top.required(COMPLIANCE)?,
        parallel_compliance: top.optional(PARALLEL_COMPLIANCE)?,
        modes: top.list("mode", 1, mode)?,
    };
    let place = top.value("compliance").map_or(0..0, Spanned::span);
    top.at(&place, spring.check())?;
    Ok(spring)
}

fn mode(entry: &Entry) -> Result<GivenMode, SceneError> {
    entry.knows(&[
        "frequency",
        "contact",
        "participation",
        "damping",
        "rotation",
        "pusher",
        "parallel",
    ])?;
    Ok(GivenMode {
        frequency: entry.required(FREQUENCY)?,
        contact: entry.required(CONTACT)?,
        participation: entry.required(PARTICIPATION)?,
        damping: entry.optional(DAMPING)?,
        rotation: entry.optional(ROTATION)?,
        pusher: entry.optional(PUSHER)?,
        parallel: entry.optional(PARALLEL)?,
    })
}

/// A table of the file: the whole, or an entry of a list.
struct Entry<'a> {
    text: &'a str,
    /// `segment 2`; none for the whole.
    name: Option<String>,
    place: Range<usize>,
    table: &'a DeTable<'a>,
}

impl<'a> Entry<'a> {
    fn value(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.table.get(key)
    }

    /// Adds line and entry to an error.
    fn at<T>(&self, place: &Range<usize>, result: Result<T, SceneError>) -> Result<T, SceneError> {
        result.map_err(|error| {
            let error = match &self.name {
                None => error,
                Some(entry) => SceneError::InEntry {
                    entry: entry.clone(),
                    error: Box::new(error),
                },
            };
            located(self.text, place, error)
        })
    }

    /// Refuses other keys than these.
    fn knows(&self, keys: &[&'static str]) -> Result<(), SceneError> {
        let unknown = self.table.keys().filter(|key| !keys.contains(&key.get_ref().as_ref()));
        unknown.min_by_key(|key| key.span().start).map_or(Ok(()), |key| {
            let name = key.get_ref().to_string();
            let likeness = |known: &str| strsim::jaro_winkler(&name, known);
            let near = keys.iter().copied().filter(|known| likeness(known) > NEAR);
            let error = SceneError::UnknownKey {
                nearest: near.max_by(|a, b| likeness(a).total_cmp(&likeness(b))),
                allowed: keys.join(", "),
                name,
            };
            self.at(&key.span(), Err(error))
        })
    }

    fn optional(&self, field: Field) -> Result<Option<f64>, SceneError> {
        let Some(value) = self.value(field.name) else {
            return Ok(None);
        };
        let number = number(field.name, value.get_ref()).and_then(|number| field.check(number).map(|()| number));
        self.at(&value.span(), number).map(Some)
    }

    fn required(&self, field: Field) -> Result<f64, SceneError> {
        let missing = SceneError::MissingKey {
            name: field.name,
            allowed: "a number",
        };
        self.optional(field)?
            .map_or_else(|| self.at(&self.place, Err(missing)), Ok)
    }

    /// A value that is constant, or those at start and end.
    fn ends(&self, [constant, start, end]: [Field; 3]) -> Result<[f64; 2], SceneError> {
        let varies = [start, end].iter().any(|field| self.value(field.name).is_some());
        match self.value(constant.name) {
            Some(value) if varies => {
                let error = SceneError::GivenTwice {
                    name: constant.name.to_owned(),
                    allowed: "either one value, or one at the start and one at the end",
                };
                self.at(&value.span(), Err(error))
            }
            None if varies => Ok([self.required(start)?, self.required(end)?]),
            _ => self.required(constant).map(|value| [value; 2]),
        }
    }

    /// The entries `[[name]]`.
    fn list<T>(
        &self,
        name: &'static str,
        least: usize,
        read: impl Fn(&Entry) -> Result<T, SceneError>,
    ) -> Result<Vec<T>, SceneError> {
        let Some(value) = self.value(name) else {
            count(name, 0, least)?;
            return Ok(Vec::new());
        };
        let wrong = |value: &Spanned<DeValue>| {
            let error = SceneError::WrongType {
                name: name.to_owned(),
                value: value.get_ref().type_str().to_owned(),
                allowed: "tables, each under its name in double brackets",
            };
            located(self.text, &value.span(), error)
        };
        let entries = value.get_ref().as_array().ok_or_else(|| wrong(value))?;
        self.at(&value.span(), count(name, entries.len(), least))?;
        let entries = entries.iter().enumerate().map(|(index, entry)| {
            read(&Entry {
                text: self.text,
                name: Some(format!("{name} {}", index + 1)),
                place: entry.span(),
                table: entry.get_ref().as_table().ok_or_else(|| wrong(entry))?,
            })
        });
        entries.collect()
    }
}

fn number(name: &str, value: &DeValue) -> Result<f64, SceneError> {
    let number = match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|integer| integer as f64),
        _ => None,
    };
    number.ok_or_else(|| SceneError::WrongType {
        name: name.to_owned(),
        value: match value {
            DeValue::String(text) => format!("{text:?}"),
            other => other.type_str().to_owned(),
        },
        allowed: "a number",
    })
}
