//! Makes calls on an instance through the C functions, and records the log.

use std::ffi::{CStr, CString};
use std::ptr;

use relay_contact::fmi2::*;
use testing::instance::Arguments;
use testing::log::{self, Log, Message, callbacks};

use crate::api::Api;
use crate::call::{Call, Fault, SLOTS};
use crate::description::{DESCRIPTION, Kind};
use crate::pointers::{arguments, middle, place, places};
use crate::texts;

/// An instance, the states saved of it, which are freed with it, and their bytes.
#[derive(Debug)]
pub struct Importer<'a> {
    api: &'a Api,
    /// The instance; a test may replace it.
    pub component: fmi2Component,
    states: [fmi2FMUstate; SLOTS],
    bytes: [Vec<u8>; SLOTS],
    // Boxed, so that the address held by the callback stays valid.
    log: Box<Log>,
}

/// A function that reads or writes variables.
type Function<Values> = unsafe extern "C" fn(fmi2Component, *const fmi2ValueReference, usize, Values) -> fmi2Status;

/// The result of a call: status, and the values read, if any.
pub type Answer = (fmi2Status, Vec<f64>);

impl<'a> Importer<'a> {
    pub fn new(api: &'a Api) -> Self {
        let log = Box::new(Log::default());
        let component = instantiate(api, &log);
        assert!(!component.is_null(), "no instance: is the library from the same build as the tests? {log:?}");
        let states = [ptr::null_mut(); SLOTS];
        let bytes = [const { Vec::new() }; SLOTS];
        Self { api, component, states, bytes, log }
    }

    /// The messages since the last call of this function.
    pub fn messages(&self) -> Vec<Message> {
        log::taken(&self.log)
    }

    pub fn bytes(&mut self, slot: usize) -> &mut Vec<u8> {
        &mut self.bytes[slot]
    }

    /// Makes a call. `time` is the time of the instance.
    #[allow(clippy::too_many_lines)] // one line a function
    pub fn make(&mut self, call: &Call, fault: Fault, time: f64) -> Answer {
        let (api, c) = (self.api, self.component);
        let status = unsafe {
            match call {
                Call::SetDebugLogging(on, categories) => {
                    let texts: Vec<_> = categories
                        .iter()
                        .map(|text| text.as_ref().map(|text| CString::new(text.as_str()).unwrap_or_default()))
                        .collect();
                    let pointers: Vec<_> =
                        texts.iter().map(|text| text.as_ref().map_or(ptr::null(), |text| text.as_ptr())).collect();
                    let (_, pointer, count) = arguments(fault, &pointers, &pointers);
                    (api.fmi2SetDebugLogging)(c, (*on).into(), count, pointer)
                }
                Call::SetupExperiment(tolerance, start, stop) => (api.fmi2SetupExperiment)(
                    c,
                    tolerance.is_some().into(),
                    tolerance.unwrap_or(0.0),
                    *start,
                    stop.is_some().into(),
                    stop.unwrap_or(0.0),
                ),
                Call::EnterInitializationMode => (api.fmi2EnterInitializationMode)(c),
                Call::ExitInitializationMode => (api.fmi2ExitInitializationMode)(c),
                Call::Terminate => (api.fmi2Terminate)(c),
                Call::Reset => (api.fmi2Reset)(c),
                Call::Renew => {
                    (api.fmi2FreeInstance)(c);
                    self.states = [ptr::null_mut(); SLOTS];
                    self.component = instantiate(api, &self.log);
                    if self.component.is_null() { fmi2Error } else { fmi2OK }
                }
                Call::Get(kind, references) => return self.get(*kind, references, fault),
                Call::Set(kind, values) => self.set(*kind, values, fault),
                Call::GetState(slot)
                | Call::SetState(slot)
                | Call::FreeState(slot)
                | Call::StateSize(slot)
                | Call::Serialize(slot)
                | Call::Deserialize(slot) => return self.state_call(call, *slot, fault),
                Call::DirectionalDerivative => {
                    let (known, unknown) = (DESCRIPTION.variables[0].reference, DESCRIPTION.outputs(Kind::Real)[0]);
                    let (change, mut result) = (1.0, 0.0);
                    (api.fmi2GetDirectionalDerivative)(
                        c,
                        &raw const unknown,
                        1,
                        &raw const known,
                        1,
                        &raw const change,
                        &raw mut result,
                    )
                }
                Call::SetInputDerivatives(values) => {
                    let references: Vec<_> = values.iter().map(|value| value.0).collect();
                    let orders: Vec<_> = values.iter().map(|value| value.1).collect();
                    let numbers: Vec<_> = values.iter().map(|value| value.2).collect();
                    let (vr, value, count) = arguments(fault, &references, &numbers);
                    (api.fmi2SetRealInputDerivatives)(c, vr, count, middle(fault, &orders), value)
                }
                Call::GetOutputDerivatives(values) => {
                    let references: Vec<_> = values.iter().map(|value| value.0).collect();
                    let orders: Vec<_> = values.iter().map(|value| value.1).collect();
                    let mut numbers = vec![f64::NAN; values.len()];
                    let (vr, value, count) = places(fault, &references, &mut numbers);
                    let status = (api.fmi2GetRealOutputDerivatives)(c, vr, count, middle(fault, &orders), value);
                    return (status, numbers);
                }
                Call::DoStep(point, size) => (api.fmi2DoStep)(c, point.instant(time, *size), *size, fmi2True),
                Call::CancelStep => (api.fmi2CancelStep)(c),
                Call::Status(function, kind) => return self.status(*function, *kind, fault),
                Call::Replay { .. } => unreachable!("a replay consists of other calls"),
            }
        };
        (status, Vec::new())
    }

    fn get(&self, kind: Kind, references: &[u32], fault: Fault) -> Answer {
        let (api, read) = (self.api, (references, fault));
        let numbers = |(status, values): (fmi2Status, Vec<i32>)| (status, values.into_iter().map(f64::from).collect());
        match kind {
            Kind::Real => self.read(api.fmi2GetReal, read, f64::NAN),
            Kind::Integer => numbers(self.read(api.fmi2GetInteger, read, i32::MIN)),
            Kind::Boolean => numbers(self.read(api.fmi2GetBoolean, read, i32::MIN)),
            Kind::String => {
                let (status, texts) = self.read(api.fmi2GetString, read, ptr::null());
                let known = texts.iter().filter(|text| !text.is_null());
                // The strings stay valid until the next call.
                (status, known.map(|text| texts::number(unsafe { CStr::from_ptr(*text) })).collect())
            }
        }
    }

    fn read<T: Clone>(
        &self,
        function: Function<*mut T>,
        (references, fault): (&[u32], Fault),
        before: T,
    ) -> (fmi2Status, Vec<T>) {
        let mut values = vec![before; references.len()];
        let (vr, value, count) = places(fault, references, &mut values);
        (unsafe { function(self.component, vr, count, value) }, values)
    }

    #[allow(clippy::cast_possible_truncation)] // saturates, as intended for values beyond the integers
    fn set(&self, kind: Kind, values: &[(u32, f64)], fault: Fault) -> fmi2Status {
        let (api, write) = (self.api, (values, fault));
        match kind {
            Kind::Real => self.write(api.fmi2SetReal, write, |value| value),
            Kind::Integer => self.write(api.fmi2SetInteger, write, |value| value as i32),
            Kind::Boolean => self.write(api.fmi2SetBoolean, write, |value| value as i32),
            Kind::String => self.write(api.fmi2SetString, write, |value| texts::text(value).as_ptr()),
        }
    }

    fn write<T>(
        &self,
        function: Function<*const T>,
        (values, fault): (&[(u32, f64)], Fault),
        as_held: impl Fn(f64) -> T,
    ) -> fmi2Status {
        let (references, values): (Vec<_>, Vec<_>) = values.iter().map(|value| (value.0, as_held(value.1))).unzip();
        let (vr, value, count) = arguments(fault, &references, &values);
        unsafe { function(self.component, vr, count, value) }
    }

    fn state_call(&mut self, call: &Call, slot: usize, fault: Fault) -> Answer {
        let (api, c) = (self.api, self.component);
        let mut memory = [0_u64; 8];
        let mut foreign: fmi2FMUstate = memory.as_mut_ptr().cast();
        // The state itself, for functions that read it.
        let state = match fault {
            Fault::Foreign => foreign,
            Fault::FirstNull => ptr::null_mut(),
            Fault::Misaligned => foreign.wrapping_byte_add(1),
            _ => self.states[slot],
        };
        // Where functions that make or free a state find it: their last argument.
        let is_null = fault == if matches!(call, Call::Deserialize(..)) { Fault::LastNull } else { Fault::FirstNull };
        let place = match fault {
            Fault::Foreign => &raw mut foreign,
            _ if is_null => ptr::null_mut(),
            _ => &raw mut self.states[slot],
        };
        let mut size = 0;
        let status = unsafe {
            match call {
                Call::GetState(..) => (api.fmi2GetFMUstate)(c, place),
                Call::SetState(..) => (api.fmi2SetFMUstate)(c, state),
                Call::FreeState(..) => (api.fmi2FreeFMUstate)(c, place),
                Call::StateSize(..) => {
                    let place = if fault == Fault::LastNull { ptr::null_mut() } else { &raw mut size };
                    let status = (api.fmi2SerializedFMUstateSize)(c, state, place);
                    return (status, vec![size as f64]);
                }
                Call::Serialize(..) => {
                    if !self.states[slot].is_null() {
                        (api.fmi2SerializedFMUstateSize)(c, self.states[slot], &raw mut size);
                    }
                    let mut room = vec![0_u8; size];
                    let (place, size) = match fault {
                        Fault::LastNull => (ptr::null_mut(), size),
                        Fault::NullAndEndless => (ptr::null_mut(), usize::MAX),
                        Fault::Endless => (room.as_mut_ptr().cast(), usize::MAX),
                        _ => (room.as_mut_ptr().cast(), size),
                    };
                    let status = (api.fmi2SerializeFMUstate)(c, state, place, size);
                    if status == fmi2OK {
                        self.bytes[slot] = room;
                    }
                    status
                }
                _ => {
                    let bytes = damaged(&self.bytes[slot], fault);
                    let (bytes, _, size) = arguments(fault, &bytes, &bytes);
                    (api.fmi2DeSerializeFMUstate)(c, bytes.cast(), size, place)
                }
            }
        };
        assert_eq!(memory, [0; 8], "{call:?}: wrote to memory that is not a saved state");
        (status, Vec::new())
    }

    fn status(&self, function: Option<Kind>, kind: u32, fault: Fault) -> Answer {
        let (api, c) = (self.api, self.component);
        let (mut status, mut real, mut integer, mut text) = (fmi2OK, f64::NAN, i32::MIN, ptr::null());
        let answer = unsafe {
            match function {
                None => (api.fmi2GetStatus)(c, kind, place(fault, &mut status)),
                Some(Kind::Real) => (api.fmi2GetRealStatus)(c, kind, place(fault, &mut real)),
                Some(Kind::Integer) => (api.fmi2GetIntegerStatus)(c, kind, place(fault, &mut integer)),
                Some(Kind::Boolean) => (api.fmi2GetBooleanStatus)(c, kind, place(fault, &mut integer)),
                Some(Kind::String) => (api.fmi2GetStringStatus)(c, kind, place(fault, &mut text)),
            }
        };
        (answer, vec![if function == Some(Kind::Real) { real } else { integer.into() }])
    }
}

impl Drop for Importer<'_> {
    fn drop(&mut self) {
        unsafe { (self.api.fmi2FreeInstance)(self.component) };
    }
}

/// The bytes with their damage.
fn damaged(bytes: &[u8], fault: Fault) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    match fault {
        Fault::Flip(at) if !bytes.is_empty() => {
            let at = at as usize % (8 * bytes.len());
            bytes[at / 8] ^= 1 << (at % 8);
        }
        Fault::Cut(length) if !bytes.is_empty() => bytes.truncate(length as usize % bytes.len()),
        Fault::Longer(count) => bytes.extend(vec![0; usize::from(count) + 1]),
        _ => {}
    }
    bytes
}

/// A new instance with the GUID of the description.
fn instantiate(api: &Api, log: &Log) -> fmi2Component {
    let arguments = Arguments { guid: Some(&DESCRIPTION.guid), ..Arguments::default() };
    arguments.instantiate(api.fmi2Instantiate, Some(&callbacks(log)))
}
