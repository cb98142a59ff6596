//! Log messages to the importer, through its callback only.

use std::ffi::{CStr, CString};

use super::failure::Failure;
use super::types::{fmi2CallbackFunctions, fmi2CallbackLogger, fmi2ComponentEnvironment, fmi2Error, fmi2Status};

/// Kinds of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// Calls that failed.
    StatusError,
    /// Calls that were refused and changed nothing.
    StatusWarning,
    /// Openings and closings of the contact.
    Events,
    /// Work of the integrator.
    Solver,
}

use Category::{Events, Solver, StatusError, StatusWarning};

impl Category {
    /// All of them.
    pub const ALL: [Self; 4] = [StatusError, StatusWarning, Events, Solver];

    /// As the description declares it.
    pub fn name(self) -> &'static CStr {
        match self {
            StatusError => c"logStatusError",
            StatusWarning => c"logStatusWarning",
            Events => c"logEvents",
            Solver => c"logSolver",
        }
    }
}

/// The importer's log callback, and the categories that it shows ([`fmi2SetDebugLogging`](super::fmi2SetDebugLogging)).
/// Errors and warnings are shown from the start, independent of `loggingOn`: a call that fails must say why (by the standard, the
/// reason for fmi2Discard is logged with `loggingOn` only, which importers leave off by default). With `loggingOn` events are shown
/// too, but not the solver, which logs every step: some importers always set the flag.
#[derive(Debug)]
pub(super) struct Logger {
    callback: fmi2CallbackLogger,
    environment: fmi2ComponentEnvironment,
    instance_name: CString,
    /// In the order of [`Category::ALL`].
    shown: [bool; 4],
    initially: [bool; 4],
}

impl Logger {
    pub(super) fn new(functions: &fmi2CallbackFunctions, instance_name: &CStr, logging_on: bool) -> Self {
        let initially = [true, true, logging_on, false];
        Self {
            callback: functions.logger,
            environment: functions.componentEnvironment,
            instance_name: instance_name.to_owned(),
            shown: initially,
            initially,
        }
    }

    pub(super) fn reset(&mut self) {
        self.shown = self.initially;
    }

    /// Selects what is shown; a category that is not declared changes nothing.
    pub(super) fn choose(&mut self, on: bool, categories: &[&CStr]) -> Result<(), Failure> {
        let known = Category::ALL.map(Category::name);
        if let Some(unknown) = categories.iter().find(|category| !known.contains(category)) {
            return Err(Failure::Category(unknown.to_string_lossy().into_owned()));
        }
        for (shown, category) in self.shown.iter_mut().zip(Category::ALL) {
            let named = categories.contains(&category.name());
            *shown = match (on, categories.is_empty()) {
                (true, all) => all || named,
                (false, true) => *shown && matches!(category, StatusError | StatusWarning),
                (false, false) => *shown && !named,
            };
        }
        Ok(())
    }

    /// Whether any debug category is shown.
    pub(super) fn debugs(&self) -> bool {
        let [_, _, events, solver] = self.shown;
        (events || solver) && self.callback.is_some()
    }

    fn shows(&self, category: Category) -> bool {
        self.shown.get(category as usize).is_some_and(|shown| *shown)
    }

    /// Passes the message of a failed call to the importer.
    pub(super) fn log_status(&self, status: fmi2Status, message: &str) {
        let category = if status >= fmi2Error { StatusError } else { StatusWarning };
        self.log(category, status, message);
    }

    pub(super) fn log(&self, category: Category, status: fmi2Status, message: &str) {
        let Some(callback) = self.callback.filter(|_| self.shows(category)) else { return };
        let Ok(format) = CString::new(printf_safe(message)) else { return };
        // SAFETY: the importer promises a logger of this type that can be called until the instance is freed. The
        // strings live through the call, and the format asks for no further argument.
        unsafe {
            callback(self.environment, self.instance_name.as_ptr(), status, category.name().as_ptr(), format.as_ptr());
        }
    }
}

/// The message as a format without arguments: `%` doubled, zero bytes removed. `#` is doubled too, as the standard has
/// it: a single one would begin a reference to a variable.
/// Not the format "%s" with the message as argument: importers whose callback cannot take variable arguments (for
/// example in Python) show the format unchanged.
fn printf_safe(message: &str) -> String {
    message.replace('\0', "").replace('%', "%%").replace('#', "##")
}
