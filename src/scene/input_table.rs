//! Inputs over time, from a table in CSV: a column `time` in seconds and columns named as inputs, in SI units.
//!
//! ```csv
//! time,support.displacement
//! 0,0
//! 0.005,3e-4
//! ```
//! Values are interpolated linearly between rows, and constant before the first and after the last row.

use std::fs;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::error::{self, SceneError};
use crate::inputs::Inputs;
use crate::scene::check_range;
use crate::scene::document::{located, of_file};
use crate::scene::names::{Role, variable};
use crate::variables::{Group, RealInput};

/// Some inputs over time; may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputTable {
    /// Times of the rows, ascending, s.
    times: Vec<f64>,
    /// Values at these times.
    columns: Vec<(RealInput, Vec<f64>)>,
}

/// Meaning of a column: an input, or the time.
type Column = Option<RealInput>;

impl InputTable {
    /// Reads a file.
    ///
    /// # Errors
    /// The first [`SceneError`] found, with the file, the line and the column's name.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        of_file(path, fs::read_to_string(path), Self::parse)
    }

    fn parse(text: &str) -> Result<Self, SceneError> {
        let syntax = |error: csv::Error| SceneError::InputTable(error.to_string());
        let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text.as_bytes());
        let head = reader.headers().map_err(syntax)?.clone();
        let columns = at_line(text, &head, columns(&head))?;
        let inputs = columns.iter().flatten();
        let mut table = Self { times: Vec::new(), columns: inputs.map(|input| (*input, Vec::new())).collect() };
        for record in reader.records() {
            let record = record.map_err(syntax)?;
            at_line(text, &record, table.add(&columns, &record))?;
        }
        if table.times.is_empty() {
            return Err(SceneError::InputTable("no row below the header".to_owned()));
        }
        Ok(table)
    }

    fn add(&mut self, columns: &[Column], record: &StringRecord) -> Result<(), SceneError> {
        let mut rows = self.columns.iter_mut();
        for (column, field) in columns.iter().zip(record) {
            match column {
                None => {
                    let time = number("time", field)?;
                    let last = self.times.last().copied().unwrap_or(f64::NEG_INFINITY);
                    if !(time > last && time.is_finite()) {
                        let last = error::number(last);
                        let allowed = format!("any finite number above that of the previous row, {last} s");
                        return Err(SceneError::out_of_range("time", time, "s", &allowed));
                    }
                    self.times.push(time);
                }
                Some(input) => {
                    let value = number(input.variable().name, field)?;
                    check_range(input.variable(), value)?;
                    if let Some((_, values)) = rows.next() {
                        values.push(value);
                    }
                }
            }
        }
        Ok(())
    }

    /// # Errors
    /// [`SceneError::InputTable`] if no row is before the end of the run, or all are before its start.
    pub(crate) fn check_overlap(&self, stop: f64) -> Result<(), SceneError> {
        match (self.times.first(), self.times.last()) {
            (Some(first), Some(last)) if *first >= stop || *last < 0.0 => {
                let [first, last, stop] = [*first, *last, stop].map(error::number);
                Err(SceneError::InputTable(format!("time = {first} to {last} s: the run lasts from 0 to {stop} s")))
            }
            _ => Ok(()),
        }
    }

    /// Whether the table has a column for the input.
    pub fn drives(&self, input: RealInput) -> bool {
        self.columns.iter().any(|(column, _)| *column == input)
    }

    /// Removes the column of an input.
    pub fn release(&mut self, input: RealInput) {
        self.columns.retain(|(column, _)| *column != input);
    }

    /// Sets the inputs of the table to their values at `time` (s), and their rates so that they reach the values
    /// `size` seconds later.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] if a rate is not finite, or if the step is longer than the time between two rows: it would pass
    /// them over.
    pub fn set(&self, inputs: &mut Inputs, time: f64, size: f64) -> Result<(), SceneError> {
        if let Some(distance) = self.passed_over(time, size) {
            let distance = error::number(distance);
            let allowed = format!("the time between two rows of the input table, {distance} s");
            return Err(SceneError::out_of_range("communicationStep", size, "s", &allowed));
        }
        self.columns.iter().try_for_each(|(input, values)| {
            let value = self.value(values, time);
            inputs.set_real(*input, value)?;
            inputs.set_rate(*input, (self.value(values, time + size) - value) / size)
        })
    }

    /// The time between two rows that both lie inside a step of `size` seconds from `time` (s), not at its ends but for the rounding
    /// of a recorder.
    fn passed_over(&self, time: f64, size: f64) -> Option<f64> {
        let first = self.times.partition_point(|row| *row <= time + 0.01 * size);
        let [row, next] = self.times.get(first..first + 2)? else { return None };
        (*next < time + 0.99 * size).then_some(next - row)
    }

    fn value(&self, values: &[f64], time: f64) -> f64 {
        let mut rows = self.times.iter().zip(values);
        let after = self.times.partition_point(|row| *row <= time);
        let Some(before) = after.checked_sub(1) else { return rows.next().map_or(0.0, |(_, value)| *value) };
        let before = rows.nth(before);
        match (before, rows.next()) {
            (Some((t0, v0)), Some((t1, v1))) => (v1 - v0) / (t1 - t0) * (time - t0) + v0,
            (last, _) => last.map_or(0.0, |(_, value)| *value),
        }
    }
}

fn columns(head: &StringRecord) -> Result<Vec<Column>, SceneError> {
    let mut seen = Vec::new();
    let columns = head.iter().map(|name| {
        if seen.contains(&name) {
            return Err(SceneError::GivenTwice { name: name.to_owned(), allowed: "one column" });
        }
        seen.push(name);
        if name == "time" {
            return Ok(None);
        }
        match variable(Role::Input, name)?.group {
            Group::RealInput(input) => Ok(Some(input)),
            _ => Err(SceneError::InputTable(format!("{name} is not an input"))),
        }
    });
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    if !columns.contains(&None) {
        return Err(SceneError::MissingKey { name: "time", allowed: "a column of times in s" });
    }
    Ok(columns)
}

fn number(name: &str, field: &str) -> Result<f64, SceneError> {
    field.parse().map_err(|_| SceneError::WrongType {
        name: name.to_owned(),
        value: format!("{field:?}"),
        allowed: "a number",
    })
}

/// Adds the line of its row to an error.
fn at_line<T>(text: &str, row: &StringRecord, result: Result<T, SceneError>) -> Result<T, SceneError> {
    result.map_err(|error| {
        // The position includes preceding empty lines.
        let position = row.position().map_or(0, csv::Position::byte);
        let position = usize::try_from(position).unwrap_or(usize::MAX);
        let empty = text.bytes().skip(position).take_while(|byte| b"\r\n".contains(byte));
        let start = position.saturating_add(empty.count());
        located(text, &(start..start), error)
    })
}
