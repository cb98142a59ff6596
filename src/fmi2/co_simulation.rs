//! Communication steps and their status; derivatives of inputs and outputs.
// Unused arguments keep their names for the header.
#![allow(unused_variables)]

use libc::size_t;

use super::entry::{array, array_mut, call, place};
use super::failure::Failure;
use super::instance::Instance;
use super::states::{self, Function};
use super::types::{
    fmi2Boolean, fmi2Component, fmi2False, fmi2Integer, fmi2LastSuccessfulTime, fmi2OK, fmi2Real, fmi2Status,
    fmi2StatusKind, fmi2String, fmi2Terminated, fmi2ValueReference,
};

/// Sets first derivatives of continuous inputs, all or none; they hold for the next communication step only, over
/// which the inputs change linearly. A value that is not finite gives `fmi2Discard`, and none is set. Derivatives of higher
/// order have no effect, which the first time is a warning in the log: FMI 2.0 has no attribute that would tell before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::SET_REAL_INPUT_DERIVATIVES, |instance| {
            let (references, orders) = (array(vr, nvr, "vr")?, array(order, nvr, "order")?);
            instance.set_input_derivatives(references, orders, array(value, nvr, "value")?)
        })
    }
}

/// Reads first derivatives of outputs at the communication point, as limits from the left; 0 before the first step, and
/// of discrete outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::GET_REAL_OUTPUT_DERIVATIVES, |instance| {
            let (references, orders) = (array(vr, nvr, "vr")?, array(order, nvr, "order")?);
            let values = array_mut(value, nvr, "value")?;
            for ((&reference, &order), value) in references.iter().zip(orders).zip(values) {
                value.write(instance.output_derivative(reference, order)?);
            }
            Ok(())
        })
    }
}

/// Advances to the end of one communication step. `currentCommunicationPoint` must equal the time of the instance up to
/// 1e-4 of the step, and the step size must be positive. The first difference that is more than rounding is a warning in
/// the log; the step then goes from the time of the instance to `currentCommunicationPoint + communicationStepSize`. The
/// first time that the tolerance may not be kept is a warning too. If the motion cannot be integrated, the result is
/// `fmi2Error`, never `fmi2Discard`: the log reports time and cause, and `fmi2GetRealStatus` the last successful time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    let mut finished = (None, std::ptr::null_mut());
    let body = |instance: &mut Instance| {
        finished = instance.step_finished;
        instance.step(currentCommunicationPoint, communicationStepSize)
    };
    // SAFETY: the contract of the module.
    let status = unsafe { call(c, states::DO_STEP, body) };
    if let (Some(callback), environment) = finished
        && status == fmi2OK
    {
        // SAFETY: the importer promises a callback of this type. No reference into the instance is left, so it may use it.
        unsafe { callback(environment, status) };
    }
    status
}

/// Always an error: a step is complete when `fmi2DoStep` returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { call(c, states::CANCEL_STEP, |_| Ok(())) }
}

/// Returns a status value, or `fmi2Discard` if there is none.
unsafe fn status<T>(
    c: fmi2Component,
    function: Function,
    kind: fmi2StatusKind,
    value: *mut T,
    answer: impl Fn(&Instance) -> Option<T>,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe {
        call(c, function, |instance| {
            let place = place(value, "value")?;
            place.write(answer(instance).ok_or(Failure::StatusKind(kind))?);
            Ok(())
        })
    }
}

/// Always `fmi2Discard`: no step is ever pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Status) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { status(c, states::GET_STATUS, s, value, |_| None) }
}

/// The last successful time, also after a failed step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Real) -> fmi2Status {
    let answer = |instance: &Instance| (s == fmi2LastSuccessfulTime).then_some(instance.time);
    // SAFETY: the contract of the module.
    unsafe { status(c, states::GET_REAL_STATUS, s, value, answer) }
}

/// Always `fmi2Discard`: the standard has no such status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { status(c, states::GET_INTEGER_STATUS, s, value, |_| None) }
}

/// Whether the component asks to terminate: always false.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    let answer = |_: &Instance| (s == fmi2Terminated).then_some(fmi2False);
    // SAFETY: the contract of the module.
    unsafe { status(c, states::GET_BOOLEAN_STATUS, s, value, answer) }
}

/// Always `fmi2Discard`: no step is ever pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: the contract of the module.
    unsafe { status(c, states::GET_STRING_STATUS, s, value, |_| None) }
}
