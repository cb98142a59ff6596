//! A host's thread may have a small stack. Alone in its process, which an overflow would end.

use std::thread;

use relay_contact::fmi2::fmi2OK;
use testing::instance::Instance;

/// Bytes. A call needs less than half of a thread of 64 kB, and what the host itself has on it.
const STACK: usize = 32 * 1024;

/// A life with everything that computes much: an effect, and a spring by file or none.
fn live(choices: &[(&str, i32)], switches: &[&str], spring: &str) {
    let fmu = Instance::new();
    for (name, value) in choices {
        assert_eq!(fmu.set_integer(name, *value), fmi2OK);
    }
    for name in switches {
        assert_eq!(fmu.set_boolean(name, true), fmi2OK);
    }
    if !spring.is_empty() {
        let file = format!("{}/../scenes/springs/{spring}", env!("CARGO_MANIFEST_DIR"));
        assert_eq!(fmu.set_string("beam.file", &file), fmi2OK);
    }
    assert_eq!(fmu.set_real("excitation.amplitude", 600.0), fmi2OK);
    fmu.initialize();
    for k in 0..20 {
        assert_eq!(fmu.step(f64::from(k) * 1e-4, 1e-4), fmi2OK);
    }
}

#[test]
fn a_thread_with_a_small_stack_is_enough() {
    let stack = std::env::var("STACK").map_or(STACK, |text| text.parse().unwrap());
    let lives = || {
        live(&[("effects.excitation", 2)], &[], "");
        live(&[("effects.excitation", 2), ("effects.contactLaw", 3)], &[], "");
        live(
            &[("effects.excitation", 2), ("effects.axialForce", 3)],
            &["effects.energy"],
            "",
        );
        live(&[("effects.excitation", 5), ("effects.friction", 2)], &[], "");
        live(
            &[("effects.excitation", 2)],
            &["effects.secondContact"],
            "tapered-cube.toml",
        );
        live(&[("effects.excitation", 2)], &[], "tapered-cube-modes.toml");
    };
    let thread = thread::Builder::new().stack_size(stack).spawn(lives).unwrap();
    thread.join().unwrap();
}
