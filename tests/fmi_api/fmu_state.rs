//! Saved states: what is restored goes on bit by bit as it did before.

use relay_contact::fmi2::*;
use testing::instance::Instance;
use testing::kinds::{KINDS, Kind};

/// Shaken with this amplitude (m/s2): the contact opens.
fn shaken(amplitude: f64) -> Instance {
    let fmu = Instance::new();
    fmu.shake(amplitude);
    assert_eq!(fmu.set_boolean("effects.energy", true), fmi2OK);
    fmu.initialize();
    fmu
}

const OUTPUTS: [&str; 12] = [
    "contact.force",
    "contact.indentation",
    "tip.velocity",
    "contact.voltage",
    "contact.lastOpening",
    "contact.lastClosing",
    "contact.slip",
    "second.force",
    "parallel.force",
    "pusher.force",
    "armature.displacement",
    "energy.balance",
];

/// The bits of the outputs over `count` steps of `size` seconds from `start` on, with inputs that change now and then.
pub fn trace(fmu: &Instance, start: u32, count: u32, size: f64) -> Vec<[u64; 12]> {
    (start..start + count)
        .map(|k| {
            assert_eq!(fmu.set_real("base.acceleration", f64::from(k / 37)), fmi2OK);
            assert_eq!(fmu.set_real("contact.current", 1e-3 * f64::from(k)), fmi2OK);
            // Where errors may have grown beyond the tolerance, a warning says so.
            assert_eq!(fmu.step(f64::from(k) * size, size), fmi2OK);
            OUTPUTS.map(|name| fmu.real(name).to_bits())
        })
        .collect()
}

/// A random relay of this kind and number, in communication steps of this length (s), if no spring of it needs a file.
fn of_kind((_, _, draw): Kind, number: u64) -> Option<(Instance, f64)> {
    let relay = draw(number);
    let sprung = relay.scene.spring.is_some() || relay.scene.fixed_spring.is_some();
    (!sprung).then(|| {
        let fmu = Instance::new();
        fmu.set_scene(&relay.scene);
        assert_eq!(fmu.set_real("pusher.displacement", relay.pusher), fmi2OK);
        fmu.initialize();
        (fmu, relay.steps.0.min(1e-4))
    })
}

#[test]
fn every_state_goes_through_bytes() {
    let relays = KINDS
        .into_iter()
        .flat_map(|kind| (0..4).filter_map(move |number| of_kind(kind, number)));
    for (number, (fmu, size)) in relays.chain([(shaken(450.0), 1e-5)]).enumerate() {
        let other = Instance::new();
        for k in 0..500 {
            let state = fmu.save();
            let bytes = fmu.to_bytes(state);
            let (status, made) = other.from_bytes(&bytes);
            assert_eq!(status, fmi2OK, "scene {number}, step {k}");
            assert_eq!(other.to_bytes(made), bytes);
            if k % 50 == 0 {
                assert_eq!(other.restore(made), fmi2OK);
                let on = trace(&fmu, k, 60, size);
                assert_eq!(trace(&other, k, 60, size), on, "scene {number}, step {k}");
                assert_eq!(fmu.restore(state), fmi2OK);
            }
            fmu.free(state);
            other.free(made);
            trace(&fmu, k, 1, size);
        }
    }
}

#[test]
fn bytes_that_are_no_state_are_an_error_that_says_which() {
    let fmu = shaken(400.0);
    trace(&fmu, 0, 10, 1e-5);
    let state = fmu.save();
    let bytes = fmu.to_bytes(state);
    let expect = |bytes: &[fmi2Byte], reason: &str| {
        // A state may be read before initialization, which would take most of the time.
        let fmu = Instance::new();
        let (status, made) = fmu.from_bytes(bytes);
        assert_eq!(status, fmi2Error, "{reason}");
        assert!(made.is_null());
        fmu.expect_message(fmi2Error, &["fmi2DeSerializeFMUstate", "serializedState", reason]);
    };
    for length in 0..bytes.len() {
        expect(&bytes[..length], "before it is complete");
    }
    let longer = [&bytes[..], &[0; 3]].concat();
    expect(&longer, "3 bytes follow its end");
    let with = |at: usize, change: i8| {
        let mut bytes = bytes.clone();
        bytes[at] ^= fmi2Byte::from_ne_bytes(change.to_ne_bytes());
        bytes
    };
    expect(&with(2, 1), "not made by this component");
    expect(&with(8, 2), "its format is version 4, allowed is 6");
    expect(&with(20, 1), "belongs to the component");
    for at in 58..bytes.len() {
        expect(&with(at, 1), "checksum");
    }
    // The room has to be that of the state.
    let mut room = vec![0; bytes.len() + 1];
    let status = unsafe { fmi2SerializeFMUstate(fmu.component, state, room.as_mut_ptr(), room.len()) };
    assert_eq!(status, fmi2Error);
    fmu.expect_message(fmi2Error, &["fmi2SerializeFMUstate", "size", "not allowed"]);
    fmu.free(state);
}
