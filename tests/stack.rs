//! Hosts run components on threads with small stacks: whole lives of instances, with every effect, take less than [`BAR`].
//!
//! What a thread takes is measured: its stack is filled with a pattern before it begins, and what of that is left is looked
//! for afterwards. What the C library itself takes of it, some 4.6 kB, is included. The profile of the tests takes more than
//! that of the component.
#![cfg(target_os = "linux")]
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs

use std::ffi::{CString, c_void};
use std::path::Path;
use std::{fs, panic, ptr, slice, thread};

use relay_contact::fmi2::*;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{
    AxialForceKind, ContactLawKind, EnumerationParameter, ExcitationKind, FrictionKind, GUID, PusherKind,
    StringParameter, guid_carrying,
};
use testing::instance::{Arguments, Instance, vr};

/// Stack of a thread that makes all calls, bytes.
const BAR: usize = 32 * 1024;

/// Stack that the test gives it, so that it can tell by how much the bar is missed, bytes.
const ROOM: usize = 1 << 20;

/// What the untouched stack is filled with.
const PAINT: u8 = 0xa5;

/// The spring file that holds modes.
const MODES: &str = "tapered-cube-modes.toml";

/// The uniform spring, and files in `scenes/` of segments and of modes.
const SPRINGS: [&str; 3] = ["", "springs/tapered-cube.toml", "springs/tapered-cube-modes.toml"];

/// All that can be combined, with energy, extremes and interruptions, which take more, and with tolerances in turn.
fn all() -> Vec<Scene> {
    let with = |scene: &mut Scene, file, spring| scene.set_string(file, spring, Path::new("scenes")).unwrap();
    let beside: [&dyn Fn(&mut Scene); 6] = [
        &|_| (),
        &|scene| scene.effects.friction = FrictionKind::Coulomb,
        &|scene| scene.effects.second_contact = true,
        &|scene| {
            scene.effects.parallel_contact = true;
            with(scene, StringParameter::BeamFile, "springs/forked.toml");
        },
        &|scene| scene.effects.pusher = PusherKind::Armature,
        &|scene| {
            (scene.effects.second_contact, scene.effects.pusher) = (true, PusherKind::Armature);
            with(scene, StringParameter::FixedFile, "springs/reed-blade.toml");
        },
    ];
    let mut tolerances = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10].into_iter().cycle();
    let (mut scenes, mut taken) = (Vec::new(), [false; 6]);
    for &(_, excitation) in ExcitationKind::CHOICES {
        for &(_, law) in ContactLawKind::CHOICES {
            for &(_, axial_force) in AxialForceKind::CHOICES {
                for (index, spring) in (0..beside.len()).flat_map(|index| SPRINGS.map(|spring| (index, spring))) {
                    let mut scene = run();
                    let mut set = |parameter: EnumerationParameter, choice: i32| {
                        scene.set_number(parameter.variable(), choice.into()).unwrap();
                    };
                    set(EnumerationParameter::EffectsExcitation, excitation);
                    set(EnumerationParameter::EffectsContactLaw, law);
                    set(EnumerationParameter::EffectsAxialForce, axial_force);
                    with(&mut scene, StringParameter::BeamFile, spring);
                    beside[index](&mut scene);
                    if Simulation::new(&scene, &Inputs::default(), 0.0).is_ok() {
                        scene.solver.tolerance = tolerances.next().unwrap();
                        taken[index] = true;
                        scenes.push(scene);
                    }
                }
            }
        }
    }
    assert!(taken.iter().all(|taken| *taken), "{taken:?}");
    scenes
}

/// What all of them have.
fn run() -> Scene {
    let mut scene = Scene::default();
    (scene.effects.energy, scene.effects.extremes, scene.effects.chatter) = (true, true, true);
    (scene.excitation.amplitude, scene.excitation.frequency) = (800.0, 300.0);
    (scene.excitation.end_frequency, scene.excitation.duration) = (3000.0, 1e-3);
    scene.excitation.spectral_density = 40.0;
    (scene.second.gap, scene.tip.contact_height) = (5e-5, 1e-3);
    (scene.contact.overtravel, scene.beam.stiffness_damping) = (1e-4, 2e-6);
    scene
}

/// Sets parameters, and initialises.
fn begin(contact: &Instance, scene: &Scene) {
    let tolerance = Some(scene.solver.tolerance);
    assert_eq!(contact.setup(tolerance, 0.0, Some(1.0)), fmi2OK);
    contact.set_scene(scene);
    assert_eq!(contact.enter_initialization_mode(), fmi2OK);
    assert!(contact.real("preload.force").is_finite());
    assert_eq!(contact.exit_initialization_mode(), fmi2OK, "{:?}", contact.messages());
}

/// Steps of all sizes with inputs that are held, jump, or change linearly; every output and its derivative is read.
fn steps(contact: &Instance, mut time: f64) {
    for n in 0..48 {
        let size = [1e-6, 1e-6, 1e-6, 2.5e-5, 1e-5, 1e-5][n % 6];
        if n % 12 < 6 {
            let acceleration = if n % 24 < 6 { 300.0 } else { -300.0 };
            assert_eq!(contact.set_reals(["base.acceleration", "contact.current"], [acceleration, 0.1]), fmi2OK);
        }
        if n % 12 == 9 {
            assert_eq!(contact.set_rates(["base.acceleration"], [1], [1e6]), fmi2OK);
        }
        let status = contact.step(time, size);
        assert_eq!(status, fmi2OK, "at {time}: {:?}", contact.messages());
        time += size;
        let outputs =
            ["contact.force", "contact.resistance", "contact.slip", "second.force", "energy.balance", "tip.velocity"];
        for name in outputs {
            contact.try_rate(name);
        }
        contact.reals_of(outputs.map(vr));
    }
}

/// Saves the instance to bytes, and sets it to the state restored from them.
fn save_and_restore(contact: &Instance) {
    let state = contact.save();
    let (status, again) = contact.from_bytes(&contact.to_bytes(state));
    assert_eq!((status, contact.restore(again)), (fmi2OK, fmi2OK));
    contact.free(state);
    contact.free(again);
}

/// The life of an instance that logs all: run, saved, restored, run on; reset, restored as it was, run on; failed, reset, run
/// anew.
fn live(scene: &Scene) {
    let contact = Instance::with(&Arguments { logging_on: true, ..Arguments::default() });
    let logging = unsafe { fmi2SetDebugLogging(contact.component, fmi2True, 0, ptr::null()) };
    assert_eq!(logging, fmi2OK);
    begin(&contact, scene);
    steps(&contact, 0.0);
    save_and_restore(&contact);
    let state = contact.save();
    let time = contact.last_successful_time().1;
    steps(&contact, time);
    assert_eq!(contact.reset(), fmi2OK);
    assert_eq!(contact.restore(state), fmi2OK);
    steps(&contact, time);
    assert_eq!(contact.step(0.0, -1.0), fmi2Error);
    assert_eq!(contact.reset(), fmi2OK);
    begin(&contact, scene);
}

/// Instances that carry a spring file, and files that are no springs, among them one that the parser would follow deep.
fn read_files() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/springs");
    let resources = CString::new(folder).unwrap();
    let text = fs::read_to_string(format!("{folder}/{MODES}")).unwrap();
    let contact = Instance::with(&Arguments {
        guid: Some(&guid_carrying(GUID, MODES, &text)),
        resources: Some(&resources),
        ..Arguments::default()
    });
    contact.initialize();
    let (no_table, nested) = ("segment = 1\n", "{a = ".repeat(60) + "1" + &"}".repeat(60));
    let (list, keys) = ("segment = [{length = [1, 2]}]\n", vec!["a"; 70].join("."));
    let file = concat!(env!("CARGO_TARGET_TMPDIR"), "/no-spring.toml");
    for text in [no_table, list, "[[segment]]\nlength = \"", &format!("a = {nested}"), &format!("{keys} = 1")] {
        fs::write(file, text).unwrap();
        let contact = Instance::new();
        assert_eq!(contact.set_string("beam.file", file), fmi2Discard, "{text}");
        assert_eq!(contact.set_real("contact.overtravel", 1.0), fmi2Discard);
    }
}

/// How much of its stack a thread has touched in all, bytes.
fn touched(body: &mut (dyn FnMut() + Send)) -> usize {
    extern "C" fn run(body: *mut c_void) -> *mut c_void {
        let body = unsafe { &mut *body.cast::<&mut (dyn FnMut() + Send)>() };
        let done = panic::catch_unwind(panic::AssertUnwindSafe(body)).is_ok();
        ptr::without_provenance_mut(usize::from(done))
    }
    unsafe {
        let protection = libc::PROT_READ | libc::PROT_WRITE;
        let kind = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS;
        let stack = libc::mmap(ptr::null_mut(), ROOM, protection, kind, -1, 0);
        assert_ne!(stack, libc::MAP_FAILED);
        stack.write_bytes(PAINT, ROOM);
        let (mut attributes, mut thread, mut done) = (std::mem::zeroed(), 0, ptr::null_mut());
        assert_eq!(libc::pthread_attr_init(&raw mut attributes), 0);
        assert_eq!(libc::pthread_attr_setstack(&raw mut attributes, stack, ROOM), 0);
        let mut body = body;
        let created = libc::pthread_create(&raw mut thread, &raw const attributes, run, (&raw mut body).cast());
        assert_eq!(created, 0);
        assert_eq!(libc::pthread_join(thread, &raw mut done), 0);
        let bytes = slice::from_raw_parts(stack.cast::<u8>(), ROOM);
        let untouched = bytes.iter().take_while(|byte| **byte == PAINT).count();
        libc::munmap(stack, ROOM);
        assert!(!done.is_null(), "the thread has failed");
        ROOM - untouched
    }
}

#[test]
fn whole_lives_take_less_than_the_bar() {
    let scenes = all();
    assert!(scenes.len() > 300, "{} can be combined", scenes.len());
    let most_of = |scenes: &[Scene]| {
        let lives = scenes.iter().map(|scene| (touched(&mut || live(scene)), format!("{:?}", scene.effects)));
        lives.max().unwrap()
    };
    // On both processors.
    let (first, second) = scenes.split_at(scenes.len() / 2);
    let halves = thread::scope(|scope| {
        let other = scope.spawn(|| most_of(second));
        [most_of(first), other.join().unwrap()]
    });
    let files = (touched(&mut read_files), "files".to_owned());
    let (most, what) = halves.into_iter().chain([files]).max().unwrap();
    println!("{most} bytes at most, by {what}");
    assert!(most < BAR, "{most} bytes by {what}");
}
