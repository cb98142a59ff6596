//! Instances: what makes none, many at once, many threads.

use std::ffi::CStr;

use campaign::api::Api;
use campaign::call::{Call, Fault};
use campaign::description::{DESCRIPTION, Kind};
use campaign::importer::instantiate;
use campaign::judge::Judge;
use campaign::log::Log;
use relay_contact::fmi2::*;

use crate::library::LIBRARY;

#[test]
fn the_library_is_the_one_of_this_build() {
    let text = |text| unsafe { CStr::from_ptr(text) };
    assert_eq!(text(unsafe { (LIBRARY.fmi2GetVersion)() }), c"2.0");
    assert_eq!(text(unsafe { (LIBRARY.fmi2GetTypesPlatform)() }), c"default");
    // Same description, same results to the last bit: an old file would have to be very lucky.
    assert!(
        run(&LIBRARY, 0) == run(&Api::linked(), 0),
        "the library file gives other results than the library linked into this test: it is of another build"
    );
}

#[test]
fn a_wrong_guid_type_name_or_no_callbacks_make_no_instance() {
    let guid = DESCRIPTION.guid.as_str();
    let cases = [
        (
            Some("relay"),
            fmi2CoSimulation,
            Some("{00000000000000000000000000000000}"),
        ),
        (Some("relay"), fmi2CoSimulation, Some("")),
        (Some("relay"), fmi2CoSimulation, None),
        (Some("relay"), fmi2ModelExchange, Some(guid)),
        (Some("relay"), 77, Some(guid)),
        (Some(""), fmi2CoSimulation, Some(guid)),
        (None, fmi2CoSimulation, Some(guid)),
    ];
    for (name, kind, guid) in cases {
        let log = Log::default();
        assert!(instantiate(&LIBRARY, name, kind, guid, Some(&log)).is_null());
        let messages = log.into_inner().unwrap();
        assert!(
            matches!(&messages[..], [message] if message.status == fmi2Error),
            "{messages:?}"
        );
    }
    assert!(instantiate(&LIBRARY, Some("relay"), fmi2CoSimulation, Some(guid), None).is_null());
}

/// The bits of all real outputs over a run in which the contact opens; each number its own run.
fn run(api: &Api, number: u32) -> Vec<u64> {
    let mut judge = Judge::new(api);
    let reference = |name| DESCRIPTION.reference(name);
    let excitation = Call::Set {
        kind: Kind::Integer,
        values: vec![(reference("effects.excitation"), 2.0)],
        fault: Fault::None,
    };
    let amplitude = 400.0 + f64::from(number);
    let parameters = Call::set_reals(vec![(reference("excitation.amplitude"), amplitude)]);
    let mut bits = Vec::new();
    for call in [
        excitation,
        parameters,
        Call::EnterInitializationMode,
        Call::ExitInitializationMode,
    ] {
        judge.call(&call).unwrap();
    }
    for k in 0..200 {
        let input = (reference("base.acceleration"), f64::from(k % 7));
        judge.call(&Call::set_reals(vec![input])).unwrap();
        judge.call(&Call::step(1.7e-5)).unwrap();
        bits.extend(judge.life.now.outputs.iter().flatten());
    }
    bits
}

#[test]
fn eight_threads_with_an_instance_each_get_the_bits_of_a_single_one() {
    let alone: Vec<_> = (0..8).map(|number| run(&LIBRARY, number)).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|number| scope.spawn(move || run(&LIBRARY, number)))
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(alone == together, "results depend on what other threads do");
    assert_ne!(alone[0], alone[1]);
}

#[test]
fn thousands_of_instances_live_at_once() {
    let mut judges: Vec<_> = (0..2000).map(|_| Judge::new(&LIBRARY)).collect();
    for judge in &mut judges {
        for call in [Call::EnterInitializationMode, Call::ExitInitializationMode] {
            judge.call(&call).unwrap();
        }
    }
    let input = DESCRIPTION.reference("base.acceleration");
    for (number, judge) in judges.iter_mut().enumerate() {
        judge
            .call(&Call::set_reals(vec![(input, (number % 2) as f64 * 50.0)]))
            .unwrap();
        judge.call(&Call::step(1e-4)).unwrap();
    }
    let force = |judge: &Judge| judge.life.now.outputs.clone();
    let (pushed, left) = (force(&judges[1]), force(&judges[0]));
    assert_ne!(pushed, left);
    for (number, judge) in judges.iter().enumerate() {
        assert_eq!(
            &force(judge),
            if number % 2 == 1 { &pushed } else { &left },
            "instance {number}"
        );
    }
}
