//! Derivatives of inputs and outputs.

use std::ptr;

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::fmi2::*;
use relay_contact::variables::{Group, VARIABLES};

use crate::harness::{Fmu, vr};

fn set(fmu: &Fmu, names: &[&str], orders: &[fmi2Integer], values: &[f64]) -> fmi2Status {
    let references: Vec<_> = names.iter().map(|name| vr(name)).collect();
    let (orders, values) = (orders.as_ptr(), values.as_ptr());
    unsafe { fmi2SetRealInputDerivatives(fmu.component, references.as_ptr(), references.len(), orders, values) }
}

fn get(fmu: &Fmu, name: &str, order: fmi2Integer) -> (fmi2Status, f64) {
    let (reference, mut value) = (vr(name), f64::NAN);
    let status = unsafe {
        fmi2GetRealOutputDerivatives(fmu.component, &raw const reference, 1, &raw const order, &raw mut value)
    };
    (status, value)
}

#[test]
fn a_derivative_counts_for_one_step() {
    let fmu = Fmu::initialized();
    assert_eq!(set(&fmu, &["support.displacement"], &[1], &[1e-3]), fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
    let moved = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    // The fixed contact is where the derivative led; without one it goes back to its input.
    assert_eq!(fmu.step(1e-4, 1e-4), fmi2OK);
    let back = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    assert!((moved - back - 1e-7).abs() < 1e-18, "{moved} {back}");
    assert_eq!(fmu.real("support.displacement"), 0.0);
}

#[test]
fn the_force_follows_an_acceleration_that_grows() {
    let fmu = Fmu::initialized();
    assert_eq!(set(&fmu, &["base.acceleration"], &[1], &[1e3]), fmi2OK);
    let before = fmu.real("contact.force");
    assert_eq!(fmu.step(0.0, 0.1), fmi2OK);
    let after = fmu.real("contact.force");
    // Slow against every mode: the weight of a propped cantilever with a mass at the prop, the prop all but rigid.
    let mass = 0.375 * 8300.0 * 0.05423 * 1.1898e-4 * 0.0155 + 2.26e-5;
    let (found, expected) = (after - before, mass * 100.0);
    assert!(
        (found / expected - 1.0).abs() < 1e-3,
        "{found} N, expected {expected} N"
    );
    let (status, rate) = get(&fmu, "contact.force", 1);
    assert_eq!(status, fmi2OK);
    assert!((rate / (mass * 1e3) - 1.0).abs() < 1e-3, "{rate} N/s");
}

#[test]
fn the_continuous_outputs_have_derivatives_and_nothing_else_has() {
    for variable in &VARIABLES {
        let fmu = Fmu::initialized();
        let declared = format!(
            "name=\"{}\" valueReference=\"{}\" causality=\"output\" variability=\"continuous\"",
            variable.name, variable.value_reference
        );
        let continuous = MODEL_DESCRIPTION.contains(&declared);
        let (status, rate) = get(&fmu, variable.name, 1);
        if continuous {
            assert_eq!((status, rate), (fmi2OK, 0.0), "{}", variable.name);
        } else {
            assert_eq!(status, fmi2Error, "{}", variable.name);
            fmu.expect_message(fmi2Error, &["fmi2GetRealOutputDerivatives", variable.name]);
        }
        let fmu = Fmu::initialized();
        if matches!(variable.group, Group::RealInput(_)) {
            assert_eq!(set(&fmu, &[variable.name], &[1], &[1.0]), fmi2OK, "{}", variable.name);
        } else {
            assert_eq!(
                set(&fmu, &[variable.name], &[1], &[1.0]),
                fmi2Error,
                "{}",
                variable.name
            );
            fmu.expect_message(fmi2Error, &["fmi2SetRealInputDerivatives", variable.name]);
        }
    }
}

#[test]
fn other_orders_than_the_first_are_errors() {
    for order in [i32::MIN, -1, 0, 2, i32::MAX] {
        let fmu = Fmu::initialized();
        assert_eq!(set(&fmu, &["base.acceleration"], &[order], &[1.0]), fmi2Error);
        fmu.expect_message(fmi2Error, &["base.acceleration", &order.to_string(), "allowed is 1"]);
        let fmu = Fmu::initialized();
        assert_eq!(get(&fmu, "contact.force", order).0, fmi2Error);
        fmu.expect_message(fmi2Error, &["contact.force", &order.to_string(), "allowed is 1"]);
    }
}

#[test]
fn a_derivative_that_is_no_number_is_discarded_with_all_of_its_call() {
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let fmu = Fmu::initialized();
        let names = ["support.displacement", "base.acceleration"];
        assert_eq!(set(&fmu, &names, &[1, 1], &[1e-3, wrong]), fmi2Discard);
        fmu.expect_message(fmi2Discard, &["base.acceleration", "finite"]);
        let before = fmu.real("contact.force");
        assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
        assert_eq!(fmu.real("contact.force"), before);
    }
}

#[test]
fn null_arrays_are_errors_unless_empty() {
    let (input, output, order, value) = (vr("base.acceleration"), vr("contact.force"), 1, 0.0);
    let (input, output, order, value) = (&raw const input, &raw const output, &raw const order, &raw const value);
    let mut place = 0.0;
    let place = &raw mut place;
    let fmu = Fmu::initialized();
    unsafe {
        assert_eq!(
            fmi2SetRealInputDerivatives(fmu.component, ptr::null(), 0, ptr::null(), ptr::null()),
            fmi2OK
        );
        assert_eq!(
            fmi2GetRealOutputDerivatives(fmu.component, ptr::null(), 0, ptr::null(), ptr::null_mut()),
            fmi2OK
        );
    }
    for (argument, [vr, order, value]) in [
        ("vr", [ptr::null(), order.cast(), value.cast()]),
        ("order", [input.cast(), ptr::null(), value.cast()]),
        ("value", [input.cast(), order.cast::<()>(), ptr::null::<()>()]),
    ] {
        let fmu = Fmu::initialized();
        let status = unsafe { fmi2SetRealInputDerivatives(fmu.component, vr.cast(), 1, order.cast(), value.cast()) };
        assert_eq!(status, fmi2Error);
        fmu.expect_message(fmi2Error, &[&format!("argument {argument} ")]);
        let fmu = Fmu::initialized();
        let (vr, place) = (
            if vr.is_null() { ptr::null() } else { output },
            if value.is_null() { ptr::null_mut() } else { place },
        );
        let status = unsafe { fmi2GetRealOutputDerivatives(fmu.component, vr, 1, order.cast(), place) };
        assert_eq!(status, fmi2Error);
        fmu.expect_message(fmi2Error, &[&format!("argument {argument} ")]);
    }
}
