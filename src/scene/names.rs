//! The variable names allowed in a scene file or an input table.

use std::borrow::Borrow;

use crate::error::SceneError;
use crate::variables::{Group, VARIABLES, Variable};

/// The kind of variable allowed at a position of the file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Parameter,
    Input,
    Settable,
    Output,
}

impl Role {
    fn covers(self, variable: &Variable) -> bool {
        match variable.group {
            Group::RealInput(_) => matches!(self, Self::Input | Self::Settable),
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => self == Self::Output,
            _ => matches!(self, Self::Parameter | Self::Settable),
        }
    }

    fn noun(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Input => "input",
            Self::Settable => "parameter or input",
            Self::Output => "output",
        }
    }
}

/// The variable of this name, or an error with the three most similar names.
pub(crate) fn variable(role: Role, name: &str) -> Result<&'static Variable, SceneError> {
    let variables = VARIABLES.iter().filter(|variable| role.covers(variable));
    if let Some(variable) = variables.clone().find(|variable| variable.name == name) {
        return Ok(variable);
    }
    // The group may be missing, so the last word counts as much as the whole name.
    let likeness = |known: &str| {
        let word = known.rsplit('.').next().unwrap_or(known);
        strsim::jaro_winkler(name, known).max(strsim::jaro_winkler(name, word))
    };
    let mut names: Vec<_> = variables.map(|variable| variable.name).collect();
    names.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
    Err(SceneError::UnknownName { name: name.to_owned(), what: role.noun(), nearest: list(names.into_iter().take(3)) })
}

/// Names separated by commas.
pub(crate) fn list<S: Borrow<str>>(names: impl Iterator<Item = S>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
