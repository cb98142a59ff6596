//! Instances: failed instantiation, many at once, many threads.

use std::ffi::CStr;

use campaign::api::{Api, LIBRARY};
use campaign::call::Call;
use campaign::description::DESCRIPTION;
use campaign::judge::Judge;
use relay_contact::fmi2::*;
use testing::instance::Arguments;
use testing::log::{Log, Message, callbacks};

#[test]
fn the_library_is_the_one_of_this_build() {
    let text = |text| unsafe { CStr::from_ptr(text) };
    assert_eq!(text(unsafe { (LIBRARY.fmi2GetVersion)() }), c"2.0");
    assert_eq!(text(unsafe { (LIBRARY.fmi2GetTypesPlatform)() }), c"default");
    // Same description and bitwise the same results: this excludes a file of another build.
    assert!(
        run(&LIBRARY, 0) == run(&Api::linked(), 0),
        "the library file gives other results than the library linked into this test: it is from another build"
    );
}

#[test]
fn a_wrong_guid_type_name_or_no_callbacks_make_no_instance() {
    let right = Arguments::default();
    let guid = |guid| Arguments { guid, ..right };
    let kind = |kind| Arguments { kind, ..right };
    let name = |name| Arguments { name, ..right };
    for (wrong, parts) in [
        (guid(Some("{1234}")), ["fmuGUID = {1234}", &DESCRIPTION.guid]),
        (guid(Some("")), ["fmuGUID", &DESCRIPTION.guid]),
        (guid(None), ["fmuGUID", "null"]),
        (kind(fmi2ModelExchange), ["fmuType = 0", "fmi2CoSimulation"]),
        (kind(77), ["fmuType = 77", "fmi2CoSimulation"]),
        (name(Some("")), ["instanceName", ""]),
        (name(None), ["instanceName", ""]),
    ] {
        let log = Log::default();
        let function = LIBRARY.fmi2Instantiate;
        assert!(wrong.instantiate(function, Some(&callbacks(&log))).is_null());
        let messages = log.into_inner().unwrap();
        let told = |message: &Message| {
            let error = message.status == fmi2Error && message.category == "logStatusError";
            error && parts.iter().all(|part| message.text.contains(part))
        };
        assert!(matches!(&messages[..], [message] if told(message)), "{wrong:?}: {messages:?}");
    }
    assert!(right.instantiate(LIBRARY.fmi2Instantiate, None).is_null());
}

/// The bits of all real outputs over a run in which the contact opens; the run depends on the number.
fn run(api: &Api, number: u32) -> Vec<u64> {
    let mut judge = Judge::new(api);
    let mut bits = Vec::new();
    judge.run(&Call::shaken(400.0 + f64::from(number))).unwrap();
    for k in 0..80 {
        let input = (DESCRIPTION.reference("base.acceleration"), f64::from(k % 7));
        judge.run(&[Call::set_reals(vec![input]), Call::step(1.7e-5)]).unwrap();
        bits.extend(judge.life.now.outputs.iter().flatten());
    }
    bits
}

#[test]
fn eight_threads_with_an_instance_each_get_the_bits_of_a_single_one() {
    let alone: Vec<_> = (0..8).map(|number| run(&LIBRARY, number)).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|number| scope.spawn(move || run(&LIBRARY, number))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(alone == together, "results depend on other threads");
    assert_ne!(alone[0], alone[1]);
}

#[test]
fn thousands_of_instances_live_at_once() {
    let mut judges: Vec<_> = (0..2000).map(|_| Judge::new(&LIBRARY)).collect();
    for judge in &mut judges {
        judge.run(&Call::INITIALISE).unwrap();
    }
    let input = DESCRIPTION.reference("base.acceleration");
    for (number, judge) in judges.iter_mut().enumerate() {
        let push = Call::set_reals(vec![(input, (number % 2) as f64 * 50.0)]);
        judge.run(&[push, Call::step(1e-4)]).unwrap();
    }
    let force = |judge: &Judge| judge.life.now.outputs.clone();
    let (pushed, left) = (force(&judges[1]), force(&judges[0]));
    assert_ne!(pushed, left);
    for (number, judge) in judges.iter().enumerate() {
        assert_eq!(&force(judge), if number % 2 == 1 { &pushed } else { &left }, "instance {number}");
    }
}
