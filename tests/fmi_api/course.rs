//! Many steps in one call: what the calls one after another do, bit by bit.

use std::ptr;

use relay_contact::fmi2::*;
use testing::instance::{Instance, vr};

const INPUTS: [&str; 2] = ["base.acceleration", "contact.current"];
/// Outputs of each type, and an input and a choice.
const READ: [&str; 6] =
    ["contact.force", "step.minimumForce", "chatter.count", "contact.closed", "contact.current", "effects.resistance"];

/// Times with a jump at 30 us, and the inputs there: the contact opens.
fn course() -> (Vec<f64>, Vec<[f64; 2]>) {
    let times = [0.0, 1e-5, 3e-5, 3e-5, 1e-4, 4e-4, 4.1e-4, 2e-3];
    let inputs =
        [[0.0, 0.0], [5.0, 0.01], [10.0, 0.02], [-900.0, 0.02], [-900.0, 0.1], [-600.0, 0.1], [300.0, 0.0], [0.0, 0.0]];
    (times.to_vec(), inputs.to_vec())
}

fn follow(fmu: &Instance, times: &[f64], inputs: &[[f64; 2]]) -> (fmi2Status, Vec<[f64; 6]>) {
    let references = INPUTS.map(vr);
    let outputs = READ.map(vr);
    let mut rows = vec![[f64::NAN; 6]; times.len().saturating_sub(1)];
    let status = unsafe {
        relayContactFollow(
            fmu.component,
            times.as_ptr(),
            times.len(),
            references.as_ptr(),
            references.len(),
            inputs.as_ptr().cast(),
            outputs.as_ptr(),
            outputs.len(),
            rows.as_mut_ptr().cast(),
        )
    };
    (status, rows)
}

/// The same by the functions of FMI.
fn one_by_one(fmu: &Instance, times: &[f64], inputs: &[[f64; 2]]) -> Vec<[f64; 6]> {
    let mut rows = Vec::new();
    for (time, input) in times.windows(2).zip(inputs.windows(2)) {
        let length = time[1] - time[0];
        if length == 0.0 {
            continue;
        }
        assert_eq!(fmu.set_reals(INPUTS, input[0]), fmi2OK);
        let rates = [0, 1].map(|k| (input[1][k] - input[0][k]) / length);
        assert_eq!(fmu.set_rates(INPUTS, [1; 2], rates), fmi2OK);
        assert_eq!(fmu.step(time[0], length), fmi2OK);
        rows.push([
            fmu.real(READ[0]),
            fmu.real(READ[1]),
            f64::from(fmu.integer(READ[2])),
            f64::from(u8::from(fmu.boolean(READ[3]))),
            fmu.real(READ[4]),
            f64::from(fmu.integer(READ[5])),
        ]);
    }
    rows
}

fn started() -> Instance {
    let fmu = Instance::initializing();
    assert_eq!(fmu.set_real("chatter.minimumDuration", 0.0), fmi2OK);
    assert_eq!(fmu.exit_initialization_mode(), fmi2OK);
    fmu
}

fn bits(rows: &[[f64; 6]]) -> Vec<[u64; 6]> {
    rows.iter().map(|row| row.map(f64::to_bits)).collect()
}

#[test]
fn the_rows_are_those_of_calls_one_after_another() {
    let (times, inputs) = course();
    let (fmu, other) = (started(), started());
    let expected = one_by_one(&other, &times, &inputs);
    let (status, rows) = follow(&fmu, &times, &inputs);
    assert_eq!(status, fmi2OK);
    assert_eq!(bits(&rows[..6]), bits(&expected));
    // The jump is no step, and has no row.
    assert!(rows[6].iter().all(|value| value.is_nan()));
    let counted = expected.iter().any(|row| row[2] > 0.0) && expected.iter().any(|row| row[3] == 0.0);
    assert!(counted, "the contact did not open: {expected:?}");
    // It goes on from there, with the inputs held.
    assert_eq!((fmu.step(2e-3, 1e-5), other.step(2e-3, 1e-5)), (fmi2OK, fmi2OK));
    assert_eq!(fmu.real("contact.force").to_bits(), other.real("contact.force").to_bits());
}

#[test]
fn a_failure_leaves_what_was_done_before() {
    let (times, mut inputs) = course();
    // Out of its range after the fourth time.
    inputs[4][1] = 1e9;
    let (fmu, other) = (started(), started());
    let (status, rows) = follow(&fmu, &times, &inputs);
    assert_eq!(status, fmi2Error);
    fmu.expect_message(fmi2Error, &["fmi2DoStep", "contact.current = 1000000000 A: not allowed", "in this step"]);
    assert_eq!(bits(&rows[..2]), bits(&one_by_one(&other, &times[..3], &inputs[..3])));
    assert!(rows[2..].iter().flatten().all(|value| value.is_nan()));
    assert_eq!(fmu.last_successful_time(), other.last_successful_time());
}

#[test]
fn times_that_go_back_fail_as_a_step_and_few_do_nothing() {
    for times in [[0.0, -1e-5], [0.0, f64::NAN], [0.0, f64::INFINITY], [1.0, 2.0]] {
        let (status, rows) = follow(&started(), &times, &[[0.0; 2]; 2]);
        assert!(status > fmi2OK && rows[0][0].is_nan(), "{times:?}");
    }
    let fmu = started();
    for times in [&[][..], &[0.0]] {
        assert_eq!(follow(&fmu, times, &vec![[0.0; 2]; times.len()]).0, fmi2OK);
    }
    assert_eq!(fmu.step(0.0, 1e-5), fmi2OK);
}

#[test]
fn wrong_calls_are_refused() {
    let (times, inputs) = course();
    let fmu = Instance::initializing();
    assert_eq!(follow(&fmu, &times, &inputs).0, fmi2Error);
    fmu.expect_message(fmi2Error, &["not allowed in the state Initialization Mode"]);
    let call = |component, n: usize, input: u32, n_inputs: usize, courses: *const f64, output: u32, rows: *mut f64| unsafe {
        relayContactFollow(
            component,
            times.as_ptr(),
            n,
            &raw const input,
            n_inputs,
            courses,
            &raw const output,
            1,
            rows,
        )
    };
    let (acceleration, force) = (vr("base.acceleration"), vr("contact.force"));
    let mut row = [0.0; 8];
    let (given, taken) = (inputs.as_ptr().cast::<f64>(), row.as_mut_ptr());
    for (n, input, n_inputs, courses, output, rows) in [
        (2, acceleration, 1, ptr::null(), force, taken),
        (2, acceleration, 1, given, force, ptr::null_mut()),
        // More than there can be.
        (usize::MAX, acceleration, 1, given, force, taken),
        (2, acceleration, usize::MAX, given, force, taken),
        (2, force, 1, given, force, taken),
        (2, 99_999, 1, given, force, taken),
        (2, acceleration, 1, given, 99_999, taken),
        (2, acceleration, 1, given, vr("beam.file"), taken),
    ] {
        let fmu = started();
        assert!(call(fmu.component, n, input, n_inputs, courses, output, rows) > fmi2OK);
        assert_eq!(call(ptr::null_mut(), n, input, n_inputs, courses, output, rows), fmi2Error);
    }
}
