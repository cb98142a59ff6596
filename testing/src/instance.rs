//! Instances behind the C interface.

use std::ffi::{CStr, CString};
use std::ptr;

use relay_contact::fmi2::*;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::variables::{GUID, Group, RealInput, VARIABLES, Variable};

use crate::log::{self, Log, Message, callbacks};

/// The type of `fmi2Instantiate`.
pub type Instantiate = unsafe extern "C" fn(
    fmi2String,
    fmi2Type,
    fmi2String,
    fmi2String,
    *const fmi2CallbackFunctions,
    fmi2Boolean,
    fmi2Boolean,
) -> fmi2Component;

/// Arguments of `fmi2Instantiate`, valid by default.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a> {
    pub name: Option<&'a str>,
    pub kind: fmi2Type,
    pub guid: Option<&'a str>,
    pub resources: Option<&'a CStr>,
    pub logging_on: bool,
}

impl Default for Arguments<'_> {
    fn default() -> Self {
        Self { name: Some("relay 1"), kind: fmi2CoSimulation, guid: Some(GUID), resources: None, logging_on: false }
    }
}

impl Arguments<'_> {
    /// Calls `function`, the `fmi2Instantiate` of a library.
    pub fn instantiate(&self, function: Instantiate, callbacks: Option<&fmi2CallbackFunctions>) -> fmi2Component {
        let text = |text: Option<&str>| text.map(|text| CString::new(text).unwrap_or_default());
        let pointer = |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
        let (name, guid) = (text(self.name), text(self.guid));
        unsafe {
            function(
                pointer(&name),
                self.kind,
                pointer(&guid),
                self.resources.map_or(ptr::null(), CStr::as_ptr),
                callbacks.map_or(ptr::null(), ptr::from_ref),
                fmi2False,
                self.logging_on.into(),
            )
        }
    }
}

/// An instance of the library linked into this program, with its log. Freed with the value.
#[derive(Debug)]
pub struct Instance {
    /// For calls without a method below.
    pub component: fmi2Component,
    // Boxed, so that the address held by the callback stays valid.
    log: Box<Log>,
}

/// The value reference of a name.
pub fn vr(name: &str) -> fmi2ValueReference {
    let variable = Variable::by_name(name);
    variable.unwrap_or_else(|| panic!("no variable {name}")).value_reference
}

impl Default for Instance {
    fn default() -> Self {
        Self::new()
    }
}

impl Instance {
    /// An instance in the state instantiated.
    pub fn new() -> Self {
        Self::with(&Arguments::default())
    }

    /// The same with other arguments.
    pub fn with(arguments: &Arguments) -> Self {
        let log = Box::new(Log::default());
        let component = arguments.instantiate(fmi2Instantiate, Some(&callbacks(&log)));
        assert!(!component.is_null(), "{arguments:?}: {log:?}");
        Self { component, log }
    }

    /// An instance in Initialization Mode.
    pub fn initializing() -> Self {
        let instance = Self::new();
        assert_eq!(instance.enter_initialization_mode(), fmi2OK);
        instance
    }

    /// An instance at the first communication point, with start values.
    pub fn initialized() -> Self {
        let instance = Self::new();
        instance.initialize();
        instance
    }

    pub fn setup(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> fmi2Status {
        let defined = |number: Option<f64>| (number.is_some().into(), number.unwrap_or(0.0));
        let ((tolerance_defined, tolerance), (stop_defined, stop)) = (defined(tolerance), defined(stop));
        unsafe { fmi2SetupExperiment(self.component, tolerance_defined, tolerance, start, stop_defined, stop) }
    }

    pub fn enter_initialization_mode(&self) -> fmi2Status {
        unsafe { fmi2EnterInitializationMode(self.component) }
    }

    pub fn exit_initialization_mode(&self) -> fmi2Status {
        unsafe { fmi2ExitInitializationMode(self.component) }
    }

    /// From the state instantiated to the first communication point.
    pub fn initialize(&self) {
        assert_eq!(self.enter_initialization_mode(), fmi2OK, "{:?}", self.log);
        assert_eq!(self.exit_initialization_mode(), fmi2OK, "{:?}", self.log);
    }

    pub fn set_reals<const N: usize>(&self, names: [&str; N], values: [f64; N]) -> fmi2Status {
        self.set_reals_of(names.map(vr), values)
    }

    /// The same by value references, where time is measured.
    pub fn set_reals_of<const N: usize>(&self, references: [fmi2ValueReference; N], values: [f64; N]) -> fmi2Status {
        unsafe { fmi2SetReal(self.component, references.as_ptr(), N, values.as_ptr()) }
    }

    /// `fmi2SetReal` of one variable.
    pub fn set_real(&self, name: &str, value: f64) -> fmi2Status {
        self.set_reals([name], [value])
    }

    pub fn set_integer(&self, name: &str, value: i32) -> fmi2Status {
        unsafe { fmi2SetInteger(self.component, [vr(name)].as_ptr(), 1, &raw const value) }
    }

    pub fn set_boolean(&self, name: &str, value: bool) -> fmi2Status {
        let value = value.into();
        unsafe { fmi2SetBoolean(self.component, [vr(name)].as_ptr(), 1, &raw const value) }
    }

    pub fn set_string(&self, name: &str, value: &str) -> fmi2Status {
        let value = CString::new(value).unwrap_or_default();
        unsafe { fmi2SetString(self.component, [vr(name)].as_ptr(), 1, [value.as_ptr()].as_ptr()) }
    }

    pub fn string(&self, name: &str) -> String {
        let (reference, mut value) = (vr(name), ptr::null());
        let status = unsafe { fmi2GetString(self.component, &raw const reference, 1, &raw mut value) };
        assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        unsafe { CStr::from_ptr(value) }.to_string_lossy().into_owned()
    }

    /// Sets all parameters to those of a scene.
    pub fn set_scene(&self, scene: &Scene) {
        for Variable { name, group, .. } in &VARIABLES {
            let status = match *group {
                Group::RealParameter(parameter) => self.set_real(name, scene.real(parameter)),
                Group::IntegerParameter(parameter) => self.set_integer(name, scene.integer(parameter)),
                Group::BooleanParameter(parameter) => self.set_boolean(name, scene.boolean(parameter)),
                Group::EnumerationParameter(parameter) => self.set_integer(name, scene.enumeration(parameter)),
                Group::StringParameter(parameter) => {
                    // Of a scene of the project, for tests run in its top folder.
                    let (file, here) = (scene.string(parameter), std::env::current_dir().expect("a folder"));
                    let path = here.join("scenes").join(file).display().to_string();
                    self.set_string(name, if file.is_empty() { "" } else { &path })
                }
                _ => fmi2OK,
            };
            assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        }
    }

    /// Sets the inputs with their derivatives.
    pub fn set_inputs(&self, inputs: &Inputs) {
        for &input in RealInput::ALL {
            let (reference, value, rate) = (input.variable().value_reference, inputs.real(input), inputs.rate(input));
            assert_eq!(self.set_reals_of([reference], [value]), fmi2OK, "{:?}", self.log);
            assert_eq!(self.set_rates_of([reference], [1], [rate]), fmi2OK, "{:?}", self.log);
        }
    }

    pub fn set_rates<const N: usize>(&self, names: [&str; N], orders: [i32; N], rates: [f64; N]) -> fmi2Status {
        self.set_rates_of(names.map(vr), orders, rates)
    }

    /// `fmi2SetRealInputDerivatives`, of these orders.
    pub fn set_rates_of<const N: usize>(&self, references: [u32; N], orders: [i32; N], rates: [f64; N]) -> fmi2Status {
        let (references, orders) = (references.as_ptr(), orders.as_ptr());
        unsafe { fmi2SetRealInputDerivatives(self.component, references, N, orders, rates.as_ptr()) }
    }

    /// `fmi2GetRealOutputDerivatives` of one variable, the first: status and value.
    pub fn try_rate(&self, name: &str) -> (fmi2Status, f64) {
        let (reference, order, mut rate) = (vr(name), 1, f64::NAN);
        let (reference, order) = (&raw const reference, &raw const order);
        let status = unsafe { fmi2GetRealOutputDerivatives(self.component, reference, 1, order, &raw mut rate) };
        (status, rate)
    }

    /// Sets the excitation to a sine of 1 kHz and this amplitude, m/s2.
    pub fn shake(&self, amplitude: f64) {
        assert_eq!(self.set_integer("effects.excitation", 2), fmi2OK);
        assert_eq!(self.set_real("excitation.amplitude", amplitude), fmi2OK);
    }

    /// `fmi2GetReal`: status and value.
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

    /// The values of real variables by value references, where time is measured.
    pub fn reals_of<const N: usize>(&self, references: [fmi2ValueReference; N]) -> [f64; N] {
        let mut values = [f64::NAN; N];
        let status = unsafe { fmi2GetReal(self.component, references.as_ptr(), N, values.as_mut_ptr()) };
        assert_eq!(status, fmi2OK, "{:?}", self.log);
        values
    }

    pub fn integer(&self, name: &str) -> i32 {
        let (reference, mut value) = (vr(name), i32::MIN);
        let status = unsafe { fmi2GetInteger(self.component, &raw const reference, 1, &raw mut value) };
        assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        value
    }

    pub fn boolean(&self, name: &str) -> bool {
        let (reference, mut value) = (vr(name), -1);
        let status = unsafe { fmi2GetBoolean(self.component, &raw const reference, 1, &raw mut value) };
        assert_eq!(status, fmi2OK, "{name}: {:?}", self.log);
        value == fmi2True
    }

    pub fn step(&self, point: f64, size: f64) -> fmi2Status {
        unsafe { fmi2DoStep(self.component, point, size, fmi2True) }
    }

    pub fn reset(&self) -> fmi2Status {
        unsafe { fmi2Reset(self.component) }
    }

    pub fn save(&self) -> fmi2FMUstate {
        let mut state = ptr::null_mut();
        assert_eq!(unsafe { fmi2GetFMUstate(self.component, &raw mut state) }, fmi2OK);
        assert!(!state.is_null());
        state
    }

    pub fn restore(&self, state: fmi2FMUstate) -> fmi2Status {
        unsafe { fmi2SetFMUstate(self.component, state) }
    }

    pub fn free(&self, mut state: fmi2FMUstate) {
        assert_eq!(unsafe { fmi2FreeFMUstate(self.component, &raw mut state) }, fmi2OK);
        assert!(state.is_null());
    }

    pub fn to_bytes(&self, state: fmi2FMUstate) -> Vec<fmi2Byte> {
        let (component, mut size) = (self.component, 0);
        unsafe {
            assert_eq!(fmi2SerializedFMUstateSize(component, state, &raw mut size), fmi2OK);
            let mut bytes = vec![0; size];
            assert_eq!(fmi2SerializeFMUstate(component, state, bytes.as_mut_ptr(), size), fmi2OK);
            bytes
        }
    }

    /// `fmi2DeSerializeFMUstate`: status, and the state, null where there is none.
    pub fn from_bytes(&self, bytes: &[fmi2Byte]) -> (fmi2Status, fmi2FMUstate) {
        let mut state = ptr::null_mut();
        let status = unsafe { fmi2DeSerializeFMUstate(self.component, bytes.as_ptr(), bytes.len(), &raw mut state) };
        (status, state)
    }

    /// Status and value of the last successful time.
    pub fn last_successful_time(&self) -> (fmi2Status, f64) {
        let mut time = f64::NAN;
        let status = unsafe { fmi2GetRealStatus(self.component, fmi2LastSuccessfulTime, &raw mut time) };
        (status, time)
    }

    /// The messages since the last call of this function.
    pub fn messages(&self) -> Vec<Message> {
        log::taken(&self.log)
    }

    /// Asserts that the call returned the status, with a single message that contains all `parts`.
    pub fn answers(&self, status: fmi2Status, expected: fmi2Status, parts: &[&str]) {
        assert_eq!(status, expected, "{parts:?}: {:?}", self.log);
        self.expect_message(expected, parts);
    }

    /// Asserts that there is a single message, whose text contains all `parts`.
    pub fn expect_message(&self, status: fmi2Status, parts: &[&str]) {
        let messages = self.messages();
        let [message] = &messages[..] else {
            panic!("one message expected with {parts:?}, found {messages:#?}");
        };
        assert_eq!(message.status, status, "{message:?}");
        for part in parts {
            assert!(message.text.contains(part), "{part:?} missing: {message:?}");
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.component) }
    }
}
