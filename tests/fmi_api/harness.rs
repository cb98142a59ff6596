//! An importer for tests: calls the C functions as C would, and keeps what was logged.

use std::ffi::CString;
use std::ptr;

use relay_contact::fmi2::*;
use relay_contact::variables::{GUID, Variable};

pub use crate::log::{Log, Message, callbacks};

/// An instance under test. Freed with the value.
pub struct Fmu {
    pub component: fmi2Component,
    // Boxed, so that the address the callback holds stays.
    log: Box<Log>,
}

/// `fmi2Instantiate` with what can go wrong left open.
pub fn instantiate(
    name: Option<&str>,
    kind: fmi2Type,
    guid: Option<&str>,
    log: &Log,
    logging_on: fmi2Boolean,
) -> fmi2Component {
    let (name, guid) = (
        name.map(|name| CString::new(name).unwrap()),
        guid.map(|guid| CString::new(guid).unwrap()),
    );
    let pointer = |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
    let callbacks = callbacks(log);
    unsafe {
        fmi2Instantiate(
            pointer(&name),
            kind,
            pointer(&guid),
            ptr::null(),
            &raw const callbacks,
            fmi2False,
            logging_on,
        )
    }
}

/// The value reference of a name.
pub fn vr(name: &str) -> fmi2ValueReference {
    Variable::by_name(name).unwrap().value_reference
}

impl Fmu {
    /// In the state instantiated.
    pub fn new() -> Self {
        Self::with_logging(fmi2False)
    }

    /// The same, with debug messages or without.
    pub fn with_logging(on: fmi2Boolean) -> Self {
        let log = Box::new(Log::default());
        let component = instantiate(Some("relay 1"), fmi2CoSimulation, Some(GUID), &log, on);
        assert!(!component.is_null(), "{log:?}");
        Self { component, log }
    }

    /// In Initialization Mode.
    pub fn initializing() -> Self {
        let fmu = Self::new();
        assert_eq!(unsafe { fmi2EnterInitializationMode(fmu.component) }, fmi2OK);
        fmu
    }

    /// At the first communication point, with start values.
    pub fn initialized() -> Self {
        let fmu = Self::initializing();
        assert_eq!(
            unsafe { fmi2ExitInitializationMode(fmu.component) },
            fmi2OK,
            "{:?}",
            fmu.log
        );
        fmu
    }

    pub fn set_reals(&self, names: &[&str], values: &[f64]) -> fmi2Status {
        let references: Vec<_> = names.iter().map(|name| vr(name)).collect();
        unsafe { fmi2SetReal(self.component, references.as_ptr(), references.len(), values.as_ptr()) }
    }

    pub fn set_real(&self, name: &str, value: f64) -> fmi2Status {
        self.set_reals(&[name], &[value])
    }

    pub fn set_integer(&self, name: &str, value: i32) -> fmi2Status {
        let reference = vr(name);
        unsafe { fmi2SetInteger(self.component, &raw const reference, 1, &raw const value) }
    }

    /// Status and value.
    pub fn try_real(&self, name: &str) -> (fmi2Status, f64) {
        let (reference, mut value) = (vr(name), f64::NAN);
        let status = unsafe { fmi2GetReal(self.component, &raw const reference, 1, &raw mut value) };
        (status, value)
    }

    pub fn real(&self, name: &str) -> f64 {
        let (status, value) = self.try_real(name);
        assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        value
    }

    pub fn integer(&self, name: &str) -> i32 {
        let (reference, mut value) = (vr(name), i32::MIN);
        let status = unsafe { fmi2GetInteger(self.component, &raw const reference, 1, &raw mut value) };
        assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        value
    }

    pub fn step(&self, point: f64, size: f64) -> fmi2Status {
        unsafe { fmi2DoStep(self.component, point, size, fmi2True) }
    }

    pub fn reset(&self) -> fmi2Status {
        unsafe { fmi2Reset(self.component) }
    }

    /// Status and value of the last successful time.
    pub fn last_successful_time(&self) -> (fmi2Status, f64) {
        let mut time = f64::NAN;
        let status = unsafe { fmi2GetRealStatus(self.component, fmi2LastSuccessfulTime, &raw mut time) };
        (status, time)
    }

    /// Everything logged so far.
    pub fn messages(&self) -> Vec<Message> {
        self.log.lock().unwrap().clone()
    }

    /// The only message since the last look, whose text holds all `parts`.
    pub fn expect_message(&self, status: fmi2Status, parts: &[&str]) {
        let messages = std::mem::take(&mut *self.log.lock().unwrap());
        let [message] = &messages[..] else {
            panic!("one message expected with {parts:?}, found {messages:#?}");
        };
        assert_eq!(message.status, status, "{message:?}");
        for part in parts {
            assert!(message.text.contains(part), "{part:?} missing: {message:?}");
        }
    }
}

impl Drop for Fmu {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.component) }
    }
}
