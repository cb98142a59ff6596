//! Messages to the importer.

use std::ffi::CStr;
use std::ptr;
use std::sync::atomic::{AtomicU32, Ordering};

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::fmi2::*;
use testing::instance::{Arguments, Instance};
use testing::log::calling;

pub fn choose(fmu: &Instance, on: fmi2Boolean, categories: &[&CStr]) -> fmi2Status {
    let pointers: Vec<_> = categories.iter().map(|category| category.as_ptr()).collect();
    unsafe { fmi2SetDebugLogging(fmu.component, on, pointers.len(), pointers.as_ptr()) }
}

#[test]
fn the_categories_are_those_of_the_description() {
    for category in Category::ALL.map(Category::name) {
        assert!(MODEL_DESCRIPTION.contains(&format!("<Category name=\"{}\"", category.to_str().unwrap())));
    }
    assert_eq!(MODEL_DESCRIPTION.matches("<Category ").count(), Category::ALL.len());
}

#[test]
fn an_unknown_category_is_a_warning_that_changes_nothing() {
    let fmu = Instance::new();
    // Without categories it leaves what is always told.
    assert_eq!(choose(&fmu, fmi2False, &[]), fmi2OK);
    let unknown = c"log%s#r103#All";
    assert_eq!(choose(&fmu, fmi2False, &[c"logStatusError", unknown]), fmi2OK);
    // What was chosen to be silent stays so.
    assert_eq!(choose(&fmu, fmi2False, &[c"logStatusWarning"]), fmi2OK);
    assert_eq!(choose(&fmu, fmi2False, &[]), fmi2OK);
    assert_eq!(choose(&fmu, fmi2False, &[unknown]), fmi2OK);
    // As a printf format this reads "log%s##r103##All", and there "##" stands for "#", "#r103#" for a variable.
    fmu.expect_message(
        fmi2Warning,
        &["fmi2SetDebugLogging", "log%%s##r103##All", "logStatusError, logStatusWarning, logEvents and logSolver"],
    );
}

/// Arguments of `fmi2SetDebugLogging`.
type Choice<'a> = (fmi2Boolean, &'a [&'a CStr]);

/// Messages of events and of the solver in a run in which the contact opens at 0.7088 ms, as `choices` have it.
fn debug_messages(logging_on: bool, choices: &[Choice]) -> [Vec<String>; 2] {
    let fmu = Instance::with(&Arguments { logging_on, ..Arguments::default() });
    for (on, categories) in choices {
        assert_eq!(choose(&fmu, *on, categories), fmi2OK);
    }
    fmu.shake(400.0);
    assert_eq!(fmu.set_integer("effects.axialForce", 2), fmi2OK);
    fmu.initialize();
    for k in 0..3 {
        assert_eq!(fmu.step(f64::from(k) * 5e-4, 5e-4), fmi2OK);
    }
    let messages = fmu.messages();
    assert!(messages.iter().all(|message| message.status == fmi2OK), "{messages:?}");
    ["logEvents", "logSolver"].map(|category| {
        let told = messages.iter().filter(|message| message.category == category);
        told.map(|message| message.text.clone()).collect()
    })
}

#[test]
fn openings_and_closings_are_logged_with_their_instants() {
    let [events, solver] = debug_messages(false, &[(fmi2True, &[])]);
    // Instants of the specimen at 400 m/s2 and 1 kHz without axial force, converged by two methods.
    let expected = [("opens", 708.827_593e-6), ("closes", 1_089.427_605e-6)];
    assert_eq!(events.len(), expected.len(), "{events:?}");
    for (text, (verb, instant)) in events.iter().zip(expected) {
        assert!(text.starts_with(&format!("fmi2DoStep: the contact {verb} at ")), "{text}");
        let told: f64 = text.split(' ').rev().nth(1).unwrap().parse().unwrap();
        assert!((told - instant).abs() < 1e-9, "{text}");
    }
    assert!(solver[0].contains("modes"), "{solver:?}");
    assert_eq!(solver.len(), 1 + 3, "{solver:?}");
}

#[test]
fn debug_messages_are_off_unless_asked_for() {
    let [both, none] = [[true, true], [false, false]];
    let (events, solver) = (c"logEvents", c"logSolver");
    let cases: [(bool, &[Choice], [bool; 2]); 8] = [
        (false, &[], none),
        (false, &[(fmi2False, &[events])], none),
        (true, &[], [true, false]),
        (false, &[(fmi2True, &[])], both),
        (true, &[(fmi2False, &[])], none),
        (false, &[(fmi2True, &[events])], [true, false]),
        (false, &[(fmi2True, &[]), (fmi2False, &[events])], [false, true]),
        (true, &[(fmi2True, &[solver])], [false, true]),
    ];
    for (on, choices, expected) in cases {
        let heard = debug_messages(on, choices).map(|messages| !messages.is_empty());
        assert_eq!(heard, expected, "{on} {choices:?}");
    }
}

#[test]
fn it_is_told_from_when_on_events_are_too_many_to_be_told() {
    let told = |size: f64, count: u32| {
        let fmu = Instance::with(&Arguments { logging_on: true, ..Arguments::default() });
        fmu.shake(400.0);
        fmu.initialize();
        for k in 0..count {
            assert_eq!(fmu.step(f64::from(k) * size, size), fmi2OK);
        }
        fmu.messages().into_iter().map(|message| message.text).collect::<Vec<_>>()
    };
    let instant = |text: &str| text.split(' ').rev().nth(1).and_then(|time| time.parse::<f64>().ok()).unwrap();
    let (all, some) = (told(1e-3, 550), told(0.55, 1));
    assert!(all.len() > 1024 && some.len() == 1024 + 1, "{} {}", all.len(), some.len());
    let left_out = some[1024].split(' ').find_map(|word| word.parse::<f64>().ok()).unwrap();
    assert!((left_out - instant(&all[1024])).abs() < 1e-9, "{} {}", some[1024], all[1024]);
    // As many as are kept, and the next is ahead of the end of the step.
    let just = told(instant(&all[1023]) + 1e-9, 1);
    assert_eq!(just.len(), 1024);
    // Those of the next step begin anew.
    assert_eq!(told(0.55, 2).len(), 2 * (1024 + 1));
}

/// Warnings of a shaken specimen with this damping of the spring (s) and number of modes over 20 ms.
fn warnings(damping: f64, modes: i32) -> Vec<String> {
    let fmu = Instance::new();
    fmu.shake(600.0);
    assert_eq!(fmu.set_boolean("effects.contactDamping", false), fmi2OK);
    assert_eq!(fmu.set_real("beam.stiffnessDamping", damping), fmi2OK);
    assert_eq!(fmu.set_integer("solver.modes", modes), fmi2OK);
    fmu.initialize();
    for k in 0..20 {
        assert_eq!(fmu.step(f64::from(k) * 1e-3, 1e-3), fmi2OK);
    }
    // Thirty times the tolerance.
    let announced = fmu.real("solver.forceError") > 3e-5;
    let messages = fmu.messages();
    assert!(messages.iter().all(|message| message.status == fmi2Warning), "{messages:?}");
    let told: Vec<_> = messages.into_iter().map(|message| message.text).collect();
    assert_eq!(announced, !told.is_empty(), "{told:?}");
    told
}

#[test]
fn a_tolerance_that_may_not_be_kept_is_announced_once() {
    let none = warnings(80.63e-6, 0);
    assert!(none.is_empty(), "{none:?}");
    let step = |text: &String| text.starts_with("fmi2DoStep: at 0.0") && text.contains("solver.forceError");
    let light = warnings(3e-7, 0);
    assert!(light.len() == 1 && light.iter().all(step), "{light:?}");
    let few = warnings(80.63e-6, 8);
    assert!(few.len() == 1 && few[0].contains("8 modes are too few"), "{few:?}");
}

static STATUS_INSIDE: AtomicU32 = AtomicU32::new(fmi2OK);

/// Calls back into the instance it hears from, whose address the environment holds; the standard forbids that.
unsafe extern "C" fn meddle(
    environment: fmi2ComponentEnvironment,
    _: fmi2String,
    _: fmi2Status,
    _: fmi2String,
    _: fmi2String,
) {
    let component = unsafe { *environment.cast::<fmi2Component>() };
    if !component.is_null() {
        STATUS_INSIDE.store(unsafe { fmi2Reset(component) }, Ordering::SeqCst);
        unsafe { fmi2FreeInstance(component) };
    }
}

#[test]
fn a_logger_that_calls_back_is_refused_and_harms_nothing() {
    let mut component: fmi2Component = ptr::null_mut();
    let place = &raw mut component;
    let callbacks = calling(Some(meddle), None, place.cast());
    let logging = Arguments { logging_on: true, ..Arguments::default() };
    let made = logging.instantiate(fmi2Instantiate, Some(&callbacks));
    unsafe {
        place.write(made);
        assert_eq!(fmi2DoStep(made, 0.0, 1.0, 1), fmi2Error);
        assert_eq!(STATUS_INSIDE.load(Ordering::SeqCst), fmi2Error);
        assert_eq!(fmi2Reset(made), fmi2OK);
        fmi2FreeInstance(made);
    }
}

/// `stepFinished` of an importer that waits for it: keeps the time that it reads, as the step is done.
unsafe extern "C" fn finished(environment: fmi2ComponentEnvironment, status: fmi2Status) {
    let (component, times) = unsafe { &mut *environment.cast::<(fmi2Component, Vec<f64>)>() };
    let mut time = f64::NAN;
    assert_eq!(status, fmi2OK);
    assert_eq!(unsafe { fmi2GetRealStatus(*component, fmi2LastSuccessfulTime, &raw mut time) }, fmi2OK);
    times.push(time);
}

#[test]
fn an_importer_that_waits_for_the_end_of_a_step_is_told_of_it() {
    let mut kept: (fmi2Component, Vec<f64>) = (ptr::null_mut(), Vec::new());
    let place = &raw mut kept;
    let callbacks = calling(None, Some(finished), place.cast());
    let made = Arguments::default().instantiate(fmi2Instantiate, Some(&callbacks));
    unsafe {
        (*place).0 = made;
        assert_eq!(fmi2EnterInitializationMode(made), fmi2OK);
        assert_eq!(fmi2ExitInitializationMode(made), fmi2OK);
        for k in 0..3 {
            assert_eq!(fmi2DoStep(made, f64::from(k), 1.0, 1), fmi2OK);
        }
        // None is done.
        assert_eq!(fmi2DoStep(made, 7.0, 1.0, 1), fmi2Error);
        assert_eq!(fmi2DoStep(made, 3.0, 1.0, 1), fmi2Error);
        fmi2FreeInstance(made);
        assert_eq!((*place).1, [1.0, 2.0, 3.0]);
    }
}
