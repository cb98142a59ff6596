//! Every function in every state, with right and with wrong arguments.

use std::collections::BTreeSet;
use std::ptr;

use campaign::call::{Call, Damage, Fault, Point, StatusFunction};
use campaign::description::{DESCRIPTION, Kind, Role};
use campaign::importer::Importer;
use campaign::judge::Judge;
use campaign::phase::{Phase, allowed};
use relay_contact::fmi2::states::{State, TABLE};
use relay_contact::fmi2::*;

use crate::library::LIBRARY;

const PHASES: [Phase; 5] = [
    Phase::Instantiated,
    Phase::InitializationMode,
    Phase::StepComplete,
    Phase::Terminated,
    Phase::Error,
];

const STATUS_FUNCTIONS: [StatusFunction; 5] = [
    StatusFunction::Status,
    StatusFunction::Real,
    StatusFunction::Integer,
    StatusFunction::Boolean,
    StatusFunction::String,
];

/// An instance in the phase, with a saved state and its bytes in the first slot.
fn in_phase(phase: Phase) -> Judge<'static> {
    let mut judge = Judge::new(&LIBRARY);
    let save = [
        Call::GetState {
            slot: 0,
            fault: Fault::None,
        },
        Call::Serialize {
            slot: 0,
            fault: Fault::None,
        },
    ];
    let more: &[Call] = match phase {
        Phase::Instantiated => &[],
        Phase::InitializationMode => &[Call::EnterInitializationMode],
        Phase::StepComplete => &[
            Call::EnterInitializationMode,
            Call::ExitInitializationMode,
            Call::step(1e-5),
        ],
        Phase::Terminated => &[
            Call::EnterInitializationMode,
            Call::ExitInitializationMode,
            Call::Terminate,
        ],
        Phase::Error => &[
            Call::EnterInitializationMode,
            Call::ExitInitializationMode,
            Call::step(-1.0),
        ],
    };
    for call in save.iter().chain(more) {
        judge.call(call).unwrap();
    }
    assert_eq!(judge.life.now.phase, phase);
    judge
}

/// Every function with arguments that are right, and with each fault.
fn calls() -> Vec<Call> {
    let mut calls = vec![
        Call::SetupExperiment {
            tolerance: Some(1e-6),
            start: 0.0,
            stop: Some(1.0),
        },
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
        Call::Terminate,
        Call::Reset,
        Call::Renew,
        Call::DirectionalDerivative,
        Call::CancelStep,
        Call::step(1e-5),
    ];
    let input = DESCRIPTION.reference("base.acceleration");
    let force = DESCRIPTION.reference("contact.force");
    for fault in [Fault::None].into_iter().chain(Fault::ALL) {
        for kind in [Kind::Real, Kind::Integer, Kind::Boolean, Kind::String] {
            let some: Vec<_> = DESCRIPTION
                .variables
                .iter()
                .filter(|variable| variable.kind == kind)
                .collect();
            let references: Vec<_> = some.iter().map(|variable| variable.reference).take(1).collect();
            let settable = some.iter().find(|variable| variable.role != Role::Output);
            let values: Vec<_> = settable
                .iter()
                .map(|variable| (variable.reference, variable.start))
                .collect();
            for count in [0, 1] {
                calls.push(Call::Get {
                    kind,
                    references: references[..count.min(references.len())].to_vec(),
                    fault,
                });
                calls.push(Call::Set {
                    kind,
                    values: values[..count.min(values.len())].to_vec(),
                    fault,
                });
            }
        }
        for slot in [0, 1] {
            calls.push(Call::GetState { slot, fault });
            calls.push(Call::SetState { slot, fault });
            calls.push(Call::FreeState { slot, fault });
            calls.push(Call::StateSize { slot, fault });
            calls.push(Call::Serialize { slot, fault });
            for damage in [Damage::None, Damage::Flip(500), Damage::Cut(60), Damage::Longer(0)] {
                calls.push(Call::Deserialize { slot, damage, fault });
            }
        }
        for function in STATUS_FUNCTIONS {
            for kind in [0, 1, 2, 3, 4, u32::MAX] {
                calls.push(Call::Status { function, kind, fault });
            }
        }
        for known in ["logStatusError", "logEverything"] {
            let categories = vec![Some(known.to_owned())];
            calls.push(Call::SetDebugLogging {
                on: true,
                categories,
                fault,
            });
        }
        calls.push(Call::SetDebugLogging {
            on: true,
            categories: vec![None],
            fault,
        });
        calls.push(Call::SetDebugLogging {
            on: false,
            categories: vec![],
            fault,
        });
        calls.push(Call::SetInputDerivatives {
            values: vec![(input, 1, 3.0)],
            fault,
        });
        calls.push(Call::GetOutputDerivatives {
            values: vec![(force, 1)],
            fault,
        });
    }
    calls
}

/// Wrong values, references and instants.
fn wrong_numbers() -> Vec<Call> {
    let mut calls = Vec::new();
    let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e307, -1e307];
    for variable in &DESCRIPTION.variables {
        for kind in [Kind::Real, Kind::Integer, Kind::Boolean, Kind::String] {
            calls.push(Call::get(kind, vec![variable.reference]));
            let near = [variable.min, variable.max, variable.min - 1.0, variable.max + 1.0];
            // The value matters where the function suits the variable.
            let count = if kind == variable.kind {
                strange.len() + near.len()
            } else {
                1
            };
            for value in strange.iter().chain(&near).take(count) {
                calls.push(Call::Set {
                    kind,
                    values: vec![(variable.reference, *value)],
                    fault: Fault::None,
                });
            }
        }
        calls.push(Call::SetInputDerivatives {
            values: vec![(variable.reference, 1, 0.0)],
            fault: Fault::None,
        });
        calls.push(Call::GetOutputDerivatives {
            values: vec![(variable.reference, 1)],
            fault: Fault::None,
        });
    }
    for reference in [3, 99, 9999, u32::MAX] {
        calls.push(Call::get(Kind::Real, vec![reference]));
        calls.push(Call::set_reals(vec![(reference, 0.0)]));
    }
    let (input, force) = (
        DESCRIPTION.reference("base.acceleration"),
        DESCRIPTION.reference("contact.force"),
    );
    for (order, value) in [(0, 0.0), (2, 0.0), (-1, 0.0), (1, f64::NAN), (1, f64::INFINITY)] {
        calls.push(Call::SetInputDerivatives {
            values: vec![(input, order, value)],
            fault: Fault::None,
        });
        calls.push(Call::GetOutputDerivatives {
            values: vec![(force, order)],
            fault: Fault::None,
        });
    }
    for size in [0.0, -0.0, -1e-5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324] {
        calls.push(Call::step(size));
    }
    for point in [
        Point::Off(-1.0),
        Point::Off(1.0),
        Point::Off(0.01),
        Point::At(f64::NAN),
        Point::At(f64::INFINITY),
    ] {
        calls.push(Call::DoStep { point, size: 1e-5 });
    }
    for number in strange {
        calls.push(Call::SetupExperiment {
            tolerance: None,
            start: number,
            stop: None,
        });
        calls.push(Call::SetupExperiment {
            tolerance: Some(number),
            start: 0.0,
            stop: Some(number),
        });
    }
    calls
}

#[test]
fn every_call_in_every_state_gets_the_answer_of_the_standard() {
    let mut met = BTreeSet::new();
    for phase in PHASES {
        for call in calls().iter().chain(&wrong_numbers()) {
            let mut judge = in_phase(phase);
            judge.call(call).unwrap();
            met.extend(judge.met.iter().map(|(function, _)| *function));
            // Whatever it was, the way out is open.
            judge
                .call(&Call::SetState {
                    slot: 2,
                    fault: Fault::None,
                })
                .unwrap();
            for call in [
                Call::Reset,
                Call::EnterInitializationMode,
                Call::ExitInitializationMode,
                Call::step(1e-5),
            ] {
                judge.call(&call).unwrap();
            }
        }
    }
    for function in TABLE {
        assert!(met.contains(function.name), "{} was not called", function.name);
    }
}

#[test]
fn the_components_own_table_says_what_the_standards_says() {
    let state = |phase| match phase {
        Phase::Instantiated => State::Instantiated,
        Phase::InitializationMode => State::InitializationMode,
        Phase::StepComplete => State::StepComplete,
        Phase::Terminated => State::Terminated,
        Phase::Error => State::Error,
    };
    for function in TABLE {
        for phase in PHASES {
            let own = function.allowed.contains(&state(phase));
            assert_eq!(own, allowed(function.name, phase), "{} in {phase:?}", function.name);
        }
    }
}

#[test]
fn what_is_no_instance_is_refused_by_every_function_and_left_alone() {
    let mut memory = [0x5a5a_5a5a_5a5a_5a5a_u64; 64];
    let foreign: fmi2Component = memory.as_mut_ptr().cast();
    for component in [ptr::null_mut(), foreign, foreign.wrapping_byte_add(1)] {
        for call in calls() {
            // Renew makes an instance; its half that frees is below.
            if call == Call::Renew {
                continue;
            }
            let mut importer = Importer::new(&LIBRARY);
            let own = std::mem::replace(&mut importer.component, component);
            assert_eq!(importer.make(&call, 0.0).0, fmi2Error, "{call:?}");
            importer.component = own;
        }
        unsafe { (LIBRARY.fmi2FreeInstance)(component) };
    }
    assert_eq!(memory, [0x5a5a_5a5a_5a5a_5a5a; 64]);
}

#[test]
fn a_step_past_the_stop_time_a_second_end_and_a_call_after_a_failed_step_are_errors() {
    let start = [
        Call::SetupExperiment {
            tolerance: None,
            start: 1.0,
            stop: Some(1.0 + 2e-5),
        },
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
        Call::step(1e-5),
    ];
    let reset_and_run = [
        Call::Reset,
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
        Call::step(1e-5),
    ];
    let cases: [&[Call]; 4] = [
        &[
            Call::step(2e-5),
            Call::step(1e-5),
            Call::get(Kind::Real, DESCRIPTION.outputs(Kind::Real)),
        ],
        &[Call::step(1e-5), Call::step(1e-9), Call::set_reals(vec![(0, 1.0)])],
        &[Call::Terminate, Call::Terminate, Call::step(1e-5)],
        &[
            Call::DoStep {
                point: Point::Off(-1.0),
                size: 1e-5,
            },
            Call::step(1e-5),
            Call::Terminate,
        ],
    ];
    for case in cases {
        let mut judge = Judge::new(&LIBRARY);
        for call in start.iter().chain(case) {
            judge.call(call).unwrap();
        }
        assert_eq!(judge.life.now.phase, Phase::Error, "{case:?}");
        for call in &reset_and_run {
            judge.call(call).unwrap();
        }
        assert_eq!(judge.life.now.phase, Phase::StepComplete);
    }
}
