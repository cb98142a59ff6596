//! The messages of an instance.

use std::ffi::CStr;
use std::ptr;
use std::sync::Mutex;

use relay_contact::fmi2::*;

/// A message received by the importer.
#[derive(Clone, Debug)]
pub struct Message {
    pub instance: String,
    pub status: fmi2Status,
    pub category: String,
    pub text: String,
}

/// The log the callback writes to.
pub type Log = Mutex<Vec<Message>>;

/// The messages of a log since the last call of this function.
pub fn taken(log: &Log) -> Vec<Message> {
    log.lock().map(|mut log| std::mem::take(&mut *log)).unwrap_or_default()
}

/// The log callback without its variable arguments, which the component never passes.
unsafe extern "C" fn logger(
    environment: fmi2ComponentEnvironment,
    instance: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
) {
    assert!(!instance.is_null() && !category.is_null() && !message.is_null());
    let text = |text| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned();
    let log = unsafe { &*environment.cast::<Log>() };
    if let Ok(mut log) = log.lock() {
        log.push(Message { instance: text(instance), status, category: text(category), text: text(message) });
    }
}

/// Callbacks that write to `log`.
pub fn callbacks(log: &Log) -> fmi2CallbackFunctions {
    calling(Some(logger), None, ptr::from_ref(log).cast_mut().cast())
}

/// A log callback without its variable arguments.
pub type Logger = unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String);

/// Callbacks with this environment.
pub fn calling(
    logger: Option<Logger>,
    finished: fmi2StepFinished,
    environment: fmi2ComponentEnvironment,
) -> fmi2CallbackFunctions {
    fmi2CallbackFunctions {
        // Stable Rust cannot define a variadic function; the C calling conventions of the platforms we test on pass the
        // fixed arguments of one as those of this function.
        logger: unsafe { std::mem::transmute::<Option<Logger>, fmi2CallbackLogger>(logger) },
        allocateMemory: None,
        freeMemory: None,
        stepFinished: finished,
        componentEnvironment: environment,
    }
}
