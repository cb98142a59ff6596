//! Files in TOML: their values and entries, with the place of what is wrong in them.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::SceneError;
use crate::scene::spring::{Field, Key, Slot, count};

/// Likeness by Jaro and Winkler from which on a key may be meant: `thicknes` and `thickness` have 0.98, `segment` and `mode` 0.54.
const NEAR: f64 = 0.8;

/// What a file of this text holds; errors with the file.
pub(crate) fn of_file<T, E: ToString>(
    path: &Path,
    text: Result<String, E>,
    parse: impl FnOnce(&str) -> Result<T, SceneError>,
) -> Result<T, SceneError> {
    let file = path.display().to_string();
    match text {
        Ok(text) => parse(&text).map_err(|error| SceneError::InFile { file, error: Box::new(error) }),
        Err(cause) => Err(SceneError::Unreadable { file, cause: cause.to_string() }),
    }
}

/// Adds the line of a place in a text to an error.
pub(crate) fn located(text: &str, place: &Range<usize>, error: SceneError) -> SceneError {
    SceneError::AtLine {
        line: 1 + text.bytes().take(place.start).filter(|byte| *byte == b'\n').count(),
        error: Box::new(error),
    }
}

/// The tables of a text.
pub(crate) fn parsed(text: &str) -> Result<DeTable<'_>, SceneError> {
    let document = DeTable::parse(text).map_err(|error| {
        let error_there = SceneError::Toml(error.message().to_owned());
        match error.span() {
            Some(place) => located(text, &place, error_there),
            None => error_there,
        }
    });
    document.map(Spanned::into_inner)
}

#[derive(Clone, Copy)]
pub(crate) struct Value<'a> {
    pub(crate) text: &'a str,
    pub(crate) node: &'a Spanned<DeValue<'a>>,
}

impl<'a> Value<'a> {
    /// Adds the line to an error.
    pub(crate) fn at<T>(self, result: Result<T, SceneError>) -> Result<T, SceneError> {
        result.map_err(|error| located(self.text, &self.node.span(), error))
    }

    /// What it was found to be, or an error with what is allowed.
    fn is<T>(self, found: Option<T>, name: &str, allowed: &'static str) -> Result<T, SceneError> {
        found.ok_or_else(|| SceneError::WrongType {
            name: name.to_owned(),
            value: match self.node.get_ref() {
                DeValue::Array(_) | DeValue::Table(_) => self.node.get_ref().type_str(),
                _ => self.text.get(self.node.span()).unwrap_or_default(),
            }
            .to_owned(),
            allowed,
        })
    }

    fn integer(self) -> Option<i64> {
        let integer = self.node.get_ref().as_integer()?;
        i64::from_str_radix(integer.as_str(), integer.radix()).ok()
    }

    pub(crate) fn number(self, name: &str) -> Result<f64, SceneError> {
        let float = || self.node.get_ref().as_float()?.as_str().parse().ok();
        let number = self.integer().map(|integer| integer as f64);
        self.is(number.or_else(float), name, "a number")
    }

    pub(crate) fn whole(self, name: &str) -> Result<i32, SceneError> {
        let whole = self.integer().and_then(|integer| integer.try_into().ok());
        self.is(whole, name, "a whole number")
    }

    pub(crate) fn boolean(self, name: &str) -> Result<bool, SceneError> {
        self.is(self.node.get_ref().as_bool(), name, "true or false")
    }

    pub(crate) fn string(self, name: &str, allowed: &'static str) -> Result<&'a str, SceneError> {
        self.is(self.node.get_ref().as_str(), name, allowed)
    }

    pub(crate) fn list(self, name: &str, allowed: &'static str) -> Result<impl Iterator<Item = Self>, SceneError> {
        let array = self.is(self.node.get_ref().as_array(), name, allowed)?;
        Ok(array.iter().map(move |node| Self { node, ..self }))
    }

    pub(crate) fn table(self, name: &str, allowed: &'static str) -> Result<Entry<'a>, SceneError> {
        Ok(Entry {
            text: self.text,
            name: None,
            place: self.node.span(),
            table: self.is(self.node.get_ref().as_table(), name, allowed)?,
        })
    }
}

/// A table of a file: the whole, or an entry of a list.
pub(crate) struct Entry<'a> {
    text: &'a str,
    /// `segment 2`; none where there is but one.
    name: Option<String>,
    place: Range<usize>,
    table: &'a DeTable<'a>,
}

impl<'a> Entry<'a> {
    /// All of a text.
    pub(crate) fn whole(text: &'a str, table: &'a DeTable<'a>) -> Self {
        Self { text, name: None, place: 0..0, table }
    }

    pub(crate) fn values(&self) -> impl Iterator<Item = (&str, Value<'a>)> {
        let text = self.text;
        let pairs = self.table.iter();
        pairs.map(move |(key, node)| (key.get_ref().as_ref(), Value { text, node }))
    }

    pub(crate) fn value(&self, key: &str) -> Option<Value<'a>> {
        let (text, node) = (self.text, self.table.get(key)?);
        Some(Value { text, node })
    }

    /// What a key holds, read so; errors with its line and entry.
    pub(crate) fn get<T>(
        &self,
        key: &str,
        read: impl FnOnce(Value<'a>) -> Result<T, SceneError>,
    ) -> Result<Option<T>, SceneError> {
        let value = self.value(key);
        value.map(|value| self.at(&value.node.span(), read(value))).transpose()
    }

    /// Adds line and entry to an error.
    pub(crate) fn at<T>(&self, place: &Range<usize>, result: Result<T, SceneError>) -> Result<T, SceneError> {
        result.map_err(|error| {
            let error = match &self.name {
                None => error,
                Some(entry) => SceneError::InEntry { entry: entry.clone(), error: Box::new(error) },
            };
            located(self.text, place, error)
        })
    }

    /// Refuses other keys than these.
    pub(crate) fn knows(&self, keys: &[&'static str]) -> Result<(), SceneError> {
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

    /// Reads these keys, and refuses others.
    pub(crate) fn fill<const N: usize>(&self, keys: [Key; N]) -> Result<(), SceneError> {
        let names = keys.iter().flat_map(|(field, slot)| match slot {
            Slot::Ends(_, [start, end]) => vec![field.name, *start, *end],
            Slot::Needed(_) | Slot::OrZero(_) | Slot::Optional(_) => vec![field.name],
        });
        self.knows(&names.collect::<Vec<_>>())?;
        for (field, slot) in keys {
            match slot {
                Slot::Needed(value) => *value = self.required(field)?,
                Slot::OrZero(value) => *value = self.optional(field)?.unwrap_or_default(),
                Slot::Optional(value) => *value = self.optional(field)?,
                Slot::Ends(values, names) => *values = self.ends(field, names.map(|name| field.named(name)))?,
            }
        }
        Ok(())
    }

    pub(crate) fn optional(&self, field: Field) -> Result<Option<f64>, SceneError> {
        self.get(field.name, |value| {
            let number = value.number(field.name)?;
            field.check(number).map(|()| number)
        })
    }

    pub(crate) fn required(&self, field: Field) -> Result<f64, SceneError> {
        let missing = SceneError::MissingKey { name: field.name, allowed: "a number" };
        self.optional(field)?.map_or_else(|| self.at(&self.place, Err(missing)), Ok)
    }

    /// A value that is constant, or those at start and end.
    fn ends(&self, constant: Field, ends: [Field; 2]) -> Result<[f64; 2], SceneError> {
        let varies = ends.iter().any(|field| self.value(field.name).is_some());
        match self.value(constant.name) {
            Some(value) if varies => {
                let error = SceneError::GivenTwice {
                    name: constant.name.to_owned(),
                    allowed: "either one value, or one at the start and one at the end",
                };
                self.at(&value.node.span(), Err(error))
            }
            None if varies => {
                let [start, end] = ends;
                Ok([self.required(start)?, self.required(end)?])
            }
            _ => self.required(constant).map(|value| [value; 2]),
        }
    }

    /// The entries `[[name]]`, at least so many.
    pub(crate) fn entries<T>(
        &self,
        name: &'static str,
        least: usize,
        read: impl Fn(&Entry) -> Result<T, SceneError>,
    ) -> Result<Vec<T>, SceneError> {
        const TABLES: &str = "tables, each under its name in double brackets";
        let Some(value) = self.value(name) else {
            count(name, 0, least)?;
            return Ok(Vec::new());
        };
        let entries: Vec<_> = value.at(value.list(name, TABLES))?.collect();
        value.at(count(name, entries.len(), least))?;
        let entries = entries.iter().zip(1..).map(|(entry, number)| {
            read(&Entry { name: Some(format!("{name} {number}")), ..entry.at(entry.table(name, TABLES))? })
        });
        entries.collect()
    }
}
