//! Saved states: what is restored goes on bit by bit as it did before.

use relay_contact::fmi2::*;
use testing::instance::Instance;

/// Shaken with this amplitude (m/s2): the contact opens.
fn shaken(amplitude: f64) -> Instance {
    let fmu = Instance::new();
    fmu.shake(amplitude);
    fmu.initialize();
    fmu
}

const OUTPUTS: [&str; 8] = [
    "contact.force",
    "contact.indentation",
    "tip.velocity",
    "contact.voltage",
    "contact.lastOpening",
    "contact.lastClosing",
    "contact.slip",
    "second.force",
];

/// The bits of the outputs over `count` steps of `size` seconds from `start` on, with inputs that change now and then.
pub fn trace(fmu: &Instance, start: u32, count: u32, size: f64) -> Vec<[u64; 8]> {
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

/// A scene in which the contact opens or starts open, some with friction or a second contact, and its communication step, s.
fn opening(number: u32) -> (Instance, f64) {
    let mut primes = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0].into_iter();
    // Multiples of irrational numbers fill the unit interval evenly.
    let mut draw = |least: f64, greatest: f64| {
        let x = primes
            .next()
            .map_or(0.0, |prime| (f64::from(number) * prime.sqrt()).fract());
        least * (greatest / least).powf(x)
    };
    let fmu = Instance::new();
    assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
    for (name, least, greatest) in [
        ("excitation.amplitude", 200.0, 3000.0),
        ("excitation.frequency", 100.0, 3000.0),
        ("beam.stiffnessDamping", 1e-7, 1e-4),
        ("contact.damping", 1e-7, 1e-4),
        ("solver.tolerance", 1e-9, 1e-3),
    ] {
        assert_eq!(fmu.set_real(name, draw(least, greatest)), fmi2OK);
    }
    match number % 12 {
        0 | 1 => {
            assert_eq!(fmu.set_integer("effects.friction", 2), fmi2OK);
            assert_eq!(fmu.set_real("tip.contactHeight", 1e-3), fmi2OK);
        }
        3 | 4 => assert_eq!(fmu.set_boolean("effects.secondContact", true), fmi2OK),
        _ => {}
    }
    let overtravel = draw(2e-5, 4e-4);
    if number.is_multiple_of(3) {
        assert_eq!(fmu.set_real("contact.overtravel", -overtravel), fmi2OK);
    } else {
        assert_eq!(fmu.set_real("contact.overtravel", overtravel), fmi2OK);
        assert_eq!(
            fmu.set_integer("effects.contactLaw", if number % 3 == 1 { 1 } else { 2 }),
            fmi2OK
        );
    }
    fmu.initialize();
    (fmu, draw(1e-6, 1e-4))
}

#[test]
fn every_state_goes_through_bytes() {
    let mut scenes: Vec<_> = (0..40).map(opening).collect();
    scenes.push((shaken(450.0), 1e-5));
    for (number, (fmu, size)) in scenes.into_iter().enumerate() {
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
    expect(&with(8, 2), "its format is version 7, allowed is 5");
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
