//! Messages to the importer, through its callback only.

use std::ffi::{CStr, CString};

use super::types::{fmi2CallbackFunctions, fmi2CallbackLogger, fmi2ComponentEnvironment, fmi2Error, fmi2Status};

/// Category of messages about calls that failed.
pub const LOG_STATUS_ERROR: &CStr = c"logStatusError";
/// Category of messages about calls that were refused and changed nothing.
pub const LOG_STATUS_WARNING: &CStr = c"logStatusWarning";

/// The importer's log callback, and the categories it wants to see.
///
/// Both categories are shown from the start, whatever `loggingOn` says: that flag is about debug messages, of which
/// there are none, while a call that fails without a word leaves the user nothing to go by (the standard would have
/// the reason for fmi2Discard told with `loggingOn` only; importers leave that off by default). `fmi2SetDebugLogging` with named
/// categories shows these and no others (`loggingOn` true), or hides these (false); without categories, true shows all
/// and false, which could only hide debug messages, changes nothing.
#[derive(Debug)]
pub(super) struct Logger {
    callback: fmi2CallbackLogger,
    environment: fmi2ComponentEnvironment,
    instance_name: CString,
    errors: bool,
    warnings: bool,
}

impl Logger {
    pub(super) fn new(functions: &fmi2CallbackFunctions, instance_name: &CStr) -> Self {
        Self {
            callback: functions.logger,
            environment: functions.componentEnvironment,
            instance_name: instance_name.to_owned(),
            errors: true,
            warnings: true,
        }
    }

    /// Chooses what is shown. An unknown category changes nothing.
    ///
    /// # Errors
    /// The first category that is not declared.
    pub(super) fn choose<'a>(&mut self, on: bool, categories: &[&'a CStr]) -> Result<(), &'a CStr> {
        let known = [LOG_STATUS_ERROR, LOG_STATUS_WARNING];
        if let Some(unknown) = categories.iter().find(|category| !known.contains(category)) {
            return Err(unknown);
        }
        let named = |category| categories.contains(&category);
        let (errors, warnings) = (named(LOG_STATUS_ERROR), named(LOG_STATUS_WARNING));
        (self.errors, self.warnings) = match (on, categories.is_empty()) {
            (true, true) => (true, true),
            (true, false) => (errors, warnings),
            (false, _) => (self.errors && !errors, self.warnings && !warnings),
        };
        Ok(())
    }

    /// Hands a message to the importer.
    pub(super) fn log(&self, status: fmi2Status, message: &str) {
        let (shown, category) = if status >= fmi2Error {
            (self.errors, LOG_STATUS_ERROR)
        } else {
            (self.warnings, LOG_STATUS_WARNING)
        };
        let Some(callback) = self.callback.filter(|_| shown) else {
            return;
        };
        let Ok(format) = CString::new(printf_safe(message)) else {
            return;
        };
        // SAFETY: the importer promises a logger of this type that can be called until the instance is freed. The
        // strings live through the call, and the format asks for no further argument.
        unsafe {
            callback(
                self.environment,
                self.instance_name.as_ptr(),
                status,
                category.as_ptr(),
                format.as_ptr(),
            );
        }
    }
}

/// The message as a format without arguments: `%` doubled, zero bytes removed.
///
/// Rather this than the format "%s" with the message as argument: importers whose callback cannot take variable
/// arguments (those in Python, for one) show the format as it is.
fn printf_safe(message: &str) -> String {
    message.replace('\0', "").replace('%', "%%")
}
