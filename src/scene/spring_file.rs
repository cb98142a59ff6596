//! Spring files in TOML, SI units: [segments](crate::scene::spring::Segments) from the clamp on and what they carry, or
//! [modes](crate::scene::spring::Modes) of the free spring. Their keys are in docs/spring-files.md.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use crate::error::SceneError;
use crate::scene::document::{Entry, located, of_file, parsed};
use crate::scene::spring::{
    CLAMP_STIFFNESS, COMPLIANCE, CONTACT_POSITION, GivenMode, Modes, PARALLEL_COMPLIANCE, PointMass, Segment, Segments,
    Shape, SpringFile,
};

/// Largest file, bytes.
const LARGEST: u64 = 1 << 20;

/// Brackets inside each other that a spring takes: a list of tables. The parser calls itself for each, on a stack that may be
/// small.
const DEEPEST: usize = 2;

impl SpringFile {
    /// Reads the file `name`; a relative name is one in `folder`.
    ///
    /// # Errors
    /// The first [`SceneError`] found, with file, line and entry.
    pub fn read(folder: &Path, name: &str) -> Result<Self, SceneError> {
        let path = folder.join(name);
        let shape = of_file(&path, text(&path), shape)?;
        Ok(Self { name: name.to_owned(), shape })
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

fn shape(text: &str) -> Result<Shape, SceneError> {
    check_nesting(text)?;
    let document = parsed(text)?;
    let top = Entry::whole(text, &document);
    top.get("title", |value| value.string("title", "a string"))?;
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
    top.knows(&["title", "segment", "mass", "contact_position", "fork_position", "clamp_stiffness"])?;
    let mut spring = Segments {
        segments: top.entries("segment", 1, |entry| {
            let mut segment = Segment::default();
            entry.fill(segment.keys()).map(|()| segment)
        })?,
        clamp_stiffness: top.optional(CLAMP_STIFFNESS)?,
        ..Segments::default()
    };
    let length = spring.length();
    spring.contact_position = top.optional(CONTACT_POSITION.up_to(length))?;
    spring.fork_position = top.optional(spring.fork())?;
    spring.masses = top.entries("mass", 0, |entry| {
        let mut mass = PointMass::default();
        entry.fill(mass.keys(length)).map(|()| mass)
    })?;
    // The sum of the lengths has no line of its own.
    spring.check().map(|()| spring)
}

fn modes(top: &Entry) -> Result<Modes, SceneError> {
    top.knows(&["title", "compliance", "parallel_compliance", "mode"])?;
    let spring = Modes {
        compliance: top.required(COMPLIANCE)?,
        parallel_compliance: top.optional(PARALLEL_COMPLIANCE)?,
        modes: top.entries("mode", 1, |entry| {
            let mut mode = GivenMode::default();
            entry.fill(mode.keys()).map(|()| mode)
        })?,
    };
    let checked = spring.check();
    let key = match &checked {
        Err(SceneError::Contradiction { name, .. }) => name,
        _ => COMPLIANCE.name,
    };
    let place = top.value(key).map_or(0..0, |value| value.node.span());
    top.at(&place, checked)?;
    Ok(spring)
}
