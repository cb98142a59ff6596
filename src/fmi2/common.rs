//! Versions, logging and the life cycle.
// Unused arguments keep their names for the header.
#![allow(unused_variables)]

use std::ffi::CStr;
use std::path::Path;
use std::ptr;

use libc::{c_char, size_t};

use super::entry::{array, call, hand_out, take_back, text};
use super::environment::with_default;
use super::failure::Failure;
use super::instance::Instance;
use super::logger::Logger;
use super::resources::{self, Identity};
use super::states::{self, State};
use super::types::{
    fmi2Boolean, fmi2CallbackFunctions, fmi2CoSimulation, fmi2Component, fmi2Error, fmi2False, fmi2Real, fmi2Status,
    fmi2String, fmi2Type,
};
use crate::error::caught;
use crate::variables::{GUID, PLAIN_GUID};

/// The platform types the functions use: "default".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// The version of the standard: "2.0".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Selects the log categories. By default all errors and warnings are logged, and with `loggingOn` of
/// [`fmi2Instantiate`] events too. With categories given, true shows only these and false hides these; without, true
/// shows all, and false hides events and the solver. An unknown category is a warning and changes nothing, so that it
/// cannot stop a simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: size_t,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::SET_DEBUG_LOGGING, |instance| {
            let categories = array(categories, nCategories, "categories")?.iter();
            let categories = categories.map(|category| text(*category, "categories"));
            let categories = categories.collect::<Result<Vec<_>, _>>()?;
            instance.logger.choose(loggingOn != fmi2False, &categories)
        })
    }
}

/// Creates an instance. Returns null if the name is missing, the type is not co-simulation, or the GUID belongs to
/// another description or spring file. The callbacks are copied; logger and `stepFinished` are used, which may be null; the
/// logger must not call back into the instance. The resource location is the folder of relative spring files, and may be
/// null unless the component carries one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: the contract of the module.
    let Ok([functions]) = (unsafe { array(functions, 1, "functions") }) else { return ptr::null_mut() };
    // SAFETY: the contract of the module.
    let [name, guid, resources] = unsafe {
        [text(instanceName, "instanceName"), text(fmuGUID, "fmuGUID"), text(fmuResourceLocation, "fmuResourceLocation")]
    };
    let resources = resources.ok().and_then(|text| resources::folder(text.to_str().ok()?));
    let name = name.ok().filter(|name| !name.is_empty());
    let logger = |on| Logger::new(functions, name.unwrap_or(c"RelayContact"), on);
    let make = || {
        name.ok_or("instanceName is null or empty")?;
        let identity = identity(fmuType, guid, resources.as_deref())?;
        let step_finished = (functions.stepFinished, functions.componentEnvironment);
        let instance = Instance::new(logger(loggingOn != fmi2False), step_finished, resources, identity);
        instance.map_err(|error| error.to_string())
    };
    let made = with_default(|| caught(make));
    match made.unwrap_or_else(|panic| Err(Failure::Panic(panic).to_string())) {
        Ok(instance) => hand_out(instance),
        Err(reason) => {
            logger(false).log_status(fmi2Error, &format!("fmi2Instantiate: {reason}"));
            ptr::null_mut()
        }
    }
}

/// What is to be instantiated, or why no instance can be created.
fn identity(kind: fmi2Type, guid: Result<&CStr, Failure>, resources: Option<&Path>) -> Result<Identity, String> {
    if kind != fmi2CoSimulation {
        return Err(format!("fmuType = {kind}: not allowed, allowed is 1 (fmi2CoSimulation)"));
    }
    let guid = guid.map_err(|failure| failure.to_string())?.to_string_lossy();
    Identity::of(&guid, resources).ok_or_else(|| {
        let folder = resources.map_or("none".to_owned(), |folder| folder.display().to_string());
        format!(
            "fmuGUID = {guid}: not allowed, allowed is {GUID}, for the plain variant {PLAIN_GUID}, or the GUID of one of \
             these with a spring file in the folder of resources ({folder}); library, modelDescription.xml and spring file \
             do not belong together"
        )
    })
}

/// Frees an instance. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: the contract of the module.
    unsafe { take_back(c) }
}

/// Sets tolerance, start and stop time; without a call the start time is zero and there is no stop time.
/// The tolerance is used if `solver.tolerance` is 0. A tolerance that is not a positive finite number is ignored with
/// a warning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    let tolerance = (toleranceDefined != fmi2False).then_some(tolerance);
    let stop = (stopTimeDefined != fmi2False).then_some(stopTime);
    let body = |instance: &mut Instance| instance.setup_experiment(tolerance, startTime, stop);
    // SAFETY: the contract of the module.
    unsafe { call(c, states::SETUP_EXPERIMENT, body) }
}

/// Enters Initialization Mode, in which outputs can be read for the parameters set so far.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
    let body = |instance: &mut Instance| {
        instance.state = State::InitializationMode;
        Ok(())
    };
    // SAFETY: the contract of the module.
    unsafe { call(c, states::ENTER_INITIALIZATION_MODE, body) }
}

/// Ends Initialization Mode: the contact is at rest in its preload. An error if the parameters are inconsistent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { call(c, states::EXIT_INITIALIZATION_MODE, Instance::exit_initialization_mode) }
}

/// Ends the simulation. Values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> fmi2Status {
    let body = |instance: &mut Instance| {
        instance.state = State::Terminated;
        Ok(())
    };
    // SAFETY: the contract of the module.
    unsafe { call(c, states::TERMINATE, body) }
}

/// Restores the start values and the state after `fmi2Instantiate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> fmi2Status {
    let body = |instance: &mut Instance| {
        instance.reset();
        Ok(())
    };
    // SAFETY: the contract of the module.
    unsafe { call(c, states::RESET, body) }
}
