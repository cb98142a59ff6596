//! Many communication steps in one call, for languages in which a call takes longer than a step. Not a function of FMI.

use std::mem::MaybeUninit;

use libc::size_t;

use super::entry::{array, array_mut, call};
use super::failure::Failure;
use super::instance::Instance;
use super::instance::variables::{Value, find};
use super::states;
use super::types::{fmi2Component, fmi2Real, fmi2Status, fmi2ValueReference, fmi2Warning};

/// Advances from the first of `times` to the last, a communication step from each to the next. `courses` has a row for
/// each time, with the value of each input, which changes linearly over a step; at a time given twice there is no step, and
/// the inputs jump. `values` takes a row for each step, with outputs (also parameters and inputs) at its end as reals: a
/// choice by its number, true as one. It does what `fmi2SetReal`, `fmi2SetRealInputDerivatives`, `fmi2DoStep` and the
/// functions that read do in turn, bit by bit, with the messages of `fmi2DoStep`, and is allowed where that is;
/// `stepFinished` is not called. The first failure ends it: the rows before are those of the steps that were done.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn relayContactFollow(
    c: fmi2Component,
    times: *const fmi2Real,
    nTimes: size_t,
    inputs: *const fmi2ValueReference,
    nInputs: size_t,
    courses: *const fmi2Real,
    outputs: *const fmi2ValueReference,
    nOutputs: size_t,
    values: *mut fmi2Real,
) -> fmi2Status {
    let size = |rows: size_t, columns: size_t, name| rows.checked_mul(columns).ok_or(Failure::Pointer(name));
    // SAFETY: the contract of the module.
    unsafe {
        call(c, states::DO_STEP, |instance| {
            let given = size(nTimes, nInputs, "courses")?;
            let taken = size(nTimes.saturating_sub(1), nOutputs, "values")?;
            let times = array(times, nTimes, "times")?;
            let (inputs, courses) = (array(inputs, nInputs, "inputs")?, array(courses, given, "courses")?);
            let outputs = array(outputs, nOutputs, "outputs")?;
            let values = array_mut(values, taken, "values")?;
            follow(instance, times, (inputs, courses), (outputs, values))
        })
    }
}

/// Does the steps; inputs and outputs come with their rows.
fn follow(
    instance: &mut Instance,
    times: &[f64],
    (inputs, courses): (&[u32], &[f64]),
    (outputs, values): (&[u32], &mut [MaybeUninit<f64>]),
) -> Result<(), Failure> {
    let orders = vec![1; inputs.len()];
    let mut rates = vec![0.0; inputs.len()];
    let mut values = values.iter_mut();
    let width = inputs.len();
    let row = |number: usize| courses.get(number * width..(number + 1) * width).unwrap_or_default();
    for (number, (&now, &next)) in times.iter().zip(times.iter().skip(1)).enumerate() {
        let length = next - now;
        // A jump. What is not a number fails as a step.
        if length == 0.0 {
            continue;
        }
        let (begin, end) = (row(number), row(number + 1));
        if !inputs.is_empty() {
            for ((rate, begin), end) in rates.iter_mut().zip(begin).zip(end) {
                *rate = (end - begin) / length;
            }
            instance.set("Real", inputs, begin.iter().map(|value| Ok(Value::Number(*value))))?;
            instance.set_input_derivatives(inputs, &orders, &rates)?;
        }
        if let Err(failure) = instance.step(now, length) {
            if failure.status() != fmi2Warning {
                return Err(failure);
            }
            instance.fail(states::DO_STEP, &failure);
        }
        for (&output, value) in outputs.iter().zip(values.by_ref()) {
            value.write(instance.number(find("Real", output)?)?);
        }
    }
    Ok(())
}
