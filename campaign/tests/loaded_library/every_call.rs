//! Every function in every state, with valid and with wrong arguments.

use std::collections::BTreeSet;
use std::ptr;

use campaign::api::LIBRARY;
use campaign::call::{Call, Fault, Point};
use campaign::description::{DESCRIPTION, Kind, Role};
use campaign::importer::Importer;
use campaign::judge::Judge;
use campaign::states::{Phase, functions};
use relay_contact::MODEL_DESCRIPTION;
use relay_contact::fmi2::*;

/// Brings an instance from any state into the phase, with a saved state and its bytes in the first slot; a new one into the phases
/// before its start.
fn bring(judge: &mut Judge, phase: Phase) -> Result<(), String> {
    let first = if has_started(phase) { Call::Reset } else { Call::Renew };
    judge.run(&[first, Call::FreeState(0), Call::FreeState(1), Call::GetState(0), Call::Serialize(0)])?;
    let ([enter, exit], step) = (Call::INITIALISE, Call::step(1e-5));
    judge.run(&match phase {
        Phase::Instantiated => vec![],
        Phase::InitializationMode => vec![enter],
        Phase::StepComplete => vec![enter, exit, step],
        Phase::Terminated => vec![enter, exit, step, Call::Terminate],
        Phase::Error => vec![enter, exit, step, Call::step(-1.0)],
    })
}

fn has_started(phase: Phase) -> bool {
    !matches!(phase, Phase::Instantiated | Phase::InitializationMode)
}

/// Every function with valid arguments.
fn calls() -> Vec<Call> {
    let mut calls = vec![
        Call::SetupExperiment(Some(1e-6), 0.0, Some(1.0)),
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
        Call::Terminate,
        Call::Reset,
        Call::Renew,
        Call::DirectionalDerivative,
        Call::CancelStep,
        Call::step(1e-5),
        Call::SetDebugLogging(true, vec![None]),
        Call::SetDebugLogging(false, vec![]),
    ];
    for category in ["logStatusError", "logEverything"] {
        calls.push(Call::SetDebugLogging(true, vec![Some(category.to_owned())]));
    }
    for kind in Kind::ALL {
        let all = || DESCRIPTION.variables.iter().filter(move |variable| variable.kind == kind);
        let settable = || all().filter(|variable| variable.role != Role::Output);
        for count in [0, 1] {
            calls.push(Call::Get(kind, all().take(count).map(|variable| variable.reference).collect()));
            let values = settable().take(count).map(|variable| (variable.reference, variable.start));
            calls.push(Call::Set(kind, values.collect()));
        }
    }
    for slot in [0, 1] {
        calls.extend([Call::GetState(slot), Call::SetState(slot), Call::FreeState(slot)]);
        calls.extend([Call::StateSize(slot), Call::Serialize(slot), Call::Deserialize(slot)]);
    }
    for function in Kind::ALL.map(Some).into_iter().chain([None]) {
        calls.extend([0, 1, 2, 3, 4, u32::MAX].map(|kind| Call::Status(function, kind)));
    }
    let input = DESCRIPTION.reference("base.acceleration");
    let force = DESCRIPTION.reference("contact.force");
    for count in [0, 1] {
        calls.push(Call::SetInputDerivatives(vec![(input, 1, 3.0); count]));
        calls.push(Call::GetOutputDerivatives(vec![(force, 1); count]));
    }
    calls
}

/// Each of them with each fault.
fn faulty_calls() -> impl Iterator<Item = (Call, Fault)> {
    calls().into_iter().flat_map(|call| Fault::ALL.map(|fault| (call.clone(), fault)))
}

fn set_derivative(reference: u32, order: i32, value: f64) -> Call {
    Call::SetInputDerivatives(vec![(reference, order, value)])
}

fn get_derivative(reference: u32, order: i32) -> Call {
    Call::GetOutputDerivatives(vec![(reference, order)])
}

/// Wrong values, references and communication points.
fn wrong_numbers() -> Vec<Call> {
    let mut calls = Vec::new();
    let current = DESCRIPTION.reference("contact.current");
    let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e307, -1e307];
    for variable in &DESCRIPTION.variables {
        for kind in Kind::ALL {
            calls.push(Call::Get(kind, vec![variable.reference]));
            let near = [variable.min, variable.max, variable.min - 1.0, variable.max + 1.0];
            // The value matters only if the function matches the variable.
            let count = if kind == variable.kind { strange.len() + near.len() } else { 1 };
            for value in strange.iter().chain(&near).take(count) {
                // After a valid one, which is not set if the value is wrong.
                let before = (kind == Kind::Real).then_some((current, 3.0));
                let values = before.into_iter().chain([(variable.reference, *value)]);
                calls.push(Call::Set(kind, values.collect()));
            }
        }
        calls.push(set_derivative(variable.reference, 1, 0.0));
        calls.push(get_derivative(variable.reference, 1));
    }
    for reference in [3, 99, 9999, u32::MAX] {
        calls.push(Call::Get(Kind::Real, vec![reference]));
        calls.push(Call::set_reals(vec![(reference, 0.0)]));
    }
    let (input, force) = (DESCRIPTION.reference("base.acceleration"), DESCRIPTION.reference("contact.force"));
    for order in [i32::MIN, -1, 0, 2, i32::MAX] {
        calls.push(set_derivative(input, order, 0.0));
        calls.push(get_derivative(force, order));
    }
    for value in strange {
        calls.push(set_derivative(input, 1, value));
    }
    for size in [0.0, -0.0, -1e-5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324] {
        calls.push(Call::step(size));
    }
    for point in [
        Point::Off(-1.0),
        Point::Off(1.0),
        Point::Off(0.01),
        Point::Off(2e-5),
        Point::Off(-2e-5),
        Point::At(f64::NAN),
        Point::At(f64::INFINITY),
        Point::At(f64::NEG_INFINITY),
    ] {
        calls.push(Call::DoStep(point, 1e-5));
    }
    for number in strange {
        calls.push(Call::SetupExperiment(None, number, None));
        calls.push(Call::SetupExperiment(Some(number), 0.0, Some(number)));
    }
    calls
}

/// A call in the phase. Whatever it is, after an error no more values can be set, and the instance can be reset, up to a first step.
fn call_in(judge: &mut Judge, phase: Phase, call: &Call, fault: Fault) -> Result<(), String> {
    judge.call_with(call, fault)?;
    judge.run(&[Call::set_reals(vec![(DESCRIPTION.reference("base.acceleration"), 1.0)]), Call::SetState(2)])?;
    if !has_started(phase) {
        bring(judge, Phase::StepComplete)?;
    }
    bring(judge, phase)
}

#[test]
fn every_call_in_every_state_gets_the_answer_of_the_standard() {
    let mut met = BTreeSet::new();
    for phase in Phase::ALL {
        let mut judge = Judge::new(&LIBRARY);
        bring(&mut judge, phase).unwrap();
        let wrong = wrong_numbers().into_iter().map(|call| (call, Fault::None));
        for (call, fault) in faulty_calls().chain(wrong) {
            assert_eq!(judge.life.now.phase, phase);
            call_in(&mut judge, phase, &call, fault)
                .unwrap_or_else(|failure| panic!("{call:?} ({fault:?}): {failure}"));
        }
        met.extend(judge.met);
    }
    for function in functions() {
        assert!(met.contains(function), "{function} was not called");
    }
}

#[test]
fn the_description_promises_the_derivatives_that_are_offered() {
    for promise in ["canInterpolateInputs=\"true\"", "maxOutputDerivativeOrder=\"1\""] {
        assert!(MODEL_DESCRIPTION.contains(promise), "{promise}");
    }
    assert!(!MODEL_DESCRIPTION.contains("providesDirectionalDerivative=\"true\""));
}

#[test]
fn what_is_no_instance_is_refused_by_every_function_and_left_alone() {
    let mut memory = [0x5a5a_5a5a_5a5a_5a5a_u64; 64];
    let foreign: fmi2Component = memory.as_mut_ptr().cast();
    for component in [ptr::null_mut(), foreign, foreign.wrapping_byte_add(1)] {
        for (call, fault) in faulty_calls() {
            // Renew creates an instance; its other half, freeing, is tested below.
            if call == Call::Renew {
                continue;
            }
            let mut importer = Importer::new(&LIBRARY);
            let own = std::mem::replace(&mut importer.component, component);
            assert_eq!(importer.make(&call, fault, 0.0).0, fmi2Error, "{call:?} ({fault:?})");
            importer.component = own;
        }
        unsafe { (LIBRARY.fmi2FreeInstance)(component) };
    }
    assert_eq!(memory, [0x5a5a_5a5a_5a5a_5a5a; 64]);
}
