//! Saved states: what is restored goes on bit by bit as it did before.

use relay_contact::fmi2::*;
use relay_contact::variables::PusherKind;
use testing::instance::{Instance, vr};
use testing::kinds::{KINDS, Kind};

use super::logging::choose;

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
    let outputs = OUTPUTS.map(vr);
    (start..start + count)
        .map(|k| {
            assert_eq!(fmu.set_real("base.acceleration", f64::from(k / 37)), fmi2OK);
            assert_eq!(fmu.set_real("contact.current", 1e-3 * f64::from(k)), fmi2OK);
            // Where errors may have grown beyond the tolerance, a warning says so.
            assert_eq!(fmu.step(f64::from(k) * size, size), fmi2OK);
            fmu.reals_of(outputs).map(f64::to_bits)
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
    let relays = KINDS.into_iter().flat_map(|kind| (0..4).filter_map(move |number| of_kind(kind, number)));
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

/// Contents that a faulty writer has signed: an input or an instant that is no number, or is to come.
#[test]
fn a_state_that_no_simulation_reaches_is_refused_though_its_checksum_is_right() {
    let fmu = shaken(450.0);
    trace(&fmu, 0, 300, 1e-5);
    let bytes: Vec<u8> = fmu.to_bytes(fmu.save()).into_iter().flat_map(fmi2Byte::to_ne_bytes).collect();
    let (signed, _) = bytes.split_at(bytes.len() - 4);
    for (output, wrong) in
        [("contact.current", f64::NAN), ("contact.lastOpening", f64::INFINITY), ("contact.lastClosing", 1.0)]
    {
        let written = fmu.real(output).to_le_bytes();
        let places: Vec<_> = (0..signed.len() - 8).filter(|at| signed[*at..].starts_with(&written)).collect();
        assert!(!places.is_empty(), "{output}");
        for at in places {
            let mut changed = signed.to_vec();
            changed[at..at + 8].copy_from_slice(&wrong.to_le_bytes());
            changed.extend(crc32fast::hash(&changed).to_le_bytes());
            let changed: Vec<_> = changed.into_iter().map(|byte| fmi2Byte::from_ne_bytes([byte])).collect();
            let (status, made) = fmu.from_bytes(&changed);
            assert!(status == fmi2Error && made.is_null(), "{output} at {at}");
            fmu.expect_message(fmi2Error, &["serializedState", "no simulation can reach"]);
        }
    }
}

/// A relay whose coil current jumps, at a point that is off, with a derivative that has no effect, and whose tolerance is not kept: the
/// bits of its outputs, and what is said.
fn dropped(fmu: &Instance) -> (Vec<[u64; 12]>, Vec<String>) {
    fmu.shake(600.0);
    assert_eq!(fmu.set_integer("effects.pusher", PusherKind::Armature as i32), fmi2OK);
    assert_eq!(fmu.set_boolean("effects.contactDamping", false), fmi2OK);
    assert_eq!(fmu.set_reals(["contact.overtravel", "beam.stiffnessDamping"], [-5e-5, 3e-7]), fmi2OK);
    assert_eq!(fmu.set_integer("solver.modes", 8), fmi2OK);
    fmu.initialize();
    assert_eq!(fmu.set_rates(["base.acceleration"], [2], [1.0]), fmi2OK);
    let rows = (0..20).map(|k| {
        let current = if (5..12).contains(&k) { 0.0 } else { 1.0 };
        assert_eq!(fmu.set_real("coil.relativeCurrent", current), fmi2OK);
        let off = if k == 3 { 1e-8 } else { 0.0 };
        assert_eq!(fmu.step(f64::from(k) * 1e-3 + off, 1e-3 - off), fmi2OK);
        OUTPUTS.map(|name| fmu.real(name).to_bits())
    });
    let rows = rows.collect();
    (rows, fmu.messages().into_iter().map(|message| message.text).collect())
}

#[test]
fn after_a_reset_a_relay_drops_and_warns_as_a_new_one() {
    let fmu = Instance::new();
    let untouched = fmu.save();
    let (rows, told) = dropped(&fmu);
    assert!(rows[4][10] != rows[11][10] && told.len() == 3, "{told:?}");
    assert_eq!(fmu.reset(), fmi2OK);
    // Nothing is left of an experiment either, nor of the messages asked for.
    assert_eq!(fmu.setup(Some(1e-2), 1.0, Some(2.0)), fmi2OK);
    assert_eq!(choose(&fmu, fmi2True, &[]), fmi2OK);
    assert_eq!(fmu.reset(), fmi2OK);
    assert_eq!(dropped(&fmu), (rows.clone(), told.clone()));
    // With the current off, of which a state before the start knows nothing.
    assert_eq!(fmu.set_real("coil.relativeCurrent", 0.0), fmi2OK);
    assert_eq!(fmu.step(20e-3, 1e-3), fmi2OK);
    assert_eq!(fmu.restore(untouched), fmi2OK);
    let (again, repeated) = dropped(&fmu);
    assert_eq!(again, rows);
    // That the tolerance is not kept belongs to a run, the others to what the importer does.
    assert_eq!(repeated, told[1..2]);
}
