//! A time step, and setting and reading around it, allocates nothing. Where there is too little memory a call fails, and the
//! process goes on.

use std::{fs, ptr};

use relay_contact::fmi2::{fmi2Discard, fmi2Error, fmi2GetFMUstate, fmi2OK, fmi2Status};
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::ExcitationKind;
use testing::allocator::Counting;
use testing::instance::Instance;
use testing::scenes::files;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations in a thousand communication steps of `size` (s), each begun by this; without those in which it warns, once in a run.
fn allocations(contact: &Instance, size: f64, begin: impl Fn(u32)) -> usize {
    let (mut allocations, mut warnings) = (0, 0);
    for n in 0..1000 {
        let before = Counting::calls();
        begin(n);
        assert_eq!(contact.step(f64::from(n) * size, size), fmi2OK, "{:?}", contact.messages());
        assert!(contact.real("contact.force").is_finite() && contact.real("contact.resistance").is_finite());
        let made = Counting::calls() - before;
        if contact.messages().is_empty() {
            allocations += made;
        } else {
            warnings += 1;
        }
    }
    assert!(Counting::calls() > 0, "nothing is counted");
    assert!(warnings <= 1, "{warnings} steps are not counted");
    allocations
}

/// With every choice of `effects.excitation`, while the contact opens and bounces.
#[test]
fn a_communication_step_allocates_nothing() {
    for &(name, excitation) in ExcitationKind::CHOICES {
        let contact = Instance::new();
        assert_eq!(contact.set_integer("effects.excitation", excitation), fmi2OK);
        assert_eq!(contact.set_boolean("effects.energy", true), fmi2OK);
        contact.initialize();
        let begin = |n| {
            let base = if n % 100 < 50 { 2000.0 } else { -2000.0 };
            let inputs = ["base.acceleration", "contact.current"];
            assert_eq!(contact.set_reals(inputs, [base, 0.1]), fmi2OK);
        };
        assert_eq!(allocations(&contact, 1e-5, begin), 0, "{name}");
        assert!(contact.real("contact.lastOpening") > 0.0, "events are not covered");
    }
}

/// With all that the project's scenes have beside the contact, and as much work as a step may make of it.
#[test]
fn a_step_of_any_scene_allocates_nothing() {
    for path in files() {
        let file = SceneFile::read(&path).unwrap();
        for tolerance in [1e-2, 1e-8] {
            let mut scene = file.scene.clone();
            scene.effects.energy = true;
            scene.solver.tolerance = tolerance;
            let contact = Instance::new();
            contact.set_scene(&scene);
            let size = file.communication_step;
            let inputs: Vec<_> = (0..1000).map(|n| file.inputs_over(f64::from(n) * size, size).unwrap()).collect();
            contact.set_inputs(&inputs[0]);
            contact.initialize();
            let begin = |n| contact.set_inputs(&inputs[n as usize]);
            assert_eq!(allocations(&contact, size, begin), 0, "{} at {tolerance}", path.display());
        }
    }
}

/// Exact steps ahead, at communication points, and back to one where the input changes.
#[test]
fn an_exact_step_allocates_nothing() {
    let contact = Instance::new();
    assert_eq!(contact.set_integer("effects.excitation", 2), fmi2OK);
    assert_eq!(contact.set_integer("effects.contactLaw", 3), fmi2OK);
    for watched in ["effects.extremes", "effects.chatter"] {
        assert_eq!(contact.set_boolean(watched, false), fmi2OK);
    }
    contact.initialize();
    let begin = |n| {
        assert_eq!(contact.set_real("base.acceleration", if n % 100 < 50 { 20.0 } else { -20.0 }), fmi2OK);
    };
    assert_eq!(allocations(&contact, 1e-6, begin), 0);
    assert!(contact.integer("solver.steps") < 500, "no step went ahead");
}

/// Memory of which a simulation takes more, and a call that sets or reads less, bytes.
const LITTLE: usize = 1 << 16;

/// The status of a call that is refused more than so many bytes at a time.
fn without_memory(bytes: usize, call: impl FnOnce() -> fmi2Status) -> fmi2Status {
    Counting::refuse_above(bytes);
    let status = call();
    Counting::refuse_above(usize::MAX);
    status
}

/// The caches of a simulation take about a megabyte.
#[test]
fn an_initialisation_without_memory_is_an_error_that_a_reset_heals() {
    let contact = Instance::new();
    for _ in 0..2 {
        assert_eq!(contact.enter_initialization_mode(), fmi2OK);
        contact.answers(
            without_memory(LITTLE, || contact.exit_initialization_mode()),
            fmi2Error,
            &["fmi2ExitInitializationMode: out of memory: ", "bytes are needed"],
        );
        assert_eq!(contact.reset(), fmi2OK);
    }
    contact.initialize();
    assert_eq!(contact.step(0.0, 1e-4), fmi2OK);
}

#[test]
#[allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs
fn a_state_without_memory_is_an_error() {
    let contact = Instance::initialized();
    let mut state = ptr::null_mut();
    // A simulation's motion alone has some 6 kB: two states of 128 modes.
    let status = without_memory(4000, || unsafe { fmi2GetFMUstate(contact.component, &raw mut state) });
    contact.answers(status, fmi2Error, &["fmi2GetFMUstate: out of memory: "]);
    assert!(state.is_null());
    assert_eq!(contact.reset(), fmi2OK);
    contact.initialize();
    // What begins like a state, and is longer than any.
    let mut bytes = contact.to_bytes(contact.save());
    bytes.resize(1 << 26, 0);
    contact.answers(
        without_memory(LITTLE, || contact.from_bytes(&bytes).0),
        fmi2Error,
        &["is not a saved state: it has 67108864 bytes, allowed are 1048576"],
    );
}

#[test]
fn a_file_for_which_there_is_no_memory_is_discarded() {
    let contact = Instance::new();
    let file = concat!(env!("CARGO_TARGET_TMPDIR"), "/large-spring.toml");
    fs::write(file, format!("# {}", "a".repeat(900_000))).expect("a file");
    contact.answers(
        without_memory(LITTLE, || contact.set_string("beam.file", file)),
        fmi2Discard,
        &["large-spring.toml: cannot be read: out of memory"],
    );
}
